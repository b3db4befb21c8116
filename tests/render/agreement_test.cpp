// SPDX-License-Identifier: Apache-2.0
// The renderer against the Embree path tracer, which shares no sampling code with it: same definition, same
// picture.
#include <gtest/gtest.h>

#include <cmath>

#include "host/reference/path_tracer.h"
#include "tests/render/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight {
namespace {

using namespace small_scenes;
using test::render_image;
using test::Rendering;

constexpr int kSize = 48;
constexpr float kClampRadius = 0.15f;

/// A closed room, 2 × 2 × 2, with a red and a green wall and a block on the floor; no light yet.
Scene room() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.7f, 0.7f, 0.7f}));
    const uint red = add_material(scene, lambertian({0.6f, 0.1f, 0.1f}));
    const uint green = add_material(scene, lambertian({0.1f, 0.5f, 0.1f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);  // floor
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);   // ceiling
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);   // back
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);  // front, behind the camera
    add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, green);
    const Vec3 corner{-0.2f, -1, 0.1f};
    add_quad(scene, corner + Vec3{0, 0.8f, 0}, {0, 0, 0.5f}, {0.6f, 0, 0.1f}, white);  // top
    add_quad(scene, corner, {0, 0.8f, 0}, {0.6f, 0, 0.1f}, white);
    add_quad(scene, corner + Vec3{0.6f, 0, 0.1f}, {0, 0.8f, 0}, {0, 0, 0.5f}, white);
    add_quad(scene, corner, {0, 0, 0.5f}, {0, 0.8f, 0}, white);
    set_camera(scene, {0.1, 0.2, -0.9}, {0, -0.3, 1}, 70);
    scene.camera.width = kSize;
    scene.camera.height = kSize;
    return scene;
}

Scene room_with_point_light() {
    Scene scene = room();
    add_point_light(scene, {0.3f, 0.7f, -0.2f}, {1.0f, 0.9f, 0.8f});
    return scene;
}

Scene room_with_area_light() {
    Scene scene = room();
    Material lamp = lambertian({0.0f, 0.0f, 0.0f});
    lamp.emission = {5, 5, 6};
    add_quad(scene, {-0.3f, 0.98f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    return scene;
}

Scene room_with_window() {
    Scene scene = room();
    // Without its ceiling, under a sky that is brighter on one side.
    scene.triangles.erase(scene.triangles.begin() + 2, scene.triangles.begin() + 4);
    scene.environment = {.width = 2,
                         .height = 2,
                         .radiance = {{2, 2, 2}, {0.5f, 0.5f, 1}, {0.1f, 0.1f, 0.1f}, {0, 0, 0}},
                         .to_world = {}};
    return scene;
}

RenderSettings settings_for(SamplerKind sampler, uint seed) {
    return {.sampler = sampler,
            .policy = Policy::partition,
            .vpl_count = 4000,
            .clamp_radius = kClampRadius,
            .max_depth = 6,
            .samples_per_pixel = 2,
            .direct_samples_per_pixel = 128,
            .seed = seed};
}

/// Mean of the pixels [x0, x1) × [y0, y1) of a channel.
double region_mean(const Image& image, const std::string& channel, int block) {
    const int blocks = 4;
    const int size = kSize / blocks;
    const auto index = static_cast<std::size_t>(image.find_channel(channel));
    double sum = 0;
    for (int y = block / blocks * size; y < (block / blocks + 1) * size; ++y) {
        for (int x = block % blocks * size; x < (block % blocks + 1) * size; ++x) {
            sum += image.at(x, y, index);
        }
    }
    return sum / (size * size);
}

/// Mean and standard error over several renders.
struct Estimate {
    double mean = 0;
    double error = 0;
};
Estimate estimate(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double sum = 0;
    double squares = 0;
    for (const double value : values) {
        sum += value;
        squares += value * value;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

/// Several seeds give the renderer's own spread, so the bounds are statistical: of each of 16 blocks of the
/// picture 6 standard errors (Student's t with 11 degrees of freedom: a false alarm in 10⁴ comparisons), of
/// the whole 5. The reference's own error is added to both.
void expect_agreement(Device& device, const Scene& scene, SamplerKind sampler) {
    constexpr uint kSeeds = 12;
    const Image reference =
        trace_paths(scene, {.spp = 512, .max_depth = 6, .clamp_radius = kClampRadius, .seed = 9});
    std::vector<Image> images;
    for (uint seed = 0; seed < kSeeds; ++seed) {
        images.push_back(render_image(device, scene, settings_for(sampler, 100 + seed)).image);
    }
    for (const std::string channel : {"direct.R", "direct.B", "indirect.R", "indirect.G", "indirect.B"}) {
        std::vector<double> means;
        for (const Image& image : images) {
            means.push_back(channel_mean(image, channel));
        }
        const double expected_mean = channel_mean(reference, channel);
        const Estimate whole = estimate(means);
        EXPECT_NEAR(whole.mean, expected_mean, 5 * whole.error + 0.002 * expected_mean) << channel;
        EXPECT_LT(whole.error, 0.01 * expected_mean) << channel << ": too noisy to tell anything";
        for (int block = 0; block < 16; ++block) {
            std::vector<double> values;
            for (const Image& image : images) {
                values.push_back(region_mean(image, channel, block));
            }
            const double expected = region_mean(reference, channel, block);
            const Estimate found = estimate(values);
            EXPECT_NEAR(found.mean, expected, 6 * std::hypot(found.error, 0.004 * expected) + 1e-6)
                << channel << " block " << block;
        }
    }
}

class Agreement : public test::DeviceTest {};

TEST_F(Agreement, InstantRadiosityWithPointLight) {
    on_each_device(
        [](Device& d) { expect_agreement(d, room_with_point_light(), SamplerKind::instant_radiosity); });
}
TEST_F(Agreement, InstantRadiosityWithAreaLight) {
    on_each_device(
        [](Device& d) { expect_agreement(d, room_with_area_light(), SamplerKind::instant_radiosity); });
}
TEST_F(Agreement, InstantRadiosityUnderSky) {
    on_each_device(
        [](Device& d) { expect_agreement(d, room_with_window(), SamplerKind::instant_radiosity); });
}
TEST_F(Agreement, PartitionWithPointLight) {
    on_each_device([](Device& d) { expect_agreement(d, room_with_point_light(), SamplerKind::close_range); });
}
TEST_F(Agreement, PartitionWithAreaLight) {
    on_each_device([](Device& d) { expect_agreement(d, room_with_area_light(), SamplerKind::close_range); });
}
TEST_F(Agreement, PartitionUnderSky) {
    on_each_device([](Device& d) { expect_agreement(d, room_with_window(), SamplerKind::close_range); });
}

}  // namespace
}  // namespace nearlight
