// SPDX-License-Identifier: Apache-2.0
// Runs the program on OpenCL devices of which one call fails (failing_opencl.cpp). Every such run must make
// the right picture, or say in one line which device failed at what and what to do, and leave everything else
// as it was. Calls are sampled: some of each entry point, and some of each part of the run.
// NEARLIGHT_FAULTS=all tries every call, which takes an hour.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "host/cli/exit_code.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

/// How calls fail (see failing_opencl.cpp).
struct FaultKind {
    std::string mode = "once";
    int code = CL_OUT_OF_RESOURCES;
    bool in_children = false;
};

/// What the program is asked to do.
struct Task {
    std::string arguments;
    std::string environment{};
};

class ProgramFaults : public testing::Test {
  protected:
    void SetUp() override {
        NEARLIGHT_NEEDS_DEVICE();
        std::ofstream(folder_ / "scene.xml") << floor_and_wall();
        std::filesystem::create_directory(folder_ / "temporary");
        std::filesystem::create_directory(folder_ / "pictures");
    }
    [[nodiscard]] std::filesystem::path picture() const { return folder_ / "pictures" / "picture.png"; }
    [[nodiscard]] std::filesystem::path report() const { return folder_ / "report"; }
    [[nodiscard]] Task render(const std::string& more = "") const {
        return {.arguments = "render " + quoted(folder_ / "scene.xml") +
                             " --json --size 48x40 --vpls 32 --spp 1 --exposure 0 -o " + quoted(picture()) +
                             " " + more};
    }

    /// Runs a task in which call number `call` fails, if it is not 0.
    [[nodiscard]] ProgramResult run(const Task& task, const FaultKind& kind, std::size_t call) const {
        std::ofstream(picture()) << "old";
        std::filesystem::remove(report());
        return run_program(
            task.arguments,
            "env TMPDIR=" + quoted(folder_ / "temporary") +
                " LD_PRELOAD=" NEARLIGHT_FAILING_OPENCL " NEARLIGHT_FAULT_CALL=" + std::to_string(call) +
                " NEARLIGHT_FAULT_CODE=" + std::to_string(kind.code) + " NEARLIGHT_FAULT_MODE=" + kind.mode +
                " NEARLIGHT_FAULT_REPORT=" + quoted(report()) +
                (kind.in_children ? " NEARLIGHT_FAULT_CHILDREN=1 " : " ") + task.environment + " timeout 60");
    }
    /// The entry points that the last run called, in order.
    [[nodiscard]] std::vector<std::string> calls() const {
        std::istringstream lines(file_text(report()));
        std::vector<std::string> names;
        for (std::string name; std::getline(lines, name);) {
            names.push_back(name);
        }
        return names;
    }
    /// Numbers of calls: `per_kind` of each entry point and `spread` over the whole run.
    static std::set<std::size_t> choose_calls(const std::vector<std::string>& names, std::size_t per_kind,
                                              std::size_t spread) {
        std::set<std::size_t> chosen;
        const char* const wish = std::getenv("NEARLIGHT_FAULTS");
        const bool all = wish != nullptr && std::string(wish) == "all";
        std::map<std::string, std::vector<std::size_t>> of_kind;
        for (std::size_t i = 0; i < names.size(); ++i) {
            of_kind[names[i]].push_back(i + 1);
            if (all || (i * spread) / names.size() != ((i + 1) * spread) / names.size()) {
                chosen.insert(i + 1);
            }
        }
        for (const auto& [name, places] : of_kind) {
            for (std::size_t i = 0; i < std::min(per_kind, places.size()); ++i) {
                chosen.insert(places[(2 * i + 1) * places.size() / (2 * per_kind)]);
            }
        }
        return chosen;
    }
    void expect_clean_folders() const {
        EXPECT_TRUE(std::filesystem::is_empty(folder_ / "temporary"));
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "pictures")) {
            EXPECT_EQ(entry.path(), picture());
        }
    }
    /// One line, which says what is to be done, and of what.
    static void expect_one_error(const ProgramResult& result, const FaultKind& kind) {
        std::set<int> exit_codes{static_cast<int>(ExitCode::no_device)};
        const bool memory = kind.code == CL_MEM_OBJECT_ALLOCATION_FAILURE;
        exit_codes.insert(static_cast<int>(memory ? ExitCode::out_of_memory : ExitCode::runtime));
        EXPECT_TRUE(exit_codes.contains(result.exit_code)) << result.exit_code;
        // A driver may abort when the picture is written and the program has said so.
        static const std::regex line(
            "(info: [^\n]*\n)*nearlight: error: [^\n]*[Dd](evice|river)[^\n]*; (try "
            "again|free|choose|install)[^\n]*\n");
        EXPECT_TRUE(std::regex_match(result.errors, line)) << result.errors;
    }
    /// Makes the calls fail one after another, and checks what comes of it.
    void expect_right_or_error(const Task& task, const FaultKind& kind, std::size_t per_kind,
                               std::size_t spread) {
        const ProgramResult good = run(task, kind, 0);
        ASSERT_EQ(good.exit_code, 0) << good.errors;
        const std::string right = file_text(picture());
        const std::vector<std::string> names = calls();
        ASSERT_GT(names.size(), 20u) << "is the library loaded?";
        std::size_t errors = 0;
        for (const std::size_t call : choose_calls(names, per_kind, spread)) {
            SCOPED_TRACE("call " + std::to_string(call) + ", " + names[call - 1] + ", " + kind.mode);
            const ProgramResult result = run(task, kind, call);
            const bool is_whole = result.exit_code == 0 || result.errors.find("wrote") != std::string::npos;
            EXPECT_EQ(file_text(picture()), is_whole ? right : "old");
            if (result.exit_code != 0) {
                ++errors;
                expect_one_error(result, kind);
            }
            expect_clean_folders();
        }
        EXPECT_EQ(errors > 0, !kind.in_children) << errors;
        EXPECT_EQ(run(task, kind, 0).exit_code, 0);
        EXPECT_EQ(file_text(picture()), right) << "the failures left something behind";
    }

    TemporaryFolder folder_;
};

TEST_F(ProgramFaults, ACallFails) {
    expect_right_or_error(render(), {.mode = "once"}, 1, 10);
    expect_right_or_error(render(), {.mode = "once", .code = CL_MEM_OBJECT_ALLOCATION_FAILURE}, 0, 10);
}

TEST_F(ProgramFaults, ADeviceIsLost) {
    expect_right_or_error(render(), {.mode = "lost", .code = CL_DEVICE_NOT_AVAILABLE}, 0, 10);
    expect_right_or_error(render(), {.mode = "late"}, 0, 10);
}

// PoCL makes two devices of one processor.
TEST_F(ProgramFaults, OneOfTwoDevicesIsLost) {
    Task task = render("--device all");
    task.environment = "POCL_DEVICES='pthread pthread'";
    expect_right_or_error(task, {.mode = "late"}, 1, 10);
}

#ifndef NEARLIGHT_SANITIZED
TEST_F(ProgramFaults, ADriverAborts) {
    expect_right_or_error(render(), {.mode = "abort"}, 0, 3);
}
#endif

// The program then compiles by itself.
TEST_F(ProgramFaults, AProcessThatCompilesFails) {
    Task task = render("--cache-dir none");
    expect_right_or_error(task, {.mode = "once", .in_children = true}, 0, 6);
}

}  // namespace
}  // namespace nearlight::core
