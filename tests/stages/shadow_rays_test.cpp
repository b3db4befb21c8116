// SPDX-License-Identifier: Apache-2.0
// Shadow rays through panes, masks and clear glass, at a receiver on the ground under a lamp.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "host/base/math.h"
#include "host/stages/receiver_paths.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

class ShadowRaysTest : public test::DeviceTest {};

constexpr Vec3 kTint{0.9f, 0.5f, 0.2f};
constexpr double kFace = 0.04;  // reflectance of glass of the index 1.5 from straight above

/// A small lamp at the height 2 that shines down, or a point light, over the origin.
enum class Source { lamp, point };

Scene lit_by(Source source) {
    Scene scene;
    if (source == Source::point) {
        add_point_light(scene, {0, 2, 0}, {4, 4, 4});
        add_material(scene, lambertian({0, 0, 0}));
        add_quad(scene, {-9, 5, -9}, {1, 0, 0}, {0, 0, 1}, 0);  // scenes have triangles
        return scene;
    }
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{100, 100, 100});
    add_quad(scene, {-0.05f, 2, -0.05f}, {0.1f, 0, 0}, {0, 0, 0.1f}, add_material(scene, lamp));
    return scene;
}

/// A horizontal sheet between the receiver and the source.
void add_sheet(Scene& scene, uint material, float height = 1) {
    add_quad(scene, {-3, height, -3}, {0, 0, 6}, {6, 0, 0}, material);
}

/// The lower and the upper face of a body, whose fronts face away from it.
void add_body(Scene& scene, uint material) {
    add_quad(scene, {-3, 1, -3}, {6, 0, 0}, {0, 0, 6}, material);
    add_sheet(scene, material, 1.1f);
}

uint add_pane(Scene& scene) {
    Material pane = thin_dielectric_material(1.5);
    pane.transmission = parameter_of(kTint);
    return add_material(scene, pane);
}

uint add_mask(Scene& scene, float opacity) {
    const uint white = add_material(scene, lambertian({1, 1, 1}));
    return add_material(scene, mask_material(parameter_of(opacity), white));
}

struct Arrived {
    Vec3 direct{};
    Vec3 indirect{};
    double deviation = 0;  ///< of green between lanes, relative to the mean
};

/// Direct light of 64 receivers at about the origin, which look up.
Arrived arrived(Device& device, const Scene& scene, const ReceiverPathSettings& settings) {
    ReceiverPacket packet{};
    for (int lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        packet.px[lane] = 1e-5f * static_cast<float>(lane);
        packet.ny[lane] = 1;
    }
    const SceneOnDevice on_device(device, scene);
    const Buffer<ReceiverPacket> receivers(device, std::span(&packet, 1));
    Buffer<IrradiancePacket> direct(device, 1);
    Buffer<IrradiancePacket> indirect(device, 1);
    ReceiverPaths(device).run({on_device.buffers, receivers, 1, settings}, direct, indirect);
    const IrradiancePacket found = direct.download_one(0);
    const IrradiancePacket beyond = indirect.download_one(0);
    Arrived result;
    double squares = 0;
    for (int lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        result.direct += Vec3{found.r[lane], found.g[lane], found.b[lane]} / NEARLIGHT_PACKET_SIZE;
        result.indirect += Vec3{beyond.r[lane], beyond.g[lane], beyond.b[lane]} / NEARLIGHT_PACKET_SIZE;
        squares += double(found.g[lane]) * found.g[lane] / NEARLIGHT_PACKET_SIZE;
    }
    const double mean = result.direct.y;
    result.deviation = std::sqrt(std::max(0.0, squares - mean * mean)) / std::max(mean, 1e-20);
    return result;
}

/// One light sample a receiver, and room for `veils` veils.
ReceiverPathSettings sampled(uint veils) {
    return {.light_samples = 1, .max_edges = veils + 1, .seed = 3};
}

