// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_reflections.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/division.h"
#include "host/scene/material_model.h"
#include "host/stages/joint_programs.h"
#include "tests/support/brought_light.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::brought;
using test::Brought;

class SharedReflectionsTest : public test::DeviceTest {};

constexpr std::size_t kGlossyReceivers = std::size_t{NEARLIGHT_BUNDLE_PACKETS} * NEARLIGHT_PACKET_SIZE;
constexpr float kRoomHeight = 1.0f;  // of the ceiling above the floor, m

Material metal(float alpha) {
    Material material = conductor_material({0.2f, 0.9f, 1.1f}, {3.9f, 2.4f, 2.2f});
    material.roughness = parameter_of(Vec3{alpha, alpha, 0});
    return material;
}

/// A floor of the material under a lamp, and a black wall that shades a part of it.
Scene floor_under_lamp(const Material& floor) {
    Scene scene;
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, floor));
    add_quad(scene, {-0.9f, 0, -2}, {0, 0.4f, 0}, {0, 0, 1.9f}, add_two_sided(scene, lambertian({0, 0, 0})));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{30, 20, 10});
    add_quad(scene, {-1.5f, 0.7f, -0.3f}, {0.2f, 0.2f, 0}, {0, 0, 0.5f}, add_two_sided(scene, lamp));
    return scene;
}

/// Receivers on a small part of the ceiling, from where gloss of the floor looks wide. Every fifth is absent,
/// and the last three are far away, where none of it is shared.
std::vector<ReceiverPacket> receivers_on_the_ceiling() {
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < kGlossyReceivers; ++i) {
        const float x = 0.3f + 0.02f * static_cast<float>(i % 16) + (i + 3 >= kGlossyReceivers ? 1.2f : 0.0f);
        const float z = 0.1f + 0.02f * static_cast<float>(i / 16);
        points.push_back({{x, kRoomHeight, z}, i % 5 == 4 ? Vec3{0, 0, 0} : Vec3{0, -1, 0}});
    }
    return test::pack_receivers(points);
}

constexpr ReceiverPathSettings kTwoGlossyRays{
    .rays = 2, .max_edges = 4, .clamp_radius = 0.5f, .shares_reflections = true};
constexpr ReceiverPathSettings kManyGlossyRays{.rays = 512, .max_edges = 4, .clamp_radius = 0.5f};

void expect_what_own_rays_bring(Device& device, const Scene& scene,
                                GatherKernel kernel = GatherKernel::automatic,
                                const ReceiverPathSettings& settings = kTwoGlossyRays) {
    const std::vector<ReceiverPacket> packets = receivers_on_the_ceiling();
    const Brought own = brought(device, scene, packets, false, kManyGlossyRays, 64, kernel);
    const Brought shared = brought(device, scene, packets, true, settings, 8192, kernel);
    ASSERT_GT(own.sum(), 0.1);
    EXPECT_NEAR(shared.sum(), own.sum(), 0.01 * own.sum());
    const double tolerance = 0.2 * own.sum() / kGlossyReceivers;
    for (std::size_t i = 0; i < own.mean.size(); ++i) {
        EXPECT_NEAR(shared.mean[i], own.mean[i], 0.1 * own.mean[i] + tolerance) << i;
    }
}

TEST_F(SharedReflectionsTest, BringWhatOwnRaysBring) {
    on_each_device([](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            SCOPED_TRACE(kernel == GatherKernel::rays ? "single rays" : "packets");
            expect_what_own_rays_bring(device, floor_under_lamp(metal(0.2f)), kernel);
        }
    });
}

/// A metal floor and a wall that it reflects: light over more surfaces.
Scene floor_beside_wall() {
    Scene scene = floor_under_lamp(metal(0.3f));
    add_quad(scene, {2, 0, -2}, {0, 0, 4}, {0, 0.8f, 0},
             add_two_sided(scene, lambertian({0.5f, 0.7f, 0.5f})));
    return scene;
}

/// A lamp, a point, and a sky.
TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringOfAllLights) {
    on_each_device([](Device& device) {
        Scene scene = floor_beside_wall();
        add_point_light(scene, {0.5f, 0.6f, -0.8f}, {0.3f, 0.3f, 0.3f});
        scene.environment = patterned_map(6, 4);
        expect_what_own_rays_bring(device, scene);
    });
}

