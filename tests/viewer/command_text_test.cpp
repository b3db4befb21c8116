// SPDX-License-Identifier: Apache-2.0
#include "viewer/command_text.h"

#include <gtest/gtest.h>

#include <vector>

namespace nearlight::viewer {
namespace {

const std::vector<std::string> kScene{"scene.xml"};

TEST(CommandText, DefaultsAreLeftOut) {
    EXPECT_EQ(command_text(kScene, {}, {}, "a.exr"),
              "nearlight render scene.xml --exposure=0 --tonemap linear -o a.exr");
}

TEST(CommandText, NamesWhatDiffers) {
    RenderSettings settings;
    settings.view.camera =
        CameraPose{.origin = {1, 2.5f, -3}, .target = {0, 0, 0}, .up = Vec3{0, 0, 1}, .fov_x_degrees = 50};
    settings.view.width = 320;
    settings.view.height = 200;
    settings.view.clamp_radius = 0.1f;
    settings.sampling.sampler = SamplerKind::instant_radiosity;
    settings.sampling.vpl_count = 2000;
    settings.sampling.cuts = true;
    settings.sampling.set_count = 50'000;
    settings.gather.compensate = false;
    EXPECT_EQ(
        command_text(kScene, settings, {.exposure = -1.5f, .tone_curve = ToneCurve::agx}, "a.png"),
        "nearlight render scene.xml --origin=1,2.5,-3 --target=0,0,0 --up=0,0,1 --fov 50 --size 320x200 "
        "--clamp-radius 0.1 --sampler instant-radiosity --vpls 2000 --cuts on --vpl-set 50000 --compensate "
        "off --exposure=-1.5 --tonemap agx -o a.png");
}

/// Roulette and cuts exclude each other, as on the command line.
TEST(CommandText, NamesTheRoulette) {
    RenderSettings settings;
    settings.gather.roulette = 0.5f;
    EXPECT_EQ(command_text(kScene, settings, {}, "a.exr"),
              "nearlight render scene.xml --roulette 0.5 --exposure=0 --tonemap linear -o a.exr");
}

/// `nearlight render` refuses a policy and a close fraction with the other samplers, which the panel can
/// choose after both were set.
TEST(CommandText, TheSamplerCloseRangeAloneHasAPolicyAndACloseFraction) {
    for (const SamplerKind sampler :
         {SamplerKind::close_range, SamplerKind::instant_radiosity, SamplerKind::rejection,
          SamplerKind::metropolis, SamplerKind::bidirectional, SamplerKind::local}) {
        RenderSettings settings;
        settings.sampling = {.sampler = sampler, .policy = Policy::paper, .close_fraction = 0.5f};
        const bool takes_both = sampler == SamplerKind::close_range;
        const std::string own = takes_both ? " --policy paper --close-fraction 0.5"
                                           : std::string(" --sampler ") + name_of(sampler);
        EXPECT_EQ(command_text(kScene, settings, {}, "a.exr"),
                  "nearlight render scene.xml" + own + " --exposure=0 --tonemap linear -o a.exr");
    }
}

/// `nearlight render` refuses cuts with this sampler, which the panel can choose.
TEST(CommandText, TheSamplerLocalHasNoCuts) {
    RenderSettings settings;
    settings.sampling = {.sampler = SamplerKind::local, .cuts = true, .set_count = 50'000};
    EXPECT_EQ(command_text(kScene, settings, {}, "a.exr"),
              "nearlight render scene.xml --sampler local --exposure=0 --tonemap linear -o a.exr");
}

}  // namespace
}  // namespace nearlight::viewer
