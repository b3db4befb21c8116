// SPDX-License-Identifier: Apache-2.0
#include "host/stages/receiver_paths.h"

#include <algorithm>
#include <cmath>

#include "host/base/math.h"
#include "host/stages/gatherer.h"
#include "host/stages/light_tracer.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

class ReceiverPathsTest : public test::DeviceTest {};

constexpr float kAlbedo = 0.5f;

/// A floor under a point light, between a wall and a ceiling.
Scene corner() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({kAlbedo, kAlbedo, kAlbedo}));
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, grey);
    add_quad(scene, {-1, 0, 1}, {0, 2, 0}, {2, 0, 0}, grey);
    add_quad(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, grey);
    add_point_light(scene, {0.2f, 1.0f, 0.1f}, {1, 2, 3});
    return scene;
}

/// The same under a ceiling that shines, so that rays find as much light as light samples do.
Scene corner_under_bright_ceiling() {
    Scene scene = corner();
    scene.delta_emitters.clear();
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{1, 2, 3});
    add_quad(scene, {-1, 1.5f, -1}, {2, 0, 0}, {0, 0, 2}, add_material(scene, lamp));
    return scene;
}

/// A packet with all lanes at about one point of the floor, near the wall. Tiny shifts give them different
/// random numbers.
ReceiverPacket receivers_near_the_wall() {
    ReceiverPacket packet{};
    for (int lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        packet.px[lane] = 1e-5f * static_cast<float>(lane);
        packet.py[lane] = 1e-4f;
        packet.pz[lane] = 0.9f;
        packet.ny[lane] = 1;
    }
    return packet;
}

/// The same behind so many panes or mirrors.
ReceiverPacket receivers_behind(uint surfaces) {
    ReceiverPacket packet = receivers_near_the_wall();
    std::ranges::fill(packet.surface, surfaces << NEARLIGHT_RECEIVER_SURFACES_SHIFT);
    return packet;
}

/// The same with a normal map that tilts the floor's normal to n.
ReceiverPacket receivers_tilted_to(Vec3 n) {
    ReceiverPacket packet = receivers_near_the_wall();
    std::ranges::fill(packet.nx, n.x);
    std::ranges::fill(packet.ny, n.y);
    std::ranges::fill(packet.nz, n.z);
    std::ranges::fill(packet.mesh_normal, 32768u | 65535u << 16);  // pack_direction() of (0, 1, 0)
    return packet;
}

double mean_green(const Buffer<IrradiancePacket>& irradiance) {
    const IrradiancePacket packet = irradiance.download_one(0);
    double sum = 0;
    for (const float value : packet.g) {
        sum += value;
    }
    return sum / NEARLIGHT_PACKET_SIZE;
}

struct CornerLight {
    CornerLight(Device& on_device, const Scene& scene,
                const ReceiverPacket& points = receivers_near_the_wall())
        : device(on_device),
          on_gpu(device, scene),
          packet(points),
          receivers(device, std::span(&packet, 1)) {}