/// Adds a lamp under a sheet of glass, through which no light sample sees it: rays find its light by chance.
/// The lamp shines to the side of cross(edge1, edge2).
void add_lamp_behind_glass(Scene& scene, Vec3 corner, Vec3 edge1, Vec3 edge2, Vec3 radiance) {
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(radiance);
    add_quad(scene, corner, edge1, edge2, add_material(scene, lamp));
    const Vec3 normal = normalize(cross(edge1, edge2));
    add_quad(scene, corner + 0.02f * normal - 0.5f * (edge1 + edge2), 2.0f * edge1, 2.0f * edge2,
             add_material(scene, dielectric_material(1.5)));
}

/// Most of what rays bring from a lamp behind glass over the wall is above the limit.
TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringUpToALimit) {
    on_each_device([](Device& device) {
        Scene scene = floor_beside_wall();
        add_lamp_behind_glass(scene, {0.8f, 0.4f, -0.5f}, {0, 0.4f, 0}, {0, 0, 1}, {10, 10, 10});
        const std::vector<ReceiverPacket> packets = receivers_on_the_ceiling();
        const ReceiverPathSettings limited = test::with_limit(kTwoGlossyRays, 0.3f);
        EXPECT_GT(brought(device, scene, packets, true, limited, 64).variance(),
                  1.1 * brought(device, scene, packets, true, kTwoGlossyRays, 64).variance())
            << "the limit changes nothing";
        expect_what_own_rays_bring(device, scene, GatherKernel::automatic, limited);
    });
}

/// Which of two lamps a place on the floor asks must not follow the lobe towards one of the receivers, since
/// all of them take its light with one density.
TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringOfTwoLamps) {
    on_each_device([](Device& device) {
        Scene scene;
        add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, metal(0.2f)));
        for (const auto& [x, radiance] : {std::pair{0.8f, 10.0f}, {-1.9f, 60.0f}}) {
            Material lamp = lambertian({0, 0, 0});
            lamp.emission = parameter_of(radiance);
            add_quad(scene, {x, 0.9f * kRoomHeight, 0}, {0.6f, 0, 0}, {0, 0, 0.6f},
                     add_material(scene, lamp));
        }
        expect_what_own_rays_bring(device, scene);
    });
}

/// No ray meets a point, so only light samples count in the density of what it sends.
TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringOfPoints) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_lamp(metal(0.3f));
        for (Material& material : scene.materials) {
            material.emission = parameter_of(0.0f);
        }
        add_point_light(scene, {-0.8f, 0.6f, 0.3f}, {1, 2, 3});
        expect_what_own_rays_bring(device, scene);
    });
}

/// Coats lie on a Lambertian base, which is shared within the clamp radius.
TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringOfCoats) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_lamp(metal(0.2f));
        scene.materials[0] = coated(scene, {0.3f, 0.3f, 0.3f}, {.eta = 1.9, .alpha = 0.25});
        expect_what_own_rays_bring(device, scene);
    });
}

TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringOfPrincipledSurfaces) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_lamp(metal(0.2f));
        scene.materials[0] = principled_material(scene, 1.5);
        scene.materials[0].metallic = parameter_of(0.5f);
        scene.materials[0].clearcoat = parameter_of(1.0f);
        scene.materials[0].sheen = parameter_of(0.5f);
        expect_what_own_rays_bring(device, scene);
    });
}

/// Chance decides which part of a blend a ray meets; all receivers must see the same part.
TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringOfBlends) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_lamp(metal(0.2f));
        const uint rough = add_material(scene, metal(0.4f));
        Material red = metal(0.15f);
        red.specular = parameter_of(Vec3{1, 0.1f, 0.1f});
        const uint second = add_material(scene, red);
        scene.materials[0] = blend_material(parameter_of(0.4f), rough, second);
        expect_what_own_rays_bring(device, scene);
    });
}

/// Behind a pane, a ray and light samples share the lamp as without it.
TEST_F(SharedReflectionsTest, BringWhatOwnRaysBringBehindPanes) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_lamp(metal(0.3f));
        const uint pane = add_material(scene, thin_dielectric_material(1.5));
        add_quad(scene, {-1.1f, 0.05f, -2}, {0, 0.6f, 0}, {0, 0, 4}, pane);
        expect_what_own_rays_bring(device, scene);
    });
}

TEST_F(SharedReflectionsTest, AreLessNoiseThanOwnRays) {
    on_each_device([](Device& device) {
        const Scene scene = floor_under_lamp(metal(0.2f));
        const std::vector<ReceiverPacket> packets = receivers_on_the_ceiling();
        ReceiverPathSettings own = kTwoGlossyRays;
        own.shares_reflections = false;
        EXPECT_LT(brought(device, scene, packets, true, kTwoGlossyRays, 128).variance(),
                  0.1 * brought(device, scene, packets, true, own, 128).variance());
    });
}