void expect_share(const Arrived& found, double expected, Vec3 share, double tolerance = 0.004) {
    EXPECT_NEAR(found.direct.x, expected * share.x, tolerance * expected);
    EXPECT_NEAR(found.direct.y, expected * share.y, tolerance * expected);
    EXPECT_NEAR(found.direct.z, expected * share.z, tolerance * expected);
}

// Irradiance with nothing between: radiance · area / height² by the lamp, intensity / height² by the point.
constexpr double kOpen = 100 * 0.01 / 4;
constexpr double kOpenPoint = 1;

struct VeilCase {
    const char* name;
    std::function<void(Scene&)> add;
    uint veils;
    Vec3 share;
};

const std::array<VeilCase, 6> kVeilCases{
    VeilCase{"null", [](Scene& s) { add_sheet(s, add_material(s, plain_material(NEARLIGHT_BSDF_NULL))); }, 1,
             Vec3{1, 1, 1}},
    VeilCase{"pane", [](Scene& s) { add_sheet(s, add_pane(s)); }, 1,
             kTint* static_cast<float>((1 - kFace) / (1 + kFace))},
    VeilCase{"mask", [](Scene& s) { add_sheet(s, add_mask(s, 0.3f)); }, 1, Vec3{0.7f, 0.7f, 0.7f}},
    VeilCase{"blend of a pane and a mask",
             [](Scene& s) {
                 const uint pane = add_pane(s);
                 const uint mask = add_mask(s, 1.0f);
                 add_sheet(s, add_material(s, blend_material(parameter_of(0.25f), pane, mask)));
             },
             1, kTint* static_cast<float>(0.75 * (1 - kFace) / (1 + kFace))},
    VeilCase{"a mask in two sides",
             [](Scene& s) {
                 const uint front = add_mask(s, 1.0f);
                 const uint back = add_mask(s, 0.4f);  // shadow rays come from below
                 add_sheet(s, add_material(s, two_sided_material(front, back)));
             },
             1, Vec3{0.6f, 0.6f, 0.6f}},
    VeilCase{"three masks",
             [](Scene& s) {
                 const uint mask = add_mask(s, 0.5f);
                 for (const float height : {0.5f, 1.0f, 1.5f}) {
                     add_sheet(s, mask, height);
                 }
             },
             3, Vec3{0.125f, 0.125f, 0.125f}},
};

TEST_F(ShadowRaysTest, LightSamplesOfALampTakeTheTransmittanceOfVeils) {
    on_each_device([](Device& device) {
        expect_share(arrived(device, lit_by(Source::lamp), sampled(0)), kOpen, {1, 1, 1});
        for (const VeilCase& veil : kVeilCases) {
            SCOPED_TRACE(veil.name);
            Scene scene = lit_by(Source::lamp);
            veil.add(scene);
            expect_share(arrived(device, scene, sampled(veil.veils)), kOpen, veil.share);
            expect_share(arrived(device, scene, sampled(veil.veils - 1)), kOpen, {0, 0, 0});
        }
    });
}

TEST_F(ShadowRaysTest, RaysShareTheLightWithLightSamples) {
    on_each_device([](Device& device) {
        for (const VeilCase& veil : kVeilCases) {
            SCOPED_TRACE(veil.name);
            // A lamp that rays find as often as not.
            Scene scene = lit_by(Source::lamp);
            for (Vertex& vertex : scene.vertices) {
                vertex.position.x *= 40;
                vertex.position.z *= 40;
            }
            const double open = arrived(device, scene, {.light_samples = 4096, .seed = 5}).direct.y;
            veil.add(scene);
            const ReceiverPathSettings both{
                .light_samples = 256, .rays = 256, .max_edges = veil.veils + 1, .clamp_radius = 0, .seed = 3};
            expect_share(arrived(device, scene, both), open, veil.share, 0.015);
        }
    });
}

