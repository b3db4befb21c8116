// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "host/base/receivers.h"
#include "host/reference/edge_excuse.h"
#include "host/reference/embree_scene.h"
#include "host/reference/gather_workload.h"
#include "host/reference/shared_light_oracle.h"
#include "host/reference/test_rooms.h"
#include "host/scene/material_model.h"
#include "host/stages/shared_lights.h"
#include "host/stages/shared_reflections.h"
#include "host/stages/shared_sky.h"
#include "host/stages/shared_veiled.h"

namespace nearlight::core {
namespace {

/// T of the curve 1, which is straight, so that it is the same between the entries of its table.
double transmission(double cosine) {
    return 0.25 + 0.5 * cosine;
}

Scene room_with_a_curve() {
    Scene scene = make_delta_lit_room();
    scene.transmission_curves.assign(2 * std::size_t{NEARLIGHT_CURVE_SIZE}, 1.0f);
    for (std::size_t i = 0; i < NEARLIGHT_CURVE_SIZE; ++i) {
        const double cosine = static_cast<double>(i) / (NEARLIGHT_CURVE_SIZE - 1);
        scene.transmission_curves[NEARLIGHT_CURVE_SIZE + i] = static_cast<float>(transmission(cosine));
    }
    return scene;
}

/// The room without its ceiling, under a sky of even radiance.
Scene room_under_sky(Vec3 radiance) {
    Scene scene = room_with_a_curve();
    scene.delta_emitters.clear();
    const float top = bounds(scene).max.y;
    std::erase_if(scene.triangles, [&](const Triangle& triangle) {
        const auto is_at_top = [&](uint vertex) { return scene.vertices[vertex].position.y >= 0.999f * top; };
        return is_at_top(triangle.v0) && is_at_top(triangle.v1) && is_at_top(triangle.v2);
    });
    scene.environment = {.width = 1, .height = 1, .radiance = {radiance}, .to_world = {}};
    return scene;
}

/// The room with metal of several roughnesses everywhere.
Scene room_of_metal() {
    Scene scene = room_with_a_curve();
    float alpha = 0.15f;
    for (Material& material : scene.materials) {
        material = conductor_material({0.2f, 0.9f, 1.1f}, {3.9f, 2.4f, 2.2f});
        material.roughness = parameter_of(Vec3{alpha, alpha, 0});
        alpha += 0.1f;
    }
    return scene;
}

/// Two masks of an even opacity that divide the room into three storeys.
struct Storeys {
    static constexpr double kOpacity = 0.4;

    explicit Storeys(const Scene& room) : box(bounds(room)) {
        for (const float part : {0.35f, 0.65f}) {
            heights.push_back(box.min.y + part * (box.max.y - box.min.y));
        }
    }
    [[nodiscard]] VeilsBetween between(Vec3 from, Vec3 to) const {
        VeilsBetween veils{0, 1.0};
        for (const float height : heights) {
            if ((from.y < height) != (to.y < height)) {
                ++veils.count;
                veils.part *= 1.0 - kOpacity;
            }
        }
        return veils;
    }
    /// Whether single precision is sure on which storey a place is.
    [[nodiscard]] bool is_sure(Vec3 place) const {
        return std::ranges::all_of(heights, [&](float height) {
            return std::abs(place.y - height) > kSegmentEdgeTolerance * max_component(box.size());
        });
    }
    /// The room with the masks, which reach beyond its walls.
    [[nodiscard]] Scene divided(Scene room) const {
        const auto child = static_cast<uint>(room.materials.size());
        room.materials.push_back(diffuse_material({0, 0, 0}));
        room.materials.push_back(mask_material(parameter_of(static_cast<float>(kOpacity)), child));
        const Vec3 size = box.size() * 1.2f;
        for (const float height : heights) {
            const Vec3 corner{box.min.x - 0.1f * size.x, height, box.min.z - 0.1f * size.z};
            const auto first = static_cast<uint>(room.vertices.size());
            for (const Vec3 offset :
                 {Vec3{0, 0, 0}, Vec3{0, 0, size.z}, Vec3{size.x, 0, size.z}, Vec3{size.x, 0, 0}}) {
                room.vertices.push_back({corner + offset, 0.0f, {0, 1, 0}, 0.0f});
            }
            room.triangles.push_back({first, first + 1, first + 2, child + 1});
            room.triangles.push_back({first, first + 2, first + 3, child + 1});
        }
        return room;
    }

    Aabb box;
    std::vector<float> heights{};
};

/// A room, and the two questions of the oracle.
struct Room {
    explicit Room(Scene a_scene) : scene(std::move(a_scene)), bvh(build_scene_bvh(scene)), embree(scene) {}

    [[nodiscard]] std::function<bool(Vec3, Vec3)> is_clear() const {
        return [this](Vec3 from, Vec3 to) {
            return distance_to_edges(bvh.triangles, from, to) > kSegmentEdgeTolerance * extent;
        };
    }
    [[nodiscard]] std::function<bool(Vec3, Vec3)> is_visible() const {
        return [this](Vec3 from, Vec3 to) { return !embree.blocked(from, to); };
    }