FoundLights find_reflections(Device& device, const Scene& scene, const std::vector<ReceiverPacket>& packets) {
    const Bvh bvh = build_scene_bvh(scene);
    const DeviceScene on_device = upload_scene(device, scene, bvh, GatherKernel::automatic);
    const Buffer<ReceiverPacket> receivers(device, packets);
    Buffer<IrradiancePacket> direct(device, packets.size());
    Buffer<IrradiancePacket> indirect(device, packets.size());
    FoundLights found(device, packets.size(), kTwoGlossyRays);
    ReceiverPaths(device).run_sharing({on_device, receivers, packets.size(), kTwoGlossyRays}, direct,
                                      indirect, found);
    return found;
}

std::vector<SharedLight> found_reflections(Device& device, const Material& floor) {
    return find_reflections(device, floor_under_lamp(floor), receivers_on_the_ceiling()).reflected.download();
}

std::ptrdiff_t number_of_finds(const std::vector<SharedLight>& lights) {
    return std::ranges::count_if(lights, [](const SharedLight& light) { return light.weight > 0; });
}

/// Others have no use for what they would reflect.
TEST_F(SharedReflectionsTest, NarrowLobesAreLeftToTheirReceivers) {
    on_each_device([](Device& device) {
        EXPECT_GT(number_of_finds(found_reflections(device, metal(0.2f))), 40);
        EXPECT_EQ(number_of_finds(found_reflections(device, metal(0.01f))), 0);
    });
}

/// Those that are far from all others keep what they find.
TEST_F(SharedReflectionsTest, LonelyReceiversKeepTheirLight) {
    on_each_device([](Device& device) {
        const std::vector<SharedLight> lights = found_reflections(device, metal(0.2f));
        EXPECT_EQ(number_of_finds({lights.end() - 3, lights.end()}), 0);
    });
}

/// The radius of a neighbourhood holds a quarter of the receivers, and half its square does not.
TEST_F(SharedReflectionsTest, ANeighbourhoodHoldsAQuarter) {
    on_each_device([](Device& device) {
        const std::vector<ReceiverPacket> packets = receivers_on_the_ceiling();
        const FoundLights found = find_reflections(device, floor_under_lamp(metal(0.2f)), packets);
        std::vector<Vec3> present;
        for (std::size_t i = 0; i < kGlossyReceivers; ++i) {
            if (const ReceiverPoint x = receiver_at(packets, i); x.normal != Vec3{0, 0, 0}) {
                present.push_back(x.position);
            }
        }
        const auto within = [&](Vec3 x, float radius) {
            return 4 * std::ranges::count_if(present, [&](Vec3 y) { return length(y - x) < radius; });
        };
        const std::vector<float> spacing = found.spacing.download();
        for (std::size_t i = 0; i < kGlossyReceivers; ++i) {
            const ReceiverPoint x = receiver_at(packets, i);
            if (x.normal == Vec3{0, 0, 0}) {
                continue;
            }
            const auto count = static_cast<std::ptrdiff_t>(present.size());
            EXPECT_GE(within(x.position, 1.0001f * spacing[i]), count) << i;
            EXPECT_LT(within(x.position, 0.9999f * std::sqrt(0.5f) * spacing[i]), count) << i;
        }
    });
}

/// CPUs find the spacing of a bundle with one work-item, and GPUs with many.
TEST_F(SharedReflectionsTest, NeighbourhoodsDoNotDependOnTheDivisionOfWork) {
    on_each_device([](Device& device) {
        const std::vector<ReceiverPacket> packets = receivers_on_the_ceiling();
        const Buffer<ReceiverPacket> receivers(device, packets);
        Kernel kernel(Program(device, "receiver_paths.cl", kViewProgram), "receiver_spacing");
        const auto spacing = [&](uint part) {
            Buffer<float> found(device, packets.size() * NEARLIGHT_PACKET_SIZE);
            kernel.launch_items(divide_rounding_up(found.count(), std::size_t{part}), receivers,
                                static_cast<uint>(packets.size()), kTwoGlossyRays.max_edges, part, found);
            return found.download();
        };
        EXPECT_EQ(spacing(8), spacing(256));
    });
}

TEST_F(SharedReflectionsTest, DoNotDependOnTheDivisionOfABundle) {
    on_each_device([](Device& device) {
        test::expect_same_by_any_division(device, floor_beside_wall(), receivers_on_the_ceiling(),
                                          kTwoGlossyRays);
    });
}

}  // namespace
}  // namespace nearlight::core
