// SPDX-License-Identifier: Apache-2.0
// Runs the fuzz targets on their seeds and on every case that was found and mended, under limits of time and
// memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {

/// The name of a test case.
static std::ostream& operator<<(std::ostream& stream, const Target& target) {
    return stream << target.name;
}

namespace {

namespace fs = std::filesystem;

/// The longest time that processors may work on one file; the process is killed after it. On a busy machine
/// that takes longer.
void limit_time(int seconds) {
    itimerval limit{};
    limit.it_value.tv_sec = seconds;
    ASSERT_EQ(setitimer(ITIMER_PROF, &limit, nullptr), 0);
}

#ifdef NEARLIGHT_RESERVES_ADDRESSES
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif

void limit_memory() {
    constexpr rlim_t kMaxBytes = rlim_t{2} << 30;  // with the libraries and the stacks of threads
    const rlimit limit{kMaxBytes, kMaxBytes};
    ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
}

/// The files of a target, in the order of their names.
std::vector<fs::path> kept_files(const std::string& target) {
    std::vector<fs::path> files;
    for (const auto& entry :
         fs::directory_iterator(fs::path(NEARLIGHT_SOURCE_DIR) / "tests/fuzz/corpus" / target)) {
        files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

class Replay : public testing::TestWithParam<Target> {};

TEST_P(Replay, NoFileCrashesOrHangsOrTakesTooMuchMemory) {
    if (kLimitsMemory) {
        limit_memory();
    }
    const std::vector<fs::path> files = kept_files(GetParam().name);
    ASSERT_GE(files.size(), 3u);
    for (const fs::path& file : files) {
        // A crash leaves this as the last line.
        std::cerr << file.string() << std::endl;
        std::ifstream stream(file, std::ios::binary);
        const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
        limit_time(10);
        GetParam().run(bytes);
        limit_time(0);
        std::cerr.clear();
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, testing::ValuesIn(kTargets),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace nearlight::core::fuzz
