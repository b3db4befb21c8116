// SPDX-License-Identifier: Apache-2.0
#include "host/cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace nearlight::core {
namespace {

// This is global because a signal handler can reach only global state.
std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void note_interrupt(int) {
    interrupt_seen.store(true);
}

}  // namespace

void catch_interrupts() {
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // `nohup` has the program ignore that its terminal is gone.
    struct sigaction hangup {};
    if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) {
        sigaction(SIGHUP, &action, nullptr);
    }
}

bool interrupted() {
    return interrupt_seen.load();
}

}  // namespace nearlight::core
