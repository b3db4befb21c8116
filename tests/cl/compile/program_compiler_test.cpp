// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/program_compiler.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>
#include <cstddef>
#include <system_error>
#include <thread>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// No thread can be started while this lives, because each would get a stack larger than all addresses.
class NoMoreThreads {
  public:
    NoMoreThreads() {
        pthread_attr_t large{};
        pthread_getattr_default_np(&usual_);
        pthread_getattr_default_np(&large);
        pthread_attr_setstacksize(&large, std::size_t{1} << 56u);
        pthread_setattr_default_np(&large);
        pthread_attr_destroy(&large);
    }
    ~NoMoreThreads() {
        pthread_setattr_default_np(&usual_);
        pthread_attr_destroy(&usual_);
    }
    NoMoreThreads(const NoMoreThreads&) = delete;
    NoMoreThreads& operator=(const NoMoreThreads&) = delete;

  private:
    pthread_attr_t usual_{};
};

TEST(ProgramCompiler, TheCallerCompilesIfThereIsNoThread) {
    ProgramCompiler compiler;
    // A program for no context fails, which shows that somebody has tried to make it.
    const ProgramRequest request{DeviceEntry(), cl::Context(), "none.cl", "kernel void none() {}\n", "",
                                 "none"};
    {
        const NoMoreThreads limit;
        ASSERT_THROW(std::jthread([] {}), std::system_error);
        const std::shared_future<cl::Program> built = compiler.start(request);
        ASSERT_EQ(built.wait_for(std::chrono::seconds(0)), std::future_status::ready);
        EXPECT_THROW(built.get(), Error);
    }
    EXPECT_FALSE(compiler.is_busy());
    const std::shared_future<cl::Program> later = compiler.start(request);
    EXPECT_THROW(later.get(), Error) << "threads can be started again";
}

}  // namespace
}  // namespace nearlight::core
