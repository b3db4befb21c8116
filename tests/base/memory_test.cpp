// SPDX-License-Identifier: Apache-2.0
#include "host/base/memory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace nearlight::core {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

/// Folders that look like /proc and /sys/fs/cgroup, with 900 MiB of available memory and 100 MiB of free
/// swap.
class FreeMemoryTest : public ::testing::Test {
  protected:
    FreeMemoryTest() {
        write("proc/meminfo",
              "MemTotal:        2048000 kB\nMemAvailable:     921600 kB\nSwapFree:  102400 kB\n");
        write("proc/self/cgroup", "4:memory:/elsewhere\n0::/job/step\n");
    }
    ~FreeMemoryTest() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& file, const std::string& text) {
        std::filesystem::create_directories((folder_ / file).parent_path());
        std::ofstream(folder_ / file) << text;
    }
    [[nodiscard]] std::size_t free() const { return free_memory(folder_ / "proc", folder_ / "groups"); }

    std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) /
                                    ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(FreeMemoryTest, IsWhatIsAvailableAndFreeSwap) {
    EXPECT_EQ(free(), 1000 * kMiB);
}

TEST_F(FreeMemoryTest, GroupsWithoutALimitTakeNothing) {
    write("groups/job/memory.max", "max\n");
    write("groups/job/memory.current", "12345\n");
    EXPECT_EQ(free(), 1000 * kMiB);
}

TEST_F(FreeMemoryTest, TheTightestGroupCounts) {
    write("groups/job/memory.max", std::to_string(500 * kMiB));
    write("groups/job/memory.current", std::to_string(300 * kMiB));
    EXPECT_EQ(free(), (200 + 100) * kMiB);
    write("groups/job/step/memory.max", std::to_string(400 * kMiB));
    write("groups/job/step/memory.current", std::to_string(300 * kMiB));
    EXPECT_EQ(free(), (100 + 100) * kMiB);
    write("groups/memory.max", std::to_string(200 * kMiB));
    write("groups/memory.current", std::to_string(250 * kMiB));
    EXPECT_EQ(free(), 100 * kMiB);
}

TEST_F(FreeMemoryTest, AGroupMayBeDeniedSwap) {
    write("groups/job/memory.max", std::to_string(500 * kMiB));
    write("groups/job/memory.current", std::to_string(300 * kMiB));
    write("groups/job/memory.swap.max", std::to_string(30 * kMiB));
    write("groups/job/memory.swap.current", std::to_string(10 * kMiB));
    EXPECT_EQ(free(), (200 + 20) * kMiB);
    write("groups/job/step/memory.swap.max", "0\n");
    EXPECT_EQ(free(), 200 * kMiB);
    write("groups/job/step/memory.swap.max", "max\n");
    EXPECT_EQ(free(), (200 + 20) * kMiB);
}

TEST_F(FreeMemoryTest, PagesOfFilesInAGroupAreFree) {
    write("groups/job/memory.max", std::to_string(500 * kMiB));
    write("groups/job/memory.current", std::to_string(300 * kMiB));
    write("groups/job/memory.stat", "anon 1\ninactive_file " + std::to_string(60 * kMiB) + "\nactive_file " +
                                        std::to_string(40 * kMiB) + "\n");
    EXPECT_EQ(free(), (300 + 100) * kMiB);
}

TEST_F(FreeMemoryTest, IsUnlimitedWhereTheSystemDoesNotTell) {
    std::filesystem::remove(folder_ / "proc/meminfo");
    EXPECT_EQ(free(), std::numeric_limits<std::size_t>::max());
}

TEST(FreeMemory, OfThisMachineIsNeitherNothingNorMoreThanAnyHas) {
    EXPECT_GT(free_memory(), 16 * kMiB);
    EXPECT_LT(free_memory(), std::size_t{1} << 50);
}

}  // namespace
}  // namespace nearlight::core
