// SPDX-License-Identifier: Apache-2.0
#include "host/cli/interrupt.h"

#include <time.h>

#include <atomic>
#include <csignal>
#include <cstdint>

namespace nearlight::core {
namespace {

/// Signals within this time are one wish to end: `timeout` sends its signal to the program and to the group of
/// processes in which the program is.
constexpr std::int64_t kOneWishNs = 300'000'000;

// This is global because a signal handler can reach only global state. 0: no signal came yet.
std::atomic<std::int64_t> first_signal_ns{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

/// The clock that POSIX lets signal handlers read.
std::int64_t now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

extern "C" void note_interrupt(int signal) {
    std::int64_t first = 0;
    const std::int64_t now = now_ns();
    if (!first_signal_ns.compare_exchange_strong(first, now) && now - first > kOneWishNs) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

}  // namespace

void catch_interrupts() {
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // `nohup` has the program ignore that its terminal is gone.
    struct sigaction hangup {};
    if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) {
        sigaction(SIGHUP, &action, nullptr);
    }
}

bool interrupted() {
    return first_signal_ns.load() != 0;
}

}  // namespace nearlight::core
