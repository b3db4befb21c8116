// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/lights_and_cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/named_choice.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

/// Lumens per watt of green light, which exporters take for the ratio of photometric and radiometric units.
constexpr double kLumensPerWatt = 683;
constexpr int kUsualHeight = 480;
/// Exporters round π/2 up to single precision.
constexpr double kWidestCone = std::numbers::pi / 2 + 1e-6;

/// The light's intensity in W/sr, or its irradiance in W/m² if it is directional.
Vec3 strength_of(const tinygltf::Light& light) {
    const auto channel = [&](std::size_t i) {
        const double c = light.color.size() == 3 ? light.color[i] : 1.0;
        return static_cast<float>(std::max(c, 0.0) * std::max(light.intensity, 0.0) / kLumensPerWatt);
    };
    return {channel(0), channel(1), channel(2)};
}

/// Where the light shines. A node that its scale makes a point has its rotation still.
Vec3 forward(const PlacedLight& placed) {
    const Vec3 scaled = transform_vector(placed.to_world, {0, 0, -1});
    return normalize(is_zero(scaled) ? transform_vector(placed.turn, {0, 0, -1}) : scaled);
}

Emitter point_emitter(const PlacedLight& placed) {
    Emitter emitter{};
    emitter.type = NEARLIGHT_EMITTER_POINT;
    emitter.position = transform_point(placed.to_world, {0, 0, 0});
    emitter.radiance = strength_of(*placed.light);
    return emitter;
}

Emitter spot_emitter(const PlacedLight& placed) {
    Emitter emitter = point_emitter(placed);
    emitter.type = NEARLIGHT_EMITTER_SPOT;
    emitter.direction = forward(placed);
    emitter.cutoff_angle =
        static_cast<float>(std::clamp(placed.light->spot.outerConeAngle, 1e-3, std::numbers::pi / 2));
    emitter.beam_angle =
        std::clamp(static_cast<float>(placed.light->spot.innerConeAngle), 0.0f, emitter.cutoff_angle);
    return emitter;
}

Emitter directional_emitter(const PlacedLight& placed) {
    Emitter emitter{};
    emitter.type = NEARLIGHT_EMITTER_DIRECTIONAL;
    emitter.direction = forward(placed);
    emitter.radiance = strength_of(*placed.light);
    return emitter;
}

/// Notes numbers that a light may not have, and what becomes of them.
void note_odd_numbers(const GltfFile& file, const tinygltf::Light& light, NoteSink& notes) {
    const std::string name = "light '" + light.name + "' has ";
    if (light.intensity < 0 || std::ranges::any_of(light.color, [](double c) { return c < 0; })) {
        notes.approximation(file.path, 0, name + "an intensity or colour below 0, which counts as 0");
    }
    if (light.type != "spot") {
        return;
    }
    if (!(light.spot.outerConeAngle > 0 && light.spot.outerConeAngle <= kWidestCone)) {
        notes.approximation(file.path, 0,
                            name + "an outerConeAngle that is not between 0 and π/2, and is limited");
    }
    if (!(light.spot.innerConeAngle >= 0 && light.spot.innerConeAngle < light.spot.outerConeAngle)) {
        notes.approximation(
            file.path, 0,
            name + "an innerConeAngle that is not between 0 and its outerConeAngle, and is limited");
    }
}

/// The transform of a SceneCamera, which looks along +Z with +X to the left, and has no scale.
Mat4 camera_to_world(const GltfFile& file, const PlacedCamera& placed) {
    if (!(std::abs(linear_determinant(placed.to_world)) > 1e-6)) {
        file.fail("the transform of camera '" + placed.node +
                  "' is singular: it maps space onto a plane, a line or a point");
    }
    return placed.to_world * scaling(-1, 1, -1);
}

void set_size(SceneCamera& camera, double aspect) {
    camera.height = kUsualHeight;
    camera.width = static_cast<int>(std::lround(std::clamp(kUsualHeight * aspect, 1.0, 16384.0)));
}

SceneCamera orthographic(const GltfFile& file, const PlacedCamera& placed) {
    const tinygltf::OrthographicCamera& source = placed.camera->orthographic;
    if (!(source.xmag > 0) || !(source.ymag > 0)) {
        file.fail("camera '" + placed.node + "' has no size above 0");
    }
    SceneCamera camera;
    set_size(camera, source.xmag / source.ymag);
    camera.kind = CameraKind::orthographic;
    camera.to_world = camera_to_world(file, placed) * scaling(source.xmag, source.xmag, 1);
    return camera;
}

SceneCamera perspective(const GltfFile& file, const PlacedCamera& placed) {
    const tinygltf::PerspectiveCamera& source = placed.camera->perspective;
    if (!(source.yfov > 0) || !(source.yfov < std::numbers::pi)) {
        file.fail("camera '" + placed.node + "' has no field of view between 0 and 180 degrees");
    }
    SceneCamera camera;
    set_size(camera, source.aspectRatio > 0 ? source.aspectRatio : 4.0 / 3.0);
    camera.fov_x_degrees =
        360.0 / std::numbers::pi *
        std::atan(std::tan(source.yfov / 2) * camera.width / static_cast<double>(camera.height));
    camera.to_world = camera_to_world(file, placed);
    return camera;
}

}  // namespace

void find_light(const GltfFile& file, const PlacedNode& placed, std::vector<PlacedLight>& lights) {
    const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.index)];
    if (node.extensions.contains("KHR_lights_punctual")) {
        const int index = index_of(node.extensions, "KHR_lights_punctual", "light", -1);
        lights.push_back({&file.at(file.model.lights, index, "light", "node '" + node.name + "'"),
                          placed.to_world, placed.turn});
    }
}

void find_camera(const GltfFile& file, const PlacedNode& placed, std::vector<PlacedCamera>& cameras) {
    const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.index)];
    if (node.camera >= 0) {
        Mat4 to_world = placed.turn;
        for (int row = 0; row < 3; ++row) {
            to_world(row, 3) = placed.to_world(row, 3);
        }
        cameras.push_back({&file.at(file.model.cameras, node.camera, "camera", "node '" + node.name + "'"),
                           node.name, to_world});
    }
}

void add_lights(const GltfFile& file, const std::vector<PlacedLight>& lights, Scene& scene, NoteSink& notes) {
    for (const PlacedLight& placed : lights) {
        if (!is_finite(strength_of(*placed.light))) {
            file.fail("the intensity of light '" + placed.light->name + "' is not finite");
        }
        note_odd_numbers(file, *placed.light, notes);
        if (placed.light->type == "point") {
            scene.delta_emitters.push_back(point_emitter(placed));
        } else if (placed.light->type == "spot") {
            scene.delta_emitters.push_back(spot_emitter(placed));
        } else if (placed.light->type == "directional") {
            scene.delta_emitters.push_back(directional_emitter(placed));
        } else {
            notes.approximation(file.path, 0, "a light of type '" + placed.light->type + "' is left out");
        }
    }
}

SceneCamera choose_camera(const GltfFile& file, const std::vector<PlacedCamera>& cameras,
                          const std::string& wanted) {
    std::vector<std::vector<std::string>> names;
    for (const PlacedCamera& placed : cameras) {
        names.push_back({placed.node, placed.camera->name});
    }
    const PlacedCamera& placed = cameras[choose_named(file.path, "camera", names, wanted)];
    SceneCamera camera =
        placed.camera->type == "orthographic" ? orthographic(file, placed) : perspective(file, placed);
    camera.filter = default_filter(kUsualFilter);
    return camera;
}

}  // namespace nearlight::core::gltf
