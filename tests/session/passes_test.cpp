// SPDX-License-Identifier: Apache-2.0
#include "host/session/passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "host/reference/test_rooms.h"
#include "tests/session/rendering.h"
#include "tests/session/yard_scene.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class Passes : public test::DeviceTest {};

Scene yard() {
    return test::yard({40, 24, 70});
}

RenderSettings with_passes(RenderSettings settings, uint passes) {
    settings.passes = passes;
    return settings;
}

/// Whether passes average the value at `index` in finished rows.
bool is_averaged(std::size_t index) {
    return pass_rules()[index % NEARLIGHT_LAYER_CHANNELS] == PassRule::mean;
}

/// Whether passes keep the first value at `index`.
bool is_of_first(std::size_t index) {
    return pass_rules()[index % NEARLIGHT_LAYER_CHANNELS] == PassRule::first;
}

/// Values of the layers that passes average, and of those that are the first pass's.
struct Differences {
    double light = 0;
    double geometry = 0;
};
Differences largest_differences(const Image& a, const Image& b) {
    Differences largest;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double difference = std::abs(double{a.values[i]} - b.values[i]);
        if (is_averaged(i)) {
            largest.light = std::max(largest.light, difference);
        } else if (is_of_first(i)) {
            largest.geometry = std::max(largest.geometry, difference);
        }
    }
    return largest;
}

TEST(PassSeed, NoTwoPassesOfNeighbouringSeedsAreAlike) {
    EXPECT_EQ(pass_seed(7, 0), 7u);
    std::set<uint> seeds;
    for (uint seed = 0; seed < 100; ++seed) {
        for (uint pass = 0; pass < 100; ++pass) {
            seeds.insert(pass_seed(seed, pass));
        }
    }
    EXPECT_GE(seeds.size(), 9998u);  // among 10⁴ random numbers of 32 bits, 0.01 equal pairs are expected
}

TEST_F(Passes, OneIsThePictureBitForBit) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        const test::Rendering plain = test::render_image(session, test::few_vpls());
        const test::Rendering one = test::render_image(session, with_passes(test::few_vpls(), 1));
        EXPECT_EQ(one.report.image_hash, plain.report.image_hash);
        RenderSettings hurried = test::few_vpls();
        hurried.seconds = 0;  // the first pass is still made, and is the only one
        const test::Rendering first = test::render_image(session, hurried);
        EXPECT_EQ(first.report.passes, 1u);
        EXPECT_EQ(first.report.image_hash, plain.report.image_hash);
        EXPECT_EQ(first.image.values, plain.image.values);
    });
}

/// Expects the picture of three passes to be the mean of three pictures, of which the later ones have what
/// the pilot of the first chose. Returns that choice.
RayBudget expect_mean_of_passes(Session& session, RenderSettings settings) {
    constexpr uint kPasses = 3;
    const test::Rendering averaged = test::render_image(session, with_passes(settings, kPasses));
    const RayBudget budget = averaged.report.ray_budget;
    RenderHooks later;
    later.vpls = [&](const ViewSettings& view, const SamplingSettings& sampling, uint seed) {
        VplSet set = session.sample(session.look(view, seed), sampling, seed);
        set.ray_budget = budget;
        return set;
    };
    Image expected;
    std::size_t vpls = 0;
    for (uint pass = 0; pass < kPasses; ++pass) {
        settings.seed = pass_seed(5, pass);
        if (pass > 0) {
            settings.view.range = averaged.report.range;
            settings.view.clamp_radius = budget.clamp_radius;
            settings.gather.direct_samples_per_pixel = budget.direct_samples_per_pixel;
            settings.gather.shared_limit = budget.shared_limit;
        }
        const test::Rendering single =
            test::render_image(session, settings, pass > 0 ? later : RenderHooks());
        vpls += single.report.totals.close_vpls + single.report.totals.distant_vpls;
        if (pass == 0) {
            expected = single.image;
            EXPECT_GT(largest_differences(expected, averaged.image).light, 1e-3);
            continue;
        }
        for (std::size_t i = 0; i < expected.values.size(); ++i) {
            expected.values[i] += is_averaged(i) ? single.image.values[i] : 0.0f;
        }
    }
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
        expected.values[i] /= is_averaged(i) ? kPasses : 1.0f;
    }
    const Differences differences = largest_differences(expected, averaged.image);
    EXPECT_LT(differences.light, 1e-5) << to_string(settings.sampling.sampler);
    EXPECT_EQ(differences.geometry, 0.0) << to_string(settings.sampling.sampler);
    EXPECT_EQ(averaged.report.passes, kPasses);
    EXPECT_EQ(averaged.report.totals.close_vpls + averaged.report.totals.distant_vpls, vpls);
    EXPECT_FALSE(averaged.report.interrupted);
    return budget;
}

