// SPDX-License-Identifier: Apache-2.0
// Tests the sharing of bands among workers that are not devices, so that tests decide when they are slow,
// stop or fail.
#include "host/session/band_sharing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <latch>
#include <mutex>
#include <numeric>
#include <thread>

#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using test::error_of;
using test::mentions;
using namespace std::chrono_literals;

constexpr uint kBands = 24;

/// A band's rows are one float, which is the number of the band.
FinishedBand numbered(uint index) {
    return {.rows = {static_cast<float>(index)}, .local_lights = 1};
}

BandWorker steady(const std::string& name, std::chrono::milliseconds pause = 0ms) {
    return {name, [pause] {
                return [pause](uint index, const WorkProgress& progress) -> std::optional<FinishedBand> {
                    std::this_thread::sleep_for(pause);
                    return progress(0.5) ? std::optional(numbered(index)) : std::nullopt;
                };
            }};
}

/// A worker that finishes `good` bands, then throws in the next one.
BandWorker failing_after(const std::string& name, uint good) {
    return {name, [good] {
                return [left = good](uint index, const WorkProgress&) mutable -> std::optional<FinishedBand> {
                    if (left-- == 0) {
                        throw Error(ErrorKind::failure, "the device was unplugged");
                    }
                    return numbered(index);
                };
            }};
}

/// The given worker, which starts when all workers that share `gate` have started.
BandWorker behind(std::latch& gate, const BandWorker& worker) {
    return {worker.name, [&gate, start = worker.start] {
                gate.arrive_and_wait();
                return start();
            }};
}

struct Result {
    std::vector<uint> order;  ///< order in which bands arrived
    std::size_t local_lights = 0;
    BandOutcome outcome;
};

Result share(
    const std::vector<BandWorker>& workers, uint window = kBands,
    const WorkProgress& progress = [](double) { return true; }) {
    Result result;
    result.outcome = share_bands(
        kBands, window, workers,
        [&](FinishedBand& band) {
            result.order.push_back(static_cast<uint>(band.rows.at(0)));
            result.local_lights += band.local_lights;
        },
        progress);
    return result;
}

