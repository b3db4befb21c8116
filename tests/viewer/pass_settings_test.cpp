// SPDX-License-Identifier: Apache-2.0
#include "viewer/pass_settings.h"

#include <gtest/gtest.h>

namespace nearlight::viewer {
namespace {

/// All passes together have what the settings of the whole picture say.
TEST(PassSettings, PassesShareTheWhole) {
    RenderSettings whole;
    whole.gather.samples_per_pixel = 16;
    whole.gather.direct_samples_per_pixel = 32;
    whole.gather.rays_per_pixel = 64;
    const GatherSettings pass = pass_gather(whole, StepKind::refining);
    EXPECT_EQ(pass.samples_per_pixel, 1u);
    EXPECT_EQ(pass.direct_samples_per_pixel, 2u);
    EXPECT_EQ(pass.rays_per_pixel, 4u);
    EXPECT_EQ(pass.strata, 16u);
    EXPECT_TRUE(pass.spread_single_samples) << "edges would stay jagged, however many passes there are";
}

TEST(PassSettings, EveryPassHasARay) {
    RenderSettings whole;
    whole.gather.samples_per_pixel = 1000;
    whole.gather.rays_per_pixel = 1;
    const GatherSettings pass = pass_gather(whole, StepKind::refining);
    EXPECT_EQ(pass.rays_per_pixel, 1u);
    EXPECT_EQ(pass.direct_samples_per_pixel, 1u);
    EXPECT_EQ(pass.strata, 1000u);
}

TEST(PassSettings, QuickPicturesOfManyVplsAreNotRefused) {
    RenderSettings whole;
    whole.sampling.vpl_count = 600'000;
    EXPECT_EQ(pass_gather(whole, StepKind::full).strata, 65'536u);
}

TEST(PassSettings, QuickPicturesAskLeast) {
    RenderSettings whole;
    whole.gather.compensate = false;
    whole.sampling.vpl_count = 2000;
    for (const StepKind kind : {StepKind::reduced, StepKind::full}) {
        const GatherSettings pass = pass_gather(whole, kind);
        EXPECT_EQ(pass.samples_per_pixel, 1u);
        EXPECT_EQ(pass.rays_per_pixel, 1u);
        EXPECT_FALSE(pass.compensate);
        EXPECT_FALSE(pass.spread_single_samples) << "edges of pictures that follow one another would tremble";
        EXPECT_EQ(pass.strata, 250u) << "eight VPLs a pixel";
    }
}

TEST(PassSettings, SmallPicturesHaveAPixelAtLeast) {
    const ViewSettings small = pass_view({.width = 641, .height = 5}, 1, 1, 8);
    EXPECT_EQ(small.width, 80);
    EXPECT_EQ(small.height, 1);
    EXPECT_EQ(pass_view({}, 320, 200, 2).height, 100);
}

TEST(PassSettings, OnlyRefiningPassesChangeTheirNumbers) {
    const Step full{.kind = StepKind::full};
    const Step first{.kind = StepKind::refining, .pass = 1};
    const Step second{.kind = StepKind::refining, .pass = 2};
    EXPECT_EQ(pass_seed(7, full), 7u);
    EXPECT_NE(pass_seed(7, first), pass_seed(7, second));
    EXPECT_TRUE(makes_vpls(first));
    EXPECT_FALSE(makes_vpls(second));
    EXPECT_FALSE(makes_vpls(full));
}

}  // namespace
}  // namespace nearlight::viewer
