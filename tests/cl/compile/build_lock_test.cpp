// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/build_lock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "tests/image/temporary_folder.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

const auto kNever = [] { return false; };
const auto kAtOnce = [] { return true; };

TEST(BuildLock, KeepsOthersFromTheSameKeyOnly) {
    const TemporaryFolder folder;
    const BuildLock lock(folder / "new folder", "key", kNever);
    EXPECT_TRUE(lock.held());
    EXPECT_FALSE(BuildLock(folder / "new folder", "key", kAtOnce).held());
    EXPECT_TRUE(BuildLock(folder / "new folder", "other key", kAtOnce).held());
    EXPECT_TRUE(BuildLock(folder / "other folder", "key", kAtOnce).held());
}

TEST(BuildLock, AWaitingThreadGoesOnWhenTheHolderIsGone) {
    const TemporaryFolder folder;
    std::optional<BuildLock> first(std::in_place, folder.path(), "key", kNever);
    std::atomic<bool> released = false;
    bool waited = false;
    std::jthread second([&] {
        const BuildLock lock(folder.path(), "key", kNever);
        waited = lock.held() && released;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    released = true;
    first.reset();
    second.join();
    EXPECT_TRUE(waited);
}

TEST(BuildLock, AFolderThatCannotBeWrittenHoldsNobodyUp) {
    EXPECT_FALSE(BuildLock("", "key", kNever).held());
    EXPECT_FALSE(BuildLock("/dev/null/no folder", "key", kNever).held());
}

class BuildLockTest : public test::DeviceTest {};

// PoCL 3.1 ends about one of eight such processes, in the first round or in a later one, if nothing holds
// them apart.
TEST_F(BuildLockTest, ProcessesThatCompileOneProgramAtOnceDoNotDisturbOneAnother) {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    for (int round = 0; round < 4; ++round) {
        const TemporaryFolder folder;
        std::filesystem::create_directories(folder / "pocl");
        const std::string process =
            "\"" + self + "\" --gtest_filter=ProgramTest.DefinesReachTheKernel >/dev/null 2>&1 & ";
        const std::string command = "export POCL_CACHE_DIR=\"" + (folder / "pocl").string() +
                                    "\"; pids=; for i in 1 2 3 4 5 6 7 8; do " + process +
                                    "pids=\"$pids $!\"; done; for i in $pids; do wait $i || exit 1; done";
        EXPECT_EQ(std::system(command.c_str()), 0) << "round " << round;
    }
}

}  // namespace
}  // namespace nearlight::core