std::vector<uint> from_first_to_last() {
    std::vector<uint> order(kBands);
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

uint bands_of(const BandOutcome& outcome) {
    return std::accumulate(outcome.shares.begin(), outcome.shares.end(), 0u,
                           [](uint sum, const BandShare& share) { return sum + share.bands; });
}

TEST(BandSharing, EachBandOnceAndInOrderHoweverManyWorkers) {
    for (const std::size_t count : {1u, 2u, 3u, 40u}) {
        std::vector<BandWorker> workers;
        for (std::size_t i = 0; i < count; ++i) {
            workers.push_back(steady("worker", i % 2 == 0 ? 0ms : 2ms));
        }
        for (const uint window : {0u, 1u, 2u, kBands}) {
            const Result result = share(workers, window);
            EXPECT_EQ(result.order, from_first_to_last()) << count << " workers, window " << window;
            EXPECT_EQ(result.local_lights, kBands);
            EXPECT_EQ(bands_of(result.outcome), kBands);
            EXPECT_FALSE(result.outcome.interrupted);
        }
    }
}

TEST(BandSharing, NoBandsAreNoWork) {
    const std::vector<BandWorker> workers{steady("idle")};
    const BandOutcome outcome = share_bands(
        0, 1, workers, [](FinishedBand&) { FAIL(); }, [](double) { return true; });
    EXPECT_EQ(bands_of(outcome), 0u);
    EXPECT_FALSE(outcome.interrupted);
}

TEST(BandSharing, TheFasterTakesMore) {
    std::latch gate(2);
    const Result result = share({behind(gate, steady("slow", 40ms)), behind(gate, steady("fast", 1ms))});
    EXPECT_EQ(result.order, from_first_to_last());
    EXPECT_GT(result.outcome.shares[1].bands, 2 * result.outcome.shares[0].bands);
    EXPECT_GT(result.outcome.shares[0].seconds, 0.03);
}

TEST(BandSharing, TheWindowBoundsHowFarAheadBandsAreBegun) {
    std::mutex mutex;
    uint received = 0;
    uint farthest = 0;
    const BandWorker watcher{"watcher", [&] {
                                 return [&](uint index, const WorkProgress&) -> std::optional<FinishedBand> {
                                     const std::lock_guard lock(mutex);
                                     farthest = std::max(farthest, index - std::min(received, index));
                                     return numbered(index);
                                 };
                             }};
    const std::vector<BandWorker> workers{steady("slow", 5ms), watcher};
    share_bands(
        kBands, 3, workers,
        [&](FinishedBand&) {
            const std::lock_guard lock(mutex);
            ++received;
        },
        [](double) { return true; });
    EXPECT_EQ(received, kBands);
    // Bands are counted as out when they are on their way to the sink.
    EXPECT_LE(farthest, 2u * 3u);
}

TEST(BandSharing, OthersRedoWhatAFailedWorkerHadInHand) {
    for (const uint good : {0u, 1u, 3u}) {
        std::latch gate(2);
        const Result result =
            share({behind(gate, failing_after("doomed", good)), behind(gate, steady("sound", 20ms))});
        EXPECT_EQ(result.order, from_first_to_last()) << "failing after " << good;
        EXPECT_EQ(bands_of(result.outcome), kBands);
        EXPECT_TRUE(result.outcome.shares[0].failed);
        EXPECT_EQ(result.outcome.shares[0].bands, good);
        EXPECT_FALSE(result.outcome.shares[1].failed);
    }
}

TEST(BandSharing, OneThatFailsWhenAllElseIsDoneIsReplacedToo) {
    std::latch taken(1);
    uint others_done = 0;
    const BandWorker doomed{"doomed", [&] {
                                return [&](uint index, const WorkProgress&) -> std::optional<FinishedBand> {
                                    EXPECT_EQ(index, 0u);
                                    taken.count_down();
                                    std::this_thread::sleep_for(60ms);
                                    throw Error(ErrorKind::failure, "lost the first band");
                                };
                            }};
    const BandWorker sound{"sound", [&] {
                               taken.wait();
                               return [&](uint index, const WorkProgress&) -> std::optional<FinishedBand> {
                                   ++others_done;
                                   return numbered(index);
                               };
                           }};
    const Result result = share({doomed, sound});
    EXPECT_EQ(result.order, from_first_to_last());
    EXPECT_EQ(others_done, kBands);
    EXPECT_TRUE(result.outcome.shares[0].failed);
    EXPECT_EQ(result.outcome.shares[1].bands, kBands);
}

TEST(BandSharing, AWorkerThatDoesNotStartIsLeftOut) {
    const BandWorker broken{"broken",
                            []() -> BandMaker { throw Error(ErrorKind::out_of_memory, "no room"); }};
    const Result result = share({broken, steady("sound")});
    EXPECT_EQ(result.order, from_first_to_last());
    EXPECT_TRUE(result.outcome.shares[0].failed);
}

TEST(BandSharing, WhenAllFailTheLastErrorIsThrown) {
    const Error error = error_of([] { share({failing_after("one", 2), failing_after("two", 3)}); });
    EXPECT_EQ(error.kind(), ErrorKind::failure);
    EXPECT_TRUE(mentions(error, "unplugged"));
}

TEST(BandSharing, ProgressGrowsAndStops) {
    std::vector<double> fractions;
    const Result result = share({steady("one", 10ms), steady("two", 10ms)}, kBands, [&](double fraction) {
        fractions.push_back(fraction);
        return fraction < 0.5;
    });
    EXPECT_TRUE(result.outcome.interrupted);
    EXPECT_LT(result.order.size(), kBands);
    EXPECT_EQ(result.order, [&] {
        std::vector<uint> order = from_first_to_last();
        order.resize(result.order.size());
        return order;
    }());
    ASSERT_FALSE(fractions.empty());
    EXPECT_GE(fractions.back(), 0.5);
    EXPECT_LE(fractions.back(), 1.0);
}

TEST(BandSharing, WhatTheSinkThrowsEndsTheWork) {
    const std::vector<BandWorker> workers{steady("one", 1ms), steady("two", 1ms)};
    const Error error = error_of([&] {
        share_bands(
            kBands, kBands, workers, [](FinishedBand&) { throw Error(ErrorKind::file, "the disk is full"); },
            [](double) { return true; });
    });
    EXPECT_EQ(error.kind(), ErrorKind::file);
}

TEST(AddShares, KeepsDevicesOfOneNameApart) {
    std::vector<BandShare> sum;
    add_shares(std::vector<BandShare>{{"a", 3, 1.0, false}, {"a", 2, 2.0, false}, {"b", 1, 4.0, false}}, sum);
    ASSERT_EQ(sum.size(), 3u);
    add_shares(std::vector<BandShare>{{"a", 1, 1.0, false}, {"a", 5, 1.0, true}, {"b", 1, 1.0, false}}, sum);
    EXPECT_EQ(sum[0].bands, 4u);
    EXPECT_EQ(sum[1].bands, 7u);
    EXPECT_TRUE(sum[1].failed);
    EXPECT_EQ(sum[2].seconds, 5.0);
}

TEST(AddShares, DevicesThatAreGoneKeepWhatTheyDid) {
    std::vector<BandShare> sum;
    add_shares(std::vector<BandShare>{{"a", 3, 1.0, true}, {"b", 1, 4.0, false}}, sum);
    add_shares(std::vector<BandShare>{{"b", 6, 1.0, false}}, sum);
    ASSERT_EQ(sum.size(), 2u);
    EXPECT_EQ(sum[0].bands, 3u);
    EXPECT_TRUE(sum[0].failed);
    EXPECT_EQ(sum[1].bands, 7u);
}

TEST(BandSharing, AReservedBandIsItsWorkersFirst) {
    std::latch gate(2);
    std::mutex mutex;
    std::vector<uint> made;
    BandWorker reserving = behind(gate, steady("reserving"));
    reserving.first_band = 7;
    reserving.start = [&, start = reserving.start] {
        return [&, make = start()](uint index, const WorkProgress& progress) {
            {
                const std::lock_guard lock(mutex);
                made.push_back(index);
            }
            return make(index, progress);
        };
    };
    const Result result = share({reserving, behind(gate, steady("other", 1ms))});
    EXPECT_EQ(result.order, from_first_to_last());
    ASSERT_FALSE(made.empty());
    EXPECT_EQ(made.front(), 7u);
    EXPECT_EQ(std::count(made.begin(), made.end(), 7u), 1);
}

TEST(BandSharing, AReservedBandIsMadeByOthersIfItsWorkerFails) {
    for (const uint good : {0u, 1u}) {
        BandWorker reserving = failing_after("reserving", good);
        reserving.first_band = 3;
        EXPECT_EQ(share({steady("good"), reserving}).order, from_first_to_last());
    }
    BandWorker never = steady("never starts");
    never.first_band = 3;
    never.start = []() -> BandMaker { throw Error(ErrorKind::failure, "it does not start"); };
    EXPECT_EQ(share({steady("good"), never}).order, from_first_to_last());
}

TEST(BandSharing, AWorkerWithoutABandIsToldOnceThatItMustWait) {
    uint told = 0;  // in the worker's thread, which has ended when it is looked at
    BandWorker quick = steady("quick");
    quick.wait = [&] { ++told; };
    BandWorker slow = steady("slow", 20ms);
    slow.first_band = 0;  // so that the quick one does not make all of them before this one begins
    const Result result = share({quick, slow});
    EXPECT_EQ(result.order, from_first_to_last());
    EXPECT_EQ(told, 1u);
}

}  // namespace
}  // namespace nearlight::core