TEST_F(Passes, AreTheMeanOfPicturesWithTheirSeeds) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        for (const SamplerKind sampler : {SamplerKind::close_range, SamplerKind::local}) {
            expect_mean_of_passes(session, test::few_vpls(sampler));
        }
    });
}

/// The pilot works in the first pass alone, but what it chose counts in all, also that receivers aim at
/// mirrors.
TEST_F(Passes, AllAimAtMirrorsIfTheFirstDoes) {
    on_each_device([](Device& device) {
        Scene scene = make_mirror_corner().scene;
        set_camera(scene, {-1.5, 1, 0}, {0, 0, 0}, 60);
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.view = {.width = 24, .height = 16, .range = 2.0f, .max_depth = 5};
        settings.gather.rays_per_pixel = 16;
        EXPECT_GT(expect_mean_of_passes(session, settings).aimed_rays, 0u);
    });
}

/// The pilot's light samples are for a pass of all samples.
TEST_F(Passes, AShortFirstPassHasFewerLightSamples) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.gather = {.samples_per_pixel = 8};
        settings.pass_samples = {2};
        const test::Rendering part = test::render_image(session, settings);
        RenderSettings decided = settings;
        decided.pass_samples.clear();
        decided.gather.direct_samples_per_pixel = part.report.ray_budget.direct_samples_per_pixel;
        const test::Rendering plain = test::render_image(session, with_samples(decided, 2));
        EXPECT_EQ(part.report.image_hash, plain.report.image_hash);
        settings.seconds = 1000;
        const test::Rendering by_time = test::render_image(session, settings);
        EXPECT_EQ(part.report.image_hash, by_time.report.image_hash);
    });
}

/// How many pixels surfaces cover in part.
std::size_t count_partly_covered(const Image& image) {
    const auto coverage = static_cast<std::size_t>(image.find_channel("A"));
    std::size_t count = 0;
    for (std::size_t i = coverage; i < image.values.size(); i += image.channels.size()) {
        count += image.values[i] > 0.0f && image.values[i] < 1.0f ? 1 : 0;
    }
    return count;
}

TEST_F(Passes, OfOneSampleSmoothEdges) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.gather.samples_per_pixel = 1;
        EXPECT_EQ(count_partly_covered(test::render_image(session, settings).image), 0u);
        settings.passes = 16;
        EXPECT_GT(count_partly_covered(test::render_image(session, settings).image), 10u);
    });
}

TEST_F(Passes, StopWhereTheTimeIsUsedOrEnoughAreMade) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.seconds = 1e9;
        settings.passes = 2;
        EXPECT_EQ(test::render_image(session, settings).report.passes, 2u);
        settings.passes.reset();
        settings.seconds = 0.5;
        EXPECT_GE(test::render_image(session, settings).report.passes, 1u);
    });
}

TEST_F(Passes, AnInterruptedOneLeavesTheMeanOfThoseBefore) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        const RenderSettings settings = with_passes(test::few_vpls(), 4);
        const test::Rendering stopped = test::render_image(
            session, settings, {.progress = [](double fraction) { return fraction < 0.25; }});
        EXPECT_TRUE(stopped.report.interrupted);
        // When the second pass begins, unless this thread was late. One band is the whole picture here, and
        // the last pass has not finished it.
        const uint whole = stopped.report.passes - 1;
        ASSERT_LT(whole, 4u);
        EXPECT_EQ(stopped.image.values,
                  whole > 0 ? test::render_image(session, with_passes(settings, whole)).image.values
                            : std::vector<float>{});
    });
}