/// Rays alone would find the lamp, which fills a 1300th of a cosine-distributed hemisphere, about once in 80
/// receivers that send 16 rays each: their deviation would be ten times the mean.
TEST_F(ShadowRaysTest, LightBehindAPaneHasLittleNoise) {
    on_each_device([](Device& device) {
        for (const VeilCase& veil : kVeilCases) {
            SCOPED_TRACE(veil.name);
            Scene scene = lit_by(Source::lamp);
            veil.add(scene);
            const Arrived found =
                arrived(device, scene, {.light_samples = 16, .rays = 16, .max_edges = 6, .clamp_radius = 0});
            expect_share(found, kOpen, veil.share, 0.01);
            EXPECT_LT(found.deviation, 0.05);
        }
    });
}

/// A map turns the normal of what passes it, so shadow rays cannot tell what the BSDF will do.
TEST_F(ShadowRaysTest, VeilsUnderMapsAreLeftToRays) {
    on_each_device([](Device& device) {
        Scene scene = lit_by(Source::lamp);
        for (Vertex& vertex : scene.vertices) {
            vertex.position.x *= 40;
            vertex.position.z *= 40;
        }
        const double open = arrived(device, scene, {.light_samples = 4096, .seed = 5}).direct.y;
        const uint mask = add_mask(scene, 0.3f);
        const Parameter flat = parameter_of(Vec3{0.5f, 0.5f, 1.0f});
        add_sheet(scene, add_material(scene, normal_map_material(flat, mask)));
        expect_share(arrived(device, scene, sampled(4)), open, {0, 0, 0});
        const ReceiverPathSettings rays{
            .light_samples = 16, .rays = 4096, .max_edges = 2, .clamp_radius = 0, .seed = 3};
        Arrived found = arrived(device, scene, rays);
        expect_share(found, open, {0, 0, 0});
        found.direct = found.indirect;  // what a map lets pass counts as scattered
        expect_share(found, open, Vec3{0.7f, 0.7f, 0.7f}, 0.015);
    });
}

TEST_F(ShadowRaysTest, PointLightsShineThroughVeilsOnlyWhereTheseAreOpenOrGlassIsClear) {
    on_each_device([](Device& device) {
        for (const VeilCase& veil : kVeilCases) {
            SCOPED_TRACE(veil.name);
            Scene scene = lit_by(Source::point);
            veil.add(scene);
            expect_share(arrived(device, scene, sampled(4)), kOpenPoint, {0, 0, 0});
            scene.open_veils = true;
            expect_share(arrived(device, scene, sampled(4)), kOpenPoint, veil.share);
            scene.open_veils = false;
            scene.clear_glass = true;
            expect_share(arrived(device, scene, sampled(4)), kOpenPoint, veil.share);
        }
    });
}

TEST_F(ShadowRaysTest, ClearGlassTakesWhatItsTwoFacesReflect) {
    on_each_device([](Device& device) {
        for (const Source source : {Source::lamp, Source::point}) {
            const double open = source == Source::lamp ? kOpen : kOpenPoint;
            Scene scene = lit_by(source);
            Material glass = dielectric_material(1.5);
            glass.transmission = parameter_of(kTint);
            add_body(scene, add_material(scene, glass));
            expect_share(arrived(device, scene, sampled(4)), open, {0, 0, 0});
            scene.open_veils = true;
            expect_share(arrived(device, scene, sampled(4)), open, {0, 0, 0});
            scene.clear_glass = true;
            const auto faces = static_cast<float>((1 - kFace) * (1 - kFace));
            expect_share(arrived(device, scene, sampled(4)), open, kTint * kTint * faces);
            expect_share(arrived(device, scene, sampled(1)), open, {0, 0, 0});
            scene.materials.back().roughness = parameter_of(0.2f);  // ground glass scatters light
            expect_share(arrived(device, scene, sampled(4)), open, {0, 0, 0});
        }
    });
}

}  // namespace
}  // namespace nearlight::core