    Scene scene;
    Bvh bvh;
    EmbreeScene embree;
    float extent = max_component(bounds(scene).size());
};

void expect_irradiance(const Buffer<IrradiancePacket>& irradiance, const std::vector<Vec3>& wanted,
                       CheckResult& result) {
    const std::vector<IrradiancePacket> found = irradiance.download();
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const Vec3 difference = irradiance_at(found, i) - wanted[i];
        result.expect(length(difference) <= 1e-3f * length(wanted[i]) + 1e-6f);
    }
}

/// Receivers in a room, and the light that is to be brought to them.
struct Setup {
    const Room& room;
    const std::vector<ReceiverPacket>& receivers;
    const ReceiverPathSettings& settings;
    const std::vector<Vec3>& wanted;
};

/// Compares what add(batch, lists, irradiance) brings, with the visibility of either gather kernel.
template <typename Add>
void check_gathers(Device& device, const Setup& setup, CheckResult& result, const Add& add) {
    const std::size_t packets = setup.receivers.size();
    const Buffer<ReceiverPacket> receivers(device, setup.receivers);
    for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
        const DeviceScene scene = upload_scene(device, setup.room.scene, setup.room.bvh, kernel);
        Buffer<IrradiancePacket> irradiance(device, packets);
        irradiance.fill_zero();
        SharedLightLists lists(device, kernel);
        add(ReceiverBatch{scene, receivers, packets, setup.settings}, lists, irradiance);
        expect_irradiance(irradiance, setup.wanted, result);
    }
}

}  // namespace

void check_shared_lights(Device& device, CheckResult& result) {
    const Room room(room_with_a_curve());
    const SharedLightCase data = make_shared_lights(make_camera_receivers(room.scene, room.bvh, 48, 48),
                                                    0.3f * room.extent, room.is_clear());
    const std::vector<Vec3> wanted = shared_irradiance(data, room.is_visible(), transmission);
    const ReceiverPathSettings settings{.rays = data.rays_per_receiver,
                                        .max_edges = data.max_edges,
                                        .clamp_radius = data.clamp_radius,
                                        .seed = 1};
    const Buffer<SharedLight> lights(device, data.found);
    const Setup setup{room, data.receivers, settings, wanted};
    check_gathers(device, setup, result, [&](const ReceiverBatch& batch, auto& lists, auto& irradiance) {
        SharedLights(device).add(batch, lists, lights, irradiance);
    });
}

void check_shared_sky(Device& device, CheckResult& result) {
    const Vec3 radiance{1, 2, 3};
    const Room room(room_under_sky(radiance));
    const SharedLightCase data = make_shared_sky(make_camera_receivers(room.scene, room.bvh, 48, 48),
                                                 (bounds(room.scene).min + bounds(room.scene).max) * 0.5f,
                                                 2 * room.extent, room.is_clear());
    const ReceiverPathSettings settings{.light_samples = 5,
                                        .rays = data.rays_per_receiver,
                                        .max_edges = data.max_edges,
                                        .clamp_radius = 1.0f,
                                        .seed = 1};
    const std::vector<Vec3> wanted =
        shared_sky_irradiance(data, radiance, settings.light_samples, room.is_visible(), transmission);
    const Buffer<SharedLight> lights(device, data.found);
    const Buffer<SeenSurface> none_seen(device, 0);
    Buffer<CameraVertex> no_vertices(device, 0);
    const Setup setup{room, data.receivers, settings, wanted};
    check_gathers(device, setup, result, [&](const ReceiverBatch& batch, auto& lists, auto& irradiance) {
        SharedSky(device).add(batch, lists, lights, {.surfaces = none_seen, .vertices = no_vertices},
                              irradiance);
    });
}

void check_shared_veiled(Device& device, CheckResult& result) {
    const Room solids(room_with_a_curve());
    const Storeys storeys(solids.scene);
    const Room room(storeys.divided(solids.scene));
    const VeilsOracle veils = [&](Vec3 from, Vec3 to) { return storeys.between(from, to); };
    const SharedLightCase data =
        make_veiled_lights(make_camera_receivers(solids.scene, solids.bvh, 48, 48), veils,
                           [&, is_clear = room.is_clear()](Vec3 from, Vec3 to) {
                               return storeys.is_sure(from) && storeys.is_sure(to) && is_clear(from, to);
                           });
    const std::vector<Vec3> wanted = veiled_irradiance(data, solids.is_visible(), veils, transmission);
    const ReceiverPathSettings settings{.rays = data.rays_per_receiver,
                                        .max_edges = data.max_edges,
                                        .clamp_radius = 1.0f,
                                        .seed = 1,
                                        .shares_veiled = true};
    const Buffer<SharedLight> lights(device, data.found);
    const Setup setup{room, data.receivers, settings, wanted};
    check_gathers(device, setup, result, [&](const ReceiverBatch& batch, auto& lists, auto& irradiance) {
        SharedVeiled(device).add(batch, lists, lights, irradiance);
    });
}

void check_shared_reflections(Device& device, CheckResult& result) {
    const Room room(room_of_metal());
    const SharedReflectionCase data = make_shared_reflections(
        make_camera_receivers(room.scene, room.bvh, 48, 48), room.scene, room.is_clear());
    const std::vector<Vec3> wanted = reflected_irradiance(data, room.scene, room.is_visible(), transmission);
    const ReceiverPathSettings settings{.rays = data.lights.rays_per_receiver,
                                        .max_edges = data.lights.max_edges,
                                        .clamp_radius = 1.0f,
                                        .seed = 1,
                                        .shares_reflections = true};
    FoundLights found(device, data.lights.receivers.size(), settings);
    found.reflected.upload(data.lights.found);
    found.reflections.upload(data.reflections);
    found.spacing.upload(data.spacing);
    const Setup setup{room, data.lights.receivers, settings, wanted};
    check_gathers(device, setup, result, [&](const ReceiverBatch& batch, auto& lists, auto& irradiance) {
        SharedReflections(device).add(batch, lists, found, irradiance);
    });
}

}  // namespace nearlight::core
