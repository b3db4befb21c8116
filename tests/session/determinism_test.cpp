// SPDX-License-Identifier: Apache-2.0
// The same seed gives the same bits, however the picture is cut into bands and batches.
#include <gtest/gtest.h>

#include <tuple>

#include "host/scene/material_model.h"
#include "host/session/plan.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

uint add_rough_plastic(Scene& scene) {
    Material plastic = plastic_material(scene, {.alpha = 0.1});
    plastic.reflectance = parameter_of(Vec3{0.5f, 0.4f, 0.3f});
    return add_material(scene, plastic);
}

/// A coated and a plain floor, a lamp and a sky, for which every kind of random number is drawn.
Scene terrace() {
    Scene scene;
    const uint coat = add_rough_plastic(scene);
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, coat);
    add_quad(scene, {-1, -0.5f, 0}, {0, 0, 1}, {1, 0, 0},
             add_material(scene, lambertian({0.6f, 0.6f, 0.6f})));
    add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    scene.environment = {.width = 1, .height = 1, .radiance = {{0.3f, 0.4f, 0.5f}}, .to_world = {}};
    set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, 70);
    scene.camera.width = 100;
    scene.camera.height = 60;
    return scene;
}

RenderSettings terrace_settings(uint seed, SamplerKind sampler = SamplerKind::close_range) {
    return {.sampling = {.sampler = sampler, .vpl_count = 120},
            .gather = {.samples_per_pixel = 6, .direct_samples_per_pixel = 12},
            .seed = seed};
}

class Determinism : public test::DeviceTest {};

TEST_F(Determinism, BandsAndBatchesDoNotChangeABit) {
    on_each_device([](Device& device) {
        // These are the samplers whose work on the picture differs; close-range sampling also runs with
        // roulette or cuts, and with strata that samples take turns to ask about, or not.
        for (const auto& [sampler, roulette, strata, cuts] :
             {std::tuple{SamplerKind::close_range, 0.0f, 6u, false},
              {SamplerKind::close_range, 0.0f, 1u, false},
              {SamplerKind::close_range, 2.0f, 3u, false},
              {SamplerKind::close_range, 2.0f, 6u, false},
              {SamplerKind::close_range, 0.0f, 6u, true},
              {SamplerKind::close_range, 0.0f, 1u, true},
              {SamplerKind::instant_radiosity, 0.0f, 4u, true},
              {SamplerKind::local, 0.0f, 6u, false}}) {
            RenderSettings settings = terrace_settings(1, sampler);
            settings.gather.roulette = roulette;
            settings.gather.strata = strata;
            settings.sampling.cuts = cuts;
            const std::uint64_t whole = test::render_image(device, terrace(), settings).report.image_hash;
            for (const std::size_t largest : {std::size_t{1} << 20u, std::size_t{5} << 17u}) {
                DeviceEntry entry = device.entry();
                entry.max_allocation_bytes = largest;  // 60 000 receivers do not fit: the picture is cut
                Device small(entry, device.options());
                EXPECT_EQ(test::render_image(small, terrace(), settings).report.image_hash, whole)
                    << to_string(sampler) << ", roulette " << roulette << ", " << strata << " strata, "
                    << (cuts ? "cuts, " : "") << largest;
            }
        }
    });
}

TEST_F(Determinism, RepeatingGivesTheSamePictureAndAnotherSeedAnother) {
    on_each_device([](Device& device) {
        for (const SamplerKind sampler :
             {SamplerKind::close_range, SamplerKind::bidirectional, SamplerKind::local}) {
            const auto hash = [&](uint seed) {
                return test::render_image(device, terrace(), terrace_settings(seed, sampler))
                    .report.image_hash;
            };
            const std::uint64_t first = hash(1);
            EXPECT_EQ(hash(1), first) << to_string(sampler);
            EXPECT_NE(hash(2), first) << to_string(sampler);
        }
    });
}

TEST_F(Determinism, BandsDoNotChangeAnInterleavedPicture) {
    on_each_device([](Device& device) {
        for (const std::uint32_t strata : {16u, 96u}) {
            RenderSettings settings = terrace_settings(1);
            settings.view.height = 130;
            settings.gather.interleave = 4;
            settings.gather.strata = strata;
            const std::uint64_t whole = test::render_image(device, terrace(), settings).report.image_hash;
            DeviceEntry entry = device.entry();
            entry.max_allocation_bytes = std::size_t{5} << 18u;  // 160 000 receivers do not fit
            Device small(entry, device.options());
            EXPECT_EQ(test::render_image(small, terrace(), settings).report.image_hash, whole) << strata;
        }
    });
}

// Where every pixel asks about all VPLs and rays share nothing, the order of receivers decides nothing.
TEST_F(Determinism, InterleavingAloneChangesNoBit) {
    on_each_device([](Device& device) {
        RenderSettings settings = terrace_settings(1);
        settings.gather.strata = 1;
        settings.gather.compensate = false;  // else other bundles share other light
        const std::uint64_t plain = test::render_image(device, terrace(), settings).report.image_hash;
        for (const std::uint32_t interleave : {2u, 4u}) {
            settings.gather.interleave = interleave;
            EXPECT_EQ(test::render_image(device, terrace(), settings).report.image_hash, plain) << interleave;
        }
    });
}

TEST_F(Determinism, PlansAreReallyCut) {
    on_each_device([](Device& device) {
        DeviceEntry entry = device.entry();
        entry.max_allocation_bytes = std::size_t{5} << 17u;
        const Device small(entry, device.options());
        const RenderPlan plan =
            make_plan(std::vector{receivers_per_batch(small)},
                      {.width = 100, .height = 60, .samples_per_pixel = 6, .branch_count = 2});
        EXPECT_TRUE(plan.band_count() > 1 || plan.batches(0).size() > 1);
    });
}

}  // namespace
}  // namespace nearlight::core
