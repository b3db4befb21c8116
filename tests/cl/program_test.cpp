// SPDX-License-Identifier: Apache-2.0
#include "host/cl/program.h"

#include <chrono>
#include <fstream>
#include <functional>

#include "host/cl/compile/program_cache.h"
#include "host/cl/compile/program_compiler.h"
#include "host/cl/kernel.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using test::error_of;
using test::mentions;

/// A device with a folder of kernels and an empty program cache of its own.
class ProgramTest : public test::DeviceTest {
  protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        std::filesystem::create_directories(kernel_dir());
        write_kernel("answer.cl",
                     "#ifndef ANSWER\n#define ANSWER 42\n#endif\n"
                     "kernel void answer(global uint* out) { out[get_global_id(0)] = ANSWER; }\n");
    }
    void on_each_own_device(const std::function<void(Device&)>& check) {
        for (const auto& shared : devices()) {
            SCOPED_TRACE("device " + shared->name());
            std::filesystem::remove_all(cache_dir());
            Device device(shared->entry(), {.kernel_dir = kernel_dir(), .cache_dir = cache_dir()});
            check(device);
        }
    }
    [[nodiscard]] std::filesystem::path kernel_dir() const { return folder_ / "kernels"; }
    [[nodiscard]] std::filesystem::path cache_dir() const { return folder_ / "cache"; }
    void write_kernel(const std::string& name, const std::string& text) const {
        std::ofstream(kernel_dir() / name) << text;
    }
    [[nodiscard]] std::vector<std::filesystem::path> cached_files() const {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(cache_dir())) {
            files.push_back(entry.path());
        }
        return files;
    }

  private:
    TemporaryFolder folder_;
};

void wait_for(const Program& program, const std::string& kernel) {
    static_cast<void>(program.kernel(kernel));
}

/// Uses a device that has compiled nothing yet, as in a process that has just started.
uint run_answer(const Device& like, const Defines& defines = {}) {
    Device device(like.entry(),
                  {.kernel_dir = like.options().kernel_dir, .cache_dir = like.options().cache_dir});
    Kernel kernel(Program(device, "answer.cl", defines), "answer");
    Buffer<uint> out(device, 1);
    kernel.launch(1, 1, out);
    return out.download_one(0);
}

TEST_F(ProgramTest, DefinesReachTheKernel) {
    on_each_own_device([](Device& device) {
        EXPECT_EQ(run_answer(device), 42u);
        EXPECT_EQ(run_answer(device, {{"ANSWER", "7"}}), 7u);
    });
}

TEST_F(ProgramTest, SecondBuildComesFromTheCache) {
    on_each_own_device([&](Device& device) {
        run_answer(device);
        ASSERT_EQ(cached_files().size(), 1u);
        // A build that compiled would write the file again.
        const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1000);
        std::filesystem::last_write_time(cached_files()[0], long_ago);
        EXPECT_EQ(run_answer(device), 42u);
        ASSERT_EQ(cached_files().size(), 1u);
        EXPECT_EQ(std::filesystem::last_write_time(cached_files()[0]), long_ago);
    });
}

TEST_F(ProgramTest, CacheTellsOptionsAndSourcesApart) {
    on_each_own_device([&](Device& device) {
        run_answer(device);
        EXPECT_EQ(run_answer(device, {{"ANSWER", "8"}}), 8u);
        EXPECT_EQ(cached_files().size(), 2u);
        write_kernel("answer.cl", "kernel void answer(global uint* out) { out[get_global_id(0)] = 5; }\n");
        EXPECT_EQ(run_answer(device), 5u);
        EXPECT_EQ(cached_files().size(), 3u);
        write_kernel("answer.cl", "kernel void answer(global uint* out) { out[get_global_id(0)] = 42; }\n");
    });
}