TEST_F(Passes, AListOfThemMakesThePictureOfATimeOrAnErrorAgain) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.gather.samples_per_pixel = 5;
        for (const bool timed : {true, false}) {
            RenderSettings limited = settings;
            if (timed) {
                limited.seconds = 0.3;
            } else {
                limited.error = 0.03;
            }
            const test::Rendering made = test::render_image(session, limited);
            ASSERT_EQ(made.report.pass_samples.size(), made.report.passes);
            RenderSettings listed = settings;
            listed.pass_samples = made.report.pass_samples;
            const test::Rendering again = test::render_image(session, listed);
            EXPECT_EQ(again.report.image_hash, made.report.image_hash) << timed;
            EXPECT_EQ(again.image.values, made.image.values) << timed;
            EXPECT_EQ(again.report.pass_samples, made.report.pass_samples) << timed;
        }
    });
}

TEST_F(Passes, AShortPassHasItsShareOfEverything) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.gather.samples_per_pixel = 8;
        settings.gather.direct_samples_per_pixel = 16;
        settings.pass_samples = {4};
        RenderSettings half = settings;
        half.pass_samples.clear();
        half.gather.samples_per_pixel = 4;
        half.gather.direct_samples_per_pixel = 8;
        half.gather.rays_per_pixel = settings.gather.rays_per_pixel / 2;
        half.sampling.vpl_count = settings.sampling.vpl_count / 2;
        EXPECT_EQ(test::render_image(session, settings).report.image_hash,
                  test::render_image(session, half).report.image_hash);
    });
}

TEST_F(Passes, EndWhereTheErrorIsReached) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.error = 0.05;
        const RenderReport report = test::render_image(session, settings).report;
        ASSERT_TRUE(report.error);
        EXPECT_LE(*report.error, 0.05);
        EXPECT_GT(*report.error, 0.02);
        EXPECT_GT(report.passes, 1u);
        settings.error = 1e-5;
        settings.passes = 2;
        const RenderReport limited = test::render_image(session, settings).report;
        EXPECT_EQ(limited.passes, 2u);
        EXPECT_GT(*limited.error, 1e-5);
    });
}

TEST_F(Passes, ABlackPictureIsExactAfterOne) {
    on_each_device([](Device& device) {
        Scene scene = yard();
        scene.environment = {};
        for (Material& material : scene.materials) {
            material.emission = parameter_of(Vec3{0, 0, 0});
        }
        RenderSettings settings = test::few_vpls();
        settings.error = 0.01;
        const RenderReport report = test::render_image(device, scene, settings).report;
        EXPECT_EQ(report.passes, 1u);
        EXPECT_EQ(report.error, 0.0);
    });
}

TEST_F(Passes, TheVarianceIsThatOfManyPictures) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        constexpr uint kPictures = 24;
        for (const uint passes : {1u, 2u}) {
            RenderSettings settings = test::few_vpls();
            settings.sampling.vpl_count = 160;
            settings.gather.samples_per_pixel = 8;
            settings.gather.direct_samples_per_pixel = 8;
            settings.passes = passes;
            const std::vector<Image> images = test::render_seeds(session, settings, 100, kPictures);
            double estimated = 0.0;
            double true_variance = 0.0;
            for (std::size_t i = 0; i < images[0].values.size(); i += NEARLIGHT_LAYER_CHANNELS) {
                double sum = 0.0;
                double squares = 0.0;
                for (const Image& image : images) {
                    const double value = image.values[i + NEARLIGHT_LAYER_BEAUTY + 1];
                    sum += value;
                    squares += value * value;
                    estimated += image.values[i + NEARLIGHT_LAYER_VARIANCE + 1] / double{kPictures};
                }
                true_variance += (squares - sum * sum / kPictures) / (kPictures - 1);
            }
            EXPECT_GT(std::sqrt(true_variance / estimated), 0.8) << passes;
            EXPECT_LT(std::sqrt(true_variance / estimated), 1.25) << passes;
        }
    });
}

}  // namespace
}  // namespace nearlight::core
