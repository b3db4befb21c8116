// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/compile_worker.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "host/cl/compile/program_compiler.h"
#include "host/cl/kernel.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using test::error_of;

/// Starts workers as a program does, before there are threads or drivers. Each test runs in its own process.
CompileWorkers early_workers = start_compile_workers(2);

bool is_running(pid_t process) {
    return kill(process, 0) == 0 || errno != ESRCH;
}

class CompileWorkerTest : public test::DeviceTest {
  protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        const auto cpu = std::ranges::find_if(devices(), [](const auto& device) { return device->is_cpu(); });
        if (cpu == devices().end()) {
            GTEST_SKIP() << "only programs for CPUs are compiled in processes of their own";
        }
        cpu_ = cpu->get();
        ASSERT_EQ(early_workers.size(), 2u);
        std::filesystem::create_directories(kernel_dir());
        write_kernel("answer.cl",
                     "kernel void answer(global uint* out) { out[get_global_id(0)] = ANSWER; }\n");
        write_kernel("broken.cl", "kernel void broken(global uint* out) {\n    out[0] = no_such_name;\n}\n");
    }

    [[nodiscard]] std::filesystem::path kernel_dir() const { return folder_ / "kernels"; }
    void write_kernel(const std::string& name, const std::string& text) const {
        std::ofstream(kernel_dir() / name) << text;
    }
    [[nodiscard]] Device& cpu() const { return *cpu_; }
    [[nodiscard]] ProgramRequest request(const std::string& source) const {
        return {cpu().entry(), cpu().context(), "test.cl", source, "-cl-std=CL1.2", "none"};
    }
    /// Compiles on a device like `entry` that keeps no programs.
    [[nodiscard]] DeviceOptions options(std::shared_ptr<ProgramCompiler> compiler) const {
        return {.kernel_dir = kernel_dir(), .cache_dir = "none", .compiler = std::move(compiler)};
    }
    void expect_answers(const DeviceEntry& entry, const std::shared_ptr<ProgramCompiler>& compiler) const {
        Device device(entry, options(compiler));
        std::vector<Kernel> kernels;
        for (uint i = 0; i < 5; ++i) {
            kernels.emplace_back(Program(device, "answer.cl", {{"ANSWER", std::to_string(i)}}), "answer");
        }
        Buffer<uint> out(device, 1);
        for (uint i = 0; i < 5; ++i) {
            kernels[i].launch(1, 1, out);
            EXPECT_EQ(out.download_one(0), i);
        }
    }

  private:
    TemporaryFolder folder_;
    Device* cpu_ = nullptr;
};

TEST_F(CompileWorkerTest, GivesTheBinaryThatTheDriverTakes) {
    const ProgramRequest asked = request("kernel void seven(global uint* out) { out[0] = 7; }\n");
    const ProgramBinary binary = early_workers[0]->compile(asked);
    ASSERT_FALSE(binary.empty());
    const cl::Program program(cpu().context(), {cpu().entry().handle}, cl::Program::Binaries{binary});
    program.build({cpu().entry().handle}, asked.options.c_str());
    EXPECT_EQ(program.getInfo<CL_PROGRAM_KERNEL_NAMES>(), "seven");
}

TEST_F(CompileWorkerTest, OneCompilesManyProgramsAlsoAfterItWasIdle) {
    for (int i = 0; i < 3; ++i) {
        const std::string name = "number" + std::to_string(i);
        EXPECT_FALSE(early_workers[0]->compile(request("kernel void " + name + "() {}\n")).empty()) << i;
        if (i == 1) {
            std::this_thread::sleep_for(std::chrono::milliseconds(700));
        }
    }
}

TEST_F(CompileWorkerTest, HasNothingForWhatDoesNotCompileOrIsForAnotherDevice) {
    EXPECT_TRUE(early_workers[0]->compile(request("kernel void broken() { no_such_name; }\n")).empty());
    ProgramRequest elsewhere = request("kernel void fine() {}\n");
    elsewhere.entry.driver += " of another machine";
    EXPECT_TRUE(early_workers[0]->compile(elsewhere).empty());
    EXPECT_FALSE(early_workers[0]->compile(request("kernel void fine() {}\n")).empty()) << "it still works";
}

TEST_F(CompileWorkerTest, ProgramsOfAWorkerRun) {
    expect_answers(cpu().entry(), std::make_shared<ProgramCompiler>(std::move(early_workers)));
}

TEST_F(CompileWorkerTest, ProgramsForPartsOfADeviceRun) {
    if (cpu().entry().max_parts < 2) {
        GTEST_SKIP() << "one compute unit cannot be split";
    }
    const std::string half = std::to_string(cpu().entry().index) + "/2.1";
    expect_answers(choose_devices(list_devices(), half).at(0),
                   std::make_shared<ProgramCompiler>(std::move(early_workers)));
}

TEST_F(CompileWorkerTest, WhatAKilledWorkerLeavesIsCompiledHere) {
    for (const auto& worker : early_workers) {
        ASSERT_EQ(kill(worker->process(), SIGKILL), 0);
    }
    EXPECT_TRUE(early_workers[0]->compile(request("kernel void fine() {}\n")).empty());
    expect_answers(cpu().entry(), std::make_shared<ProgramCompiler>(std::move(early_workers)));
}

TEST_F(CompileWorkerTest, BuildErrorsAreThoseOfThisProcess) {
    const auto error_with = [&](std::shared_ptr<ProgramCompiler> compiler) {
        Device device(cpu().entry(), options(std::move(compiler)));
        const Program program(device, "broken.cl");
        return error_of([&] { static_cast<void>(program.kernel("broken")); });
    };
    const Error here = error_with(std::make_shared<ProgramCompiler>());
    const Error worker = error_with(std::make_shared<ProgramCompiler>(std::move(early_workers)));
    EXPECT_EQ(worker.kind(), ErrorKind::kernel_build);
    EXPECT_STREQ(worker.what(), here.what());
    EXPECT_TRUE(test::mentions(worker, "no_such_name"));
}

TEST_F(CompileWorkerTest, EndsWithItsOwnerAndIgnoresCtrlC) {
    const pid_t process = early_workers[0]->process();
    ASSERT_FALSE(early_workers[0]->compile(request("kernel void fine() {}\n")).empty());
    ASSERT_EQ(kill(process, SIGINT), 0);
    EXPECT_FALSE(early_workers[0]->compile(request("kernel void also_fine() {}\n")).empty());
    ASSERT_TRUE(is_running(process));
    early_workers.clear();
    EXPECT_FALSE(is_running(process));
}

TEST_F(CompileWorkerTest, AProgramNobodyWaitsForDoesNotDelayTheEnd) {
    auto compiler = std::make_shared<ProgramCompiler>(std::move(early_workers));
    std::shared_future<cl::Program> built =
        compiler->start(request("kernel void never_used(global float* x) { x[0] = pow(x[1], x[2]); }\n"));
    compiler.reset();
    ASSERT_EQ(built.wait_for(std::chrono::seconds(0)), std::future_status::ready);
    EXPECT_THROW(built.get(), std::exception) << "stopped, or never begun";
}

TEST(CompileContexts, KeepNoneThatCouldNotBeMade) {
    CompileContexts contexts;
    for (int attempt = 0; attempt < 2; ++attempt) {
        EXPECT_THROW(context_of(cl::Device(), contexts), cl::Error);
        EXPECT_TRUE(contexts.empty());
    }
}

}  // namespace
}  // namespace nearlight::core
