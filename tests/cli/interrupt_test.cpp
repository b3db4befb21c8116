// SPDX-License-Identifier: Apache-2.0
#include "host/cli/interrupt.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace nearlight::core {
namespace {

// Each test runs in its own process, because signals affect the whole process.

[[noreturn]] void interrupt_once(int signal) {
    catch_interrupts();
    const bool before = interrupted();
    std::raise(signal);
    std::_Exit(!before && interrupted() ? 7 : 8);
}

[[noreturn]] void interrupt_twice(std::chrono::milliseconds apart) {
    catch_interrupts();
    std::raise(SIGINT);
    std::this_thread::sleep_for(apart);
    std::raise(SIGINT);
    std::_Exit(interrupted() ? 7 : 8);
}

TEST(InterruptDeathTest, FirstSignalIsOnlyNoted) {
    EXPECT_EXIT(interrupt_once(SIGINT), testing::ExitedWithCode(7), "");
    EXPECT_EXIT(interrupt_once(SIGTERM), testing::ExitedWithCode(7), "");
}

[[noreturn]] void lose_terminal(void (*before)(int)) {
    std::signal(SIGHUP, before);
    interrupt_once(SIGHUP);
}

TEST(InterruptDeathTest, ALostTerminalInterruptsUnlessItIsIgnored) {
    EXPECT_EXIT(lose_terminal(SIG_DFL), testing::ExitedWithCode(7), "");
    EXPECT_EXIT(lose_terminal(SIG_IGN), testing::ExitedWithCode(8), "");  // as nohup does
}

TEST(InterruptDeathTest, ALaterSecondSignalEndsTheProcess) {
    EXPECT_EXIT(interrupt_twice(std::chrono::milliseconds(400)), testing::KilledBySignal(SIGINT), "");
}

// `timeout` signals the program and its group, which is one wish.
TEST(InterruptDeathTest, SignalsAtOnceAreOne) {
    EXPECT_EXIT(interrupt_twice(std::chrono::milliseconds(0)), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace nearlight::core