    double traced(float radius, uint bounces, uint samples) {
        Buffer<IrradiancePacket> direct(device, 1);
        return traced(radius, bounces, samples, direct);
    }
    double traced(float radius, uint bounces, uint samples, Buffer<IrradiancePacket>& direct) {
        Buffer<IrradiancePacket> indirect(device, 1);
        ReceiverPaths(device).run(
            {on_gpu.buffers,
             receivers,
             1,
             {.rays = samples, .max_edges = bounces + 1, .clamp_radius = radius, .seed = 4}},
            direct, indirect);
        return mean_green(indirect);
    }
    double gathered(float radius, uint bounces) {
        const CloseRange nothing{};
        CloseRegion region;
        region.range = Buffer<CloseRange>(device, std::span(&nothing, 1));
        region.triangles = Buffer<uint>(device, std::vector<uint>(on_gpu.buffers.host_info.triangle_count));
        const std::vector<Vpl> vpls =
            LightTracer(device).run(on_gpu.buffers, region, KeepDeposits::all,
                                    {.walk_count = 200'000, .bounce_count = bounces, .seed = 1});
        GatherSums<Vpl> sums(device, 1);
        Gatherer(device).gather({.tree = on_gpu.buffers.tree,
                                 .vpls = Buffer<Vpl>(device, std::span(vpls)),
                                 .vpl_count = vpls.size(),
                                 .receivers = receivers,
                                 .packet_count = 1,
                                 .clamp_radius = radius,
                                 .has_maps = true},
                                sums);
        return mean_green(sums.light);
    }

    Device& device;
    SceneOnDevice on_gpu;
    ReceiverPacket packet;
    Buffer<ReceiverPacket> receivers;
};

TEST_F(ReceiverPathsTest, SuppliesWhatABoundedGatherLeavesOut) {
    on_each_device([](Device& device) {
        CornerLight setup(device, corner());
        const double all = setup.traced(kInfinity, 4, 4096);
        for (const float radius : {0.3f, 1.0f}) {
            const double bounded = setup.gathered(radius, 4);
            const double rest = setup.traced(radius, 4, 4096);
            EXPECT_GT(rest, 0.03 * all) << "nothing to tell by";
            EXPECT_NEAR(bounded + rest, all, 0.015 * all) << "radius " << radius;
        }
    });
}

TEST_F(ReceiverPathsTest, DeeperPathsBringMoreAndAgreeWithWalksOfThatDepth) {
    on_each_device([](Device& device) {
        CornerLight setup(device, corner());
        double before = 0;
        for (const uint bounces : {1, 2, 5}) {
            const double traced = setup.traced(kInfinity, bounces, 4096);
            // The bound is tiny, because single deposits beside the point would otherwise be outliers.
            const double gathered = setup.gathered(0.05f, bounces);
            EXPECT_NEAR(traced, gathered, 0.02 * traced) << bounces;
            EXPECT_GT(traced, 1.02 * before);
            before = traced;
        }
    });
}

/// VPLs know nothing of the panes before a receiver.
void expect_no_long_paths(Device& device, const Scene& scene) {
    CornerLight plain(device, scene);
    for (const uint surfaces : {2u, 3u}) {
        CornerLight behind(device, scene, receivers_behind(surfaces));
        const double wanted = plain.traced(kInfinity, 4 - surfaces, 4096);
        for (const float radius : {0.3f, 1.0f}) {
            const double bounded = behind.gathered(radius, 4);
            const double found = bounded + behind.traced(radius, 4, 4096);
            EXPECT_NEAR(found, wanted, 0.015 * wanted) << surfaces << ", radius " << radius;
            EXPECT_GT(bounded + plain.traced(radius, 4, 4096), 1.03 * wanted) << "nothing to tell by";
        }
    }
}

TEST_F(ReceiverPathsTest, TakesAwayPathsThatAreTooLongBehindPanes) {
    on_each_device([](Device& device) {
        expect_no_long_paths(device, corner());
        expect_no_long_paths(device, corner_under_bright_ceiling());
    });
}

/// [Estevez et al. 2019], as Mitsuba's normal maps have it.
TEST_F(ReceiverPathsTest, SuppliesWhatABoundedGatherLeavesOutUnderANormalMap) {
    on_each_device([](Device& device) {
        const Vec3 n{0.6f, 0.8f, 0};
        CornerLight setup(device, corner(), receivers_tilted_to(n));
        Buffer<IrradiancePacket> direct(device, 1);
        const double all = setup.traced(kInfinity, 4, 4096, direct);
        for (const float radius : {0.1f, 1.0f}) {
            const double found = setup.gathered(radius, 4) + setup.traced(radius, 4, 4096);
            EXPECT_NEAR(found, all, 0.015 * all) << "radius " << radius;
        }
        const Vec3 to_light = Vec3{0.2f, 1.0f, 0.1f} - Vec3{0, 0, 0.9f};
        const float squared = dot(to_light, to_light);
        const Vec3 light = to_light / std::sqrt(squared);
        const float alpha2 = 0.125f * 0.75f * 0.75f;
        const float shadowing = 2 / (1 + std::sqrt(1 + alpha2 * (1 / (light.y * light.y) - 1)));
        const float expected = 2 / squared * dot(light, n) * shadowing;
        EXPECT_NEAR(mean_green(direct), expected, 2e-3 * expected);
    });
}

/// The room's lamps are above a veil, and the receivers below.
Scene below_a_veil(Scene scene) {
    const uint white = add_material(scene, lambertian({1, 1, 1}));
    const uint veil = add_material(scene, mask_material(parameter_of(0.0f), white));
    add_quad(scene, {-9, 0.8f, -9}, {18, 0, 0}, {0, 0, 18}, veil);
    return scene;
}

/// Each veil is an edge more, on the way of a light sample too.
TEST_F(ReceiverPathsTest, VeilsCountAmongTheEdgesOfAPath) {
    on_each_device([](Device& device) {
        CornerLight setup(device, below_a_veil(corner()));
        EXPECT_EQ(setup.traced(kInfinity, 1, 1024), 0.0) << "wall, veil, lamp";
        EXPECT_GT(setup.traced(kInfinity, 2, 1024), 0.0);
    });
}

/// Only light that came straight from a lamp, or through veils alone, is direct light.
TEST_F(ReceiverPathsTest, LightThroughAVeilAfterASurfaceIsIndirect) {
    on_each_device([](Device& device) {
        CornerLight setup(device, below_a_veil(corner_under_bright_ceiling()));
        Buffer<IrradiancePacket> direct(device, 1);
        setup.traced(kInfinity, 1, 4096, direct);
        const double expected = mean_green(direct);
        ASSERT_GT(expected, 0.1);
        setup.traced(kInfinity, 4, 4096, direct);
        EXPECT_NEAR(mean_green(direct), expected, 1e-3 * expected);
    });
}

TEST_F(ReceiverPathsTest, AddsNothingWhereThereIsNothingToTrace) {
    on_each_device([](Device& device) {
        CornerLight setup(device, corner());
        EXPECT_EQ(setup.traced(0.0f, 4, 16), 0.0);
        EXPECT_EQ(setup.traced(1.0f, 0, 16), 0.0);
        EXPECT_EQ(setup.traced(1.0f, 4, 0), 0.0);
        Scene dark = corner();
        dark.delta_emitters.clear();
        EXPECT_EQ(CornerLight(device, dark).traced(1.0f, 4, 16), 0.0);
    });
}

/// A lamp that a mirror shows to a receiver is where its image is.
class MirroredLamp {
  public:
    explicit MirroredLamp(Device& device) : device_(&device), on_gpu_(device, scene()) {
        for (int lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            packet_.px[lane] = 1e-4f * static_cast<float>(lane);
            packet_.ny[lane] = 1;
        }
    }

    /// Direct and indirect irradiance of a receiver behind `surfaces` others.
    std::pair<double, double> irradiance(uint max_edges, uint surfaces, uint curve = 0) {
        for (uint& lane : packet_.surface) {
            lane = surfaces << NEARLIGHT_RECEIVER_SURFACES_SHIFT | curve;
        }
        const Buffer<ReceiverPacket> receivers(*device_, std::span(&packet_, 1));
        Buffer<IrradiancePacket> direct(*device_, 1);
        Buffer<IrradiancePacket> indirect(*device_, 1);
        ReceiverPaths(*device_).run(
            {on_gpu_.buffers,
             receivers,
             1,
             {.light_samples = 1024, .rays = 4096, .max_edges = max_edges, .clamp_radius = 0.0f, .seed = 6}},
            direct, indirect);
        return {mean_green(direct), mean_green(indirect)};
    }

    /// By the midpoint rule: irradiance at the origin, about y, by a lamp of 1 × 1 with the radiance 5 that
    /// faces down, whose centre is (2, `height`, 0).
    static double expected(double height) {
        constexpr int kSteps = 200;
        double sum = 0;
        for (int i = 0; i < kSteps * kSteps; ++i) {
            const double x = (i % kSteps + 0.5) / kSteps + 1.5;
            const double z = (i / kSteps + 0.5) / kSteps - 0.5;  // NOLINT(bugprone-integer-division): the row
            const double squared = x * x + z * z + height * height;
            sum += height * height / (squared * squared);
        }
        return 5 * sum / (kSteps * kSteps);
    }

  private:
    /// The lamp at x = 2 and the height 1 faces up, to a large mirror at the height 2, so its image is at
    /// the height 3. A lamp at x = −2 and the height 1 faces down. Curve 1 is a half at all angles.
    static Scene scene() {
        Scene scene;
        Material lamp = lambertian({0, 0, 0});
        lamp.emission = parameter_of(Vec3{4, 5, 6});
        const uint shining = add_material(scene, lamp);
        add_quad(scene, {1.5f, 1, -0.5f}, {0, 0, 1}, {1, 0, 0}, shining);
        add_quad(scene, {-2.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, shining);
        add_quad(scene, {-9, 2, -9}, {18, 0, 0}, {0, 0, 18},
                 add_material(scene, conductor_material({0, 0, 0}, {1, 1, 1})));
        scene.transmission_curves.resize(2 * std::size_t{NEARLIGHT_CURVE_SIZE}, 0.5f);
        return scene;
    }

    Device* device_;
    SceneOnDevice on_gpu_;
    ReceiverPacket packet_{};
};

TEST_F(ReceiverPathsTest, AMirrorShowsTheImageOfALampWithoutAnyGather) {
    on_each_device([](Device& device) {
        MirroredLamp setup(device);
        const double lamp = MirroredLamp::expected(1);
        const double image = MirroredLamp::expected(3);
        const auto expect = [&](std::pair<double, double> found, double direct, double indirect) {
            EXPECT_NEAR(found.first, direct, 0.01 * direct);
            EXPECT_NEAR(found.second, indirect, 0.01 * indirect);
        };
        expect(setup.irradiance(1, 0), lamp, 0);
        expect(setup.irradiance(2, 0), lamp, image);
        // Surfaces before the receiver take edges from its paths.
        expect(setup.irradiance(1, 1), 0, 0);
        expect(setup.irradiance(2, 1), lamp, 0);
        expect(setup.irradiance(5, 3), lamp, image);
        // The receiver's coat lets a half through.
        expect(setup.irradiance(2, 0, 1), 0.5 * lamp, 0.5 * image);
    });
}

}  // namespace
}  // namespace nearlight::core