TEST_F(ProgramTest, DamagedCacheFileIsRebuilt) {
    on_each_own_device([&](Device& device) {
        run_answer(device);
        ASSERT_EQ(cached_files().size(), 1u);
        const std::filesystem::path file = cached_files()[0];
        const auto size = std::filesystem::file_size(file);
        std::filesystem::resize_file(file, size - 10);
        EXPECT_EQ(run_answer(device), 42u);
        EXPECT_GT(std::filesystem::file_size(file), size / 2) << "the damaged file was not replaced";
        EXPECT_NE(std::filesystem::file_size(file), size - 10);
    });
}

/// The key in a cache file, which is between the line with its length and the checksum.
std::string key_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string first_line;
    std::size_t length = 0;
    std::getline(stream, first_line);
    stream >> length;
    stream.ignore(1);
    std::string key(length, ' ');
    stream.read(key.data(), static_cast<std::streamsize>(length));
    return key;
}

TEST_F(ProgramTest, ABinaryThatTheDriverRefusesIsRebuilt) {
    on_each_own_device([&](Device& device) {
        run_answer(device);
        ASSERT_EQ(cached_files().size(), 1u);
        const std::string key = key_of(cached_files()[0]);
        const ProgramCache cache(cache_dir());
        ASSERT_TRUE(cache.find(key).has_value());
        cache.store(key, {'n', 'o', ' ', 'p', 'r', 'o', 'g', 'r', 'a', 'm'});
        EXPECT_EQ(run_answer(device), 42u);
        EXPECT_GT(cache.find(key)->size(), 10u) << "the useless binary was not replaced";
    });
}

TEST_F(ProgramTest, BuildFailureSaysWhatWhereAndKeepsSourceAndLog) {
    write_kernel("broken.cl", "kernel void broken(global uint* out) {\n    out[0] = no_such_name;\n}\n");
    on_each_own_device([](Device& device) {
        const Error error = error_of([&] { wait_for(Program(device, "broken.cl"), "broken"); });
        EXPECT_EQ(error.kind(), ErrorKind::kernel_build);
        EXPECT_TRUE(mentions(error, "kernels/broken.cl"));
        EXPECT_TRUE(mentions(error, device.name()));
        EXPECT_TRUE(mentions(error, device.entry().driver));
        EXPECT_TRUE(mentions(error, "no_such_name"));
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;

        const std::size_t begin = message.find("log are in ") + 11;
        const std::filesystem::path source = message.substr(begin, message.find(" and .log") - begin);
        std::filesystem::path log = source;
        log.replace_extension(".log");
        ASSERT_TRUE(std::filesystem::exists(source)) << source;
        ASSERT_TRUE(std::filesystem::exists(log)) << log;
        std::ifstream stream(log);
        const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
        EXPECT_NE(text.find(device.name()), std::string::npos);
        std::filesystem::remove(source);
        std::filesystem::remove(log);
    });
}

TEST_F(ProgramTest, AKeptSourceReplacesALinkOfItsName) {
    write_kernel("linked.cl", "kernel void linked() { no_such_name; }\n");
    const std::filesystem::path other = kernel_dir() / "other.txt";
    on_each_own_device([&](Device& device) {
        std::ofstream(other) << "of somebody else";
        const auto kept_source = [&] {
            Device own(device.entry(), {.kernel_dir = kernel_dir(), .cache_dir = cache_dir()});
            const std::string message =
                error_of([&] { wait_for(Program(own, "linked.cl"), "linked"); }).what();
            const std::size_t begin = message.find("log are in ") + 11;
            return std::filesystem::path(message.substr(begin, message.find(" and .log") - begin));
        };
        const std::filesystem::path source = kept_source();
        ASSERT_TRUE(std::filesystem::remove(source)) << source;
        std::filesystem::create_symlink(other, source);
        EXPECT_EQ(kept_source(), source);
        EXPECT_FALSE(std::filesystem::is_symlink(source));
        std::ifstream stream(other);
        EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "of somebody else");
        std::filesystem::remove(source);
        std::filesystem::remove(std::filesystem::path(source).replace_extension(".log"));
    });
}

TEST_F(ProgramTest, ADeviceCompilesAProgramOnce) {
    on_each_own_device([&](Device& device) {
        wait_for(Program(device, "answer.cl"), "answer");
        std::filesystem::remove_all(cache_dir());
        wait_for(Program(device, "answer.cl"), "answer");
        EXPECT_FALSE(std::filesystem::exists(cache_dir()));
        EXPECT_GT(device.compiler().busy_seconds(), 0.0);
    });
}

