// SPDX-License-Identifier: Apache-2.0
#include "host/session/pass_schedule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/session/passes.h"

namespace nearlight::core {
namespace {

using Samples = std::vector<uint>;

/// The passes of a schedule whose picture has the error 0.4 after 16 samples, falling as the root of the
/// samples.
Samples passes_of(const RenderSettings& settings) {
    PassSchedule schedule(settings);
    double done = 0.0;
    while (const auto samples = schedule.begin()) {
        schedule.note_vpls();
        done += *samples;
        schedule.end(settings.error ? std::optional(0.4 * std::sqrt(16.0 / done)) : std::nullopt);
    }
    return schedule.samples();
}

RenderSettings with_error(double error) {
    RenderSettings settings;
    settings.error = error;
    return settings;
}

void wait(double seconds) {
    const Stopwatch watch;
    while (watch.seconds() < seconds) {}
}

TEST(PassSchedule, IsOnePassUnlessMoreAreAskedFor) {
    EXPECT_EQ(passes_of({}), Samples{16});
    EXPECT_EQ(passes_of({.passes = 3}), (Samples{16, 16, 16}));
    RenderSettings listed;
    listed.pass_samples = {16, 5, 32, 1};
    EXPECT_EQ(passes_of(listed), listed.pass_samples);
}

TEST(PassSchedule, EndsAtTheErrorWithAPassThatIsNoLongerThanItTakes) {
    EXPECT_EQ(passes_of(with_error(0.5)), Samples{16});
    // 0.2 takes 64 samples.
    EXPECT_EQ(passes_of(with_error(0.2)), (Samples{16, 16, 16, 16}));
    // 0.25 takes 40.96 samples; 5 % are added to what is missing.
    EXPECT_EQ(passes_of(with_error(0.25)), (Samples{16, 16, 10}));
    // 0.39 takes 0.83 samples more, but a pass has at least a quarter of the samples.
    EXPECT_EQ(passes_of(with_error(0.39)), (Samples{16, 4}));
}

TEST(PassSchedule, StopsOnTheWayToAnErrorThatItNeverReaches) {
    EXPECT_EQ(passes_of(with_error(1e-5)).size(), kMaxPassesToError);
    RenderSettings settings = with_error(1e-5);
    settings.passes = 7;
    EXPECT_EQ(passes_of(settings).size(), 7u);
}

TEST(PassSchedule, BelievesAnErrorOfFewPixelsOnlyAfterSomePasses) {
    for (const double error : {0.01, 0.0}) {
        PassSchedule schedule(with_error(0.1));
        while (schedule.begin()) {
            schedule.believe_after(3);
            schedule.end(error);
        }
        EXPECT_EQ(schedule.samples().size(), error > 0.0 ? 3u : 1u);
    }
}

TEST(PassSchedule, HasOnePassOfTwoSamplesIfThereIsNoTime) {
    RenderSettings settings;
    settings.seconds = 0.0;
    EXPECT_EQ(passes_of(settings), Samples{2});
    settings.gather.samples_per_pixel = 1;
    EXPECT_EQ(passes_of(settings), Samples{1});
    settings.gather.samples_per_pixel = 16;
    settings.seconds = 1e9;
    settings.passes = 3;
    EXPECT_EQ(passes_of(settings), (Samples{16, 16, 16}));
}

TEST(PassSchedule, GoesOnAsIfItHadNotBeenInterrupted) {
    // 0.25 takes 40.96 samples, as above.
    PassSchedule schedule(with_error(0.25));
    schedule.resume({16}, std::nullopt, {}, 16, 0.75);
    EXPECT_EQ(schedule.begin(), 16u) << "the pass that was begun";
    EXPECT_NEAR(schedule.fraction(0.0), 28.0 / (16 * kMaxPassesToError), 1e-9);
    schedule.end(0.4 * std::sqrt(16.0 / 32));
    EXPECT_EQ(schedule.begin(), 10u);
    schedule.resume({16, 16}, 0.4 * std::sqrt(16.0 / 32), {}, 0, 0.0);
    EXPECT_EQ(schedule.begin(), 10u);
    schedule.end(0.25);
    EXPECT_EQ(schedule.begin(), std::nullopt);
    EXPECT_EQ(schedule.samples(), (Samples{16, 16, 10}));
}

TEST(PassSchedule, PlansByThePaceOfThePassesBefore) {
    RenderSettings settings;
    settings.seconds = 1000.0;
    PassSchedule schedule(settings);
    schedule.resume({16}, std::nullopt, {.sample_seconds = 100.0, .vpl_seconds = 200.0}, 0, 0.0);
    EXPECT_EQ(schedule.begin(), 6u) << "800 s are left for samples, and one is kept in reserve";
}

TEST(PassSchedule, GivesLaterPassesTheSamplesThatSplatsNeed) {
    RenderSettings settings;
    settings.seconds = 1000.0;
    const auto next = [&] {
        PassSchedule schedule(settings);
        schedule.resume({16}, std::nullopt, {.sample_seconds = 170.0, .vpl_seconds = 200.0}, 0, 0.0);
        return schedule.begin();
    };
    EXPECT_FALSE(next()) << "three samples fit in the time";
    settings.gather.splat = false;
    EXPECT_EQ(next(), 3u);
}

TEST(PassSchedule, EndsAtAnErrorWithTheSamplesThatSplatsNeed) {
    RenderSettings settings;
    settings.gather.samples_per_pixel = 8;
    settings.error = 0.03;
    PassSchedule schedule(settings);
    schedule.resume({8, 8, 8}, 0.0301, {}, 0, 0.0);
    EXPECT_EQ(schedule.begin(), 4u) << "one sample seems to be missing";
}

/// Of a walk's pictures, the first pass may have its VPLs from the picture before, and the second seldom has.
TEST(PassSchedule, CountsOnVplsThatAreNotKept) {
    RenderSettings settings;
    settings.seconds = 0.5;
    const auto makes_second_pass = [&](double seconds_unless_kept) {
        PassSchedule schedule(settings);
        EXPECT_EQ(schedule.begin(), 16u);
        schedule.note_vpls(seconds_unless_kept);
        schedule.end({});
        return schedule.begin().has_value();
    };
    EXPECT_TRUE(makes_second_pass(0.0));
    EXPECT_TRUE(makes_second_pass(0.1));
    EXPECT_FALSE(makes_second_pass(0.6));
}

TEST(PassSchedule, GivesUpOnlyAFirstPassThatTakesFarTooLong) {
    RenderSettings settings;
    settings.seconds = 0.05;
    PassSchedule slow(settings);
    ASSERT_EQ(slow.begin(), 16u);
    slow.note_vpls();
    EXPECT_FALSE(slow.is_too_long(0.0));
    wait(0.01);
    EXPECT_FALSE(slow.is_too_long(1e-6)) << "it is looked at from here on";
    wait(0.01);
    EXPECT_TRUE(slow.is_too_long(2e-6)) << "at this rate it would take hours";
    EXPECT_EQ(slow.begin(), 2u);
    EXPECT_FALSE(slow.is_too_long(1e-6)) << "it has the fewest samples already";
}

TEST(PassSchedule, IsNotAtItsEndBeforeAPassThatTakesLongerThanTheTime) {
    RenderSettings settings;
    settings.gather.samples_per_pixel = 2;
    settings.seconds = 0.01;
    PassSchedule schedule(settings);
    ASSERT_EQ(schedule.begin(), 2u);
    schedule.note_vpls();
    wait(0.3);  // long beside what a busy machine takes away between two calls
    EXPECT_NEAR(schedule.fraction(0.1), 0.1, 0.05);
    EXPECT_NEAR(schedule.fraction(0.5), 0.5, 0.05);
    EXPECT_EQ(schedule.fraction(1.0), 1.0);
    schedule.end({});
    EXPECT_EQ(schedule.begin(), std::nullopt);
}

TEST(PassSchedule, ExpectsWhatTheErrorSays) {
    PassSchedule schedule(with_error(0.1));
    EXPECT_FALSE(schedule.forecast());
    ASSERT_TRUE(schedule.begin());
    schedule.note_vpls();
    wait(0.02);
    schedule.end(0.4);
    const std::optional<PassForecast> forecast = schedule.forecast();
    ASSERT_TRUE(forecast);
    EXPECT_EQ(forecast->error, 0.4);
    EXPECT_NEAR(forecast->passes, 16.0, 1e-9);
    EXPECT_GE(forecast->seconds, 16 * 0.02);
    EXPECT_TRUE(forecast->reaches);
    EXPECT_NEAR(schedule.fraction(0.0), 1.0 / 16, 1e-9);
}

TEST(PassSchedule, KnowsThatABoundComesFirst) {
    RenderSettings settings = with_error(0.1);
    settings.passes = 15;
    PassSchedule schedule(settings);
    ASSERT_TRUE(schedule.begin());
    schedule.end(0.4);
    EXPECT_FALSE(schedule.forecast()->reaches);
}

TEST(PassSettings, ChangeAllThatAPixelGetsInProportion) {
    RenderSettings settings;
    settings.sampling.vpl_count = 1000;
    settings.gather.strata = 8;
    settings.gather.direct_samples_per_pixel = 64;
    settings.gather.rays_per_pixel = 16;
    const RenderSettings fewer = with_samples(settings, 4);
    EXPECT_EQ(fewer.gather.samples_per_pixel, 4u);
    EXPECT_EQ(fewer.gather.strata, 2u);
    EXPECT_EQ(fewer.sampling.vpl_count, 250u);
    EXPECT_EQ(fewer.gather.direct_samples_per_pixel, 16u);
    EXPECT_EQ(fewer.gather.rays_per_pixel, 4u);
    settings.gather.strata = 1;
    const RenderSettings whole = with_samples(settings, 4);
    EXPECT_EQ(whole.gather.strata, 1u);
    EXPECT_EQ(whole.sampling.vpl_count, 1000u) << "each sample asks all VPLs";
    EXPECT_EQ(with_samples(settings, 16).gather.direct_samples_per_pixel, 64u);
}

TEST(PassSettings, APassHasVplsHoweverFewItsSamples) {
    RenderSettings settings;
    settings.gather.samples_per_pixel = 4096;
    settings.sampling.vpl_count = 1000;
    settings.sampling.set_count = 2000;
    EXPECT_EQ(with_samples(settings, 2).sampling.vpl_count, 1u);
    EXPECT_EQ(with_samples(settings, 2).sampling.set_count, 1u);
    settings.sampling.vpl_count = 0;
    EXPECT_EQ(with_samples(settings, 2).sampling.vpl_count, 0u) << "none are wanted";
    settings.gather.samples_per_pixel = 1;
    settings.sampling.vpl_count = 1'000'000;
    EXPECT_EQ(with_samples(settings, 65536).sampling.vpl_count, 50'000'000u) << "the limit of a set";
}

}  // namespace
}  // namespace nearlight::core