TEST_F(ProgramTest, AllOfManyProgramsAreReadyAndNobodyWaitsForThoseNotUsed) {
    on_each_own_device([](Device& device) {
        std::vector<Kernel> kernels;
        for (uint i = 0; i < 12; ++i) {
            kernels.emplace_back(Program(device, "answer.cl", {{"ANSWER", std::to_string(i)}}), "answer");
        }
        Buffer<uint> out(device, 1);
        for (uint i = 0; i < 12; ++i) {
            kernels[i].launch(1, 1, out);
            EXPECT_EQ(out.download_one(0), i);
        }
        for (uint i = 100; i < 112; ++i) {
            const Program never_used(device, "answer.cl", {{"ANSWER", std::to_string(i)}});
        }
    });
}

TEST_F(ProgramTest, OnCpusAJointProgramIsCompiledOnceForAllItsStages) {
    write_kernel("question.cl", "kernel void question(global uint* out) { out[0] = 6 * 9; }\n");
    write_kernel("joint.cl", "#define ANSWER 54\n#include \"answer.cl\"\n#include \"question.cl\"\n");
    constexpr JointProgram kJoint{"joint.cl"};
    on_each_own_device([&](Device& device) {
        Kernel answer(Program(device, "answer.cl", kJoint), "answer");
        Kernel question(Program(device, "question.cl", kJoint), "question");
        Buffer<uint> out(device, 1);
        answer.launch(1, 1, out);
        EXPECT_EQ(out.download_one(0), device.is_cpu() ? 54u : 42u);
        question.launch(1, 1, out);
        EXPECT_EQ(out.download_one(0), 54u);
        EXPECT_EQ(cached_files().size(), device.is_cpu() ? 1u : 2u);
    });
}

TEST_F(ProgramTest, DevicesThatShareACompilerCompileOnce) {
    on_each_own_device([&](Device& device) {
        DeviceOptions options{.kernel_dir = kernel_dir(), .cache_dir = cache_dir()};
        options.compiler = std::make_shared<ProgramCompiler>();
        Device one(device.entry(), options);
        Device two(device.entry(), options);
        wait_for(Program(one, "answer.cl"), "answer");
        const auto time = std::filesystem::last_write_time(cached_files().at(0));
        wait_for(Program(two, "answer.cl"), "answer");
        EXPECT_EQ(cached_files().size(), 1u);
        EXPECT_EQ(std::filesystem::last_write_time(cached_files()[0]), time);
    });
}

TEST_F(ProgramTest, UnknownEntryPointIsNamed) {
    on_each_own_device([](Device& device) {
        Kernel kernel(Program(device, "answer.cl"), "question");
        Buffer<uint> out(device, 1);
        const Error error = error_of([&] { kernel.launch(1, 1, out); });
        EXPECT_TRUE(mentions(error, "question"));
        EXPECT_TRUE(mentions(error, "answer.cl"));
    });
}

TEST_F(ProgramTest, ProfilerCountsLaunchesByKernel) {
    on_each_own_device([](Device& device) {
        Kernel kernel(Program(device, "answer.cl"), "answer");
        Buffer<uint> out(device, 1);
        kernel.launch(1, 1, out);
        kernel.launch(1, 1, out);
        const auto& totals = device.profiler().totals();
        ASSERT_EQ(totals.count("answer"), 1u);
        EXPECT_EQ(totals.at("answer").launches, 2);
        EXPECT_GE(totals.at("answer").seconds, 0.0);
        EXPECT_LT(totals.at("answer").seconds, 10.0);
        // No launch is lost when there are more than the profiler keeps the events of.
        for (int i = 0; i < 2500; ++i) {
            kernel.launch(1, 1, out);
        }
        EXPECT_EQ(device.profiler().totals().at("answer").launches, 2502);
    });
}

}  // namespace
}  // namespace nearlight::core
