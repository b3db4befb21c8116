// SPDX-License-Identifier: Apache-2.0
#include "host/cli/scene_summary.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/base/printable.h"
#include "host/base/words.h"
#include "host/cli/memory_estimate.h"
#include "host/scene/camera.h"
#include "host/scene/emitters.h"

namespace nearlight::core {
namespace {

using Json = nlohmann::ordered_json;

struct LightCounts {
    std::size_t points = 0;
    std::size_t spots = 0;
    std::size_t projectors = 0;
    std::size_t directional = 0;
    std::size_t triangles = 0;
    std::size_t spheres = 0;
    std::size_t cylinders = 0;
    float power = 0.0f;  ///< luminance of all flux, W
};

LightCounts count_lights(const Scene& scene) {
    const EmitterTable table = build_emitter_table(scene);
    const auto count = [&](uint type) {
        return static_cast<std::size_t>(std::count_if(table.emitters.begin(), table.emitters.end(),
                                                      [&](const Emitter& e) { return e.type == type; }));
    };
    return {count(NEARLIGHT_EMITTER_POINT),     count(NEARLIGHT_EMITTER_SPOT),
            count(NEARLIGHT_EMITTER_PROJECTOR), count(NEARLIGHT_EMITTER_DIRECTIONAL),
            count(NEARLIGHT_EMITTER_TRIANGLE),  count(NEARLIGHT_EMITTER_SPHERE),
            count(NEARLIGHT_EMITTER_CYLINDER),  table.total_power};
}

std::uint64_t texel_count(const Scene& scene) {
    return std::accumulate(scene.images.begin(), scene.images.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const TextureImage& image) {
                               return sum + static_cast<std::uint64_t>(image.width) *
                                                static_cast<std::uint64_t>(image.height);
                           });
}

/// The name of the model that one sees: what a mask, a map or a two-sided material stands for.
const char* kind_of(const Scene& scene, const Material& material) {
    switch (material.model) {
        case NEARLIGHT_BSDF_PLASTIC:
            return "coated";
        case NEARLIGHT_BSDF_PHONG:
        case NEARLIGHT_BSDF_WARD:
            return "glossy";
        case NEARLIGHT_BSDF_CONDUCTOR:
            return "metal";
        case NEARLIGHT_BSDF_DIELECTRIC:
            return "glass";
        case NEARLIGHT_BSDF_THIN_DIELECTRIC:
            return "thin glass";
        case NEARLIGHT_BSDF_PRINCIPLED:
            return "principled";
        case NEARLIGHT_BSDF_NULL:
            return "invisible";
        case NEARLIGHT_BSDF_BLEND:
            return "blend";
        case NEARLIGHT_BSDF_MASK:
        case NEARLIGHT_BSDF_TWO_SIDED:
        case NEARLIGHT_BSDF_NORMAL_MAP:
        case NEARLIGHT_BSDF_BUMP_MAP:
            return kind_of(scene, scene.materials[material.child[0]]);
        default:
            return "diffuse";
    }
}

Json json_vector(Vec3 v) {
    return Json::array({v.x, v.y, v.z});
}

std::string text_vector(Vec3 v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

Vec3 camera_position(const Scene& scene) {
    return transform_point(scene.camera.to_world, {0, 0, 0});
}

Vec3 camera_direction(const Scene& scene) {
    return normalize(transform_vector(scene.camera.to_world, {0, 0, 1}));
}

std::uint64_t total(const MemoryEstimate::Parts& parts) {
    return std::accumulate(parts.begin(), parts.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const auto& part) { return sum + part.second; });
}

std::string text_bytes(std::uint64_t bytes) {
    return bytes < 10'000'000 ? fmt::format("{:.1f} kB", static_cast<double>(bytes) / 1e3)
                              : fmt::format("{:.0f} MB", static_cast<double>(bytes) / 1e6);
}

std::string text_parts(const MemoryEstimate::Parts& parts) {
    const auto text_of = [](const auto& part) {
        return fmt::format("{} {}", part.first, text_bytes(part.second));
    };
    return text_bytes(total(parts)) + " (" + joined(parts, ", ", text_of) + ")";
}

Json json_parts(const MemoryEstimate::Parts& parts) {
    Json json = Json::object();
    for (const auto& [name, bytes] : parts) {
        json[name] = bytes;
    }
    json["total"] = total(parts);
    return json;
}

std::string text_environment(const EnvironmentLight& environment) {
    if (environment.width == 0) {
        return "no environment";
    }
    return environment.width * environment.height == 1
               ? "constant environment"
               : fmt::format("environment of {}x{} pixels", environment.width, environment.height);
}

std::string text_samples(int samples_per_pixel) {
    return samples_per_pixel > 0 ? std::to_string(samples_per_pixel) : "not given";
}

Json json_lights(const Scene& scene) {
    const LightCounts lights = count_lights(scene);
    const EnvironmentLight& environment = scene.environment;
    return {{"points", lights.points},
            {"spots", lights.spots},
            {"projectors", lights.projectors},
            {"directional", lights.directional},
            {"triangles", lights.triangles},
            {"spheres", lights.spheres},
            {"cylinders", lights.cylinders},
            {"environment",
             environment.width > 0 ? Json::array({environment.width, environment.height}) : Json()},
            {"power", lights.power}};
}

const char* kind_of(const SceneCamera& camera) {
    return camera.kind == CameraKind::orthographic ? "orthographic"
           : camera.aperture_radius > 0.0          ? "thin lens"
                                                   : "perspective";
}

Json json_filter(const PixelFilter& filter) {
    return {{"name", to_string(filter.kind)}, {"radius", filter.radius}, {"b", filter.b}, {"c", filter.c}};
}

/// A distance, or null where it is infinite, which JSON does not know.
Json json_distance(double distance) {
    return std::isfinite(distance) ? Json(distance) : Json();
}

Json json_camera(const Scene& scene) {
    const SceneCamera& camera = scene.camera;
    return {{"kind", kind_of(camera)},
            {"width", camera.width},
            {"height", camera.height},
            {"fov_x_degrees", camera.fov_x_degrees},
            {"position", json_vector(camera_position(scene))},
            {"direction", json_vector(camera_direction(scene))},
            {"film_part", camera.film_part},
            {"center", Json::array({camera.center_x, camera.center_y})},
            {"aperture_radius", camera.aperture_radius},
            {"focus_distance", camera.focus_distance},
            {"near_clip", camera.near_clip},
            {"far_clip", json_distance(camera.far_clip)},
            {"filter", json_filter(camera.filter)},
            {"hide_emitters", camera.hide_emitters},
            {"monochrome", camera.is_monochrome}};
}

/// The properties of the camera besides its size and place.
std::string text_film(const SceneCamera& camera) {
    std::string text =
        fmt::format("{} filter of radius {:g}", to_string(camera.filter.kind), camera.filter.radius);
    if (camera.film_part != 1.0 || camera.center_x != 0.0 || camera.center_y != 0.0) {
        text += fmt::format(", {:.4g} of the film's width around ({:.4g}, {:.4g})", camera.film_part,
                            camera.center_x, camera.center_y);
    }
    text += camera.hide_emitters ? ", emitters hidden" : "";
    return text + (camera.is_monochrome ? ", luminance only" : "");
}

/// What the camera takes in: its angle or its width, and its lens.
std::string text_lens(const SceneCamera& camera) {
    if (camera.kind == CameraKind::orthographic) {
        return fmt::format("{:.6g} wide",
                           picture_window(camera, camera.width, camera.height).pixel * camera.width *
                               static_cast<double>(length(transform_vector(camera.to_world, {1, 0, 0}))));
    }
    const std::string angle = fmt::format("{:.6g} degrees wide", camera.fov_x_degrees);
    return camera.aperture_radius > 0.0 ? fmt::format("{}, lens of radius {:g} in focus at {:g}", angle,
                                                      camera.aperture_radius, camera.focus_distance)
                                        : angle;
}

/// From where to where the camera sees; empty if it sees everything.
std::string text_clip(const SceneCamera& camera) {
    if (std::isfinite(camera.far_clip)) {
        return fmt::format(", clips from {:g} to {:g} m", camera.near_clip, camera.far_clip);
    }
    return camera.near_clip > 0.0 ? fmt::format(", clips from {:g} m", camera.near_clip) : "";
}

Json json_notes(const Scene& scene) {
    Json notes = Json::array();
    for (const Note& note : scene.notes) {
        notes.push_back({{"file", note.file.string()}, {"line", note.line}, {"text", note.text}});
    }
    return notes;
}

Json json_animations(const Scene& scene) {
    Json animations = Json::array();
    for (const SceneAnimation& animation : scene.animations) {
        Json motions = Json::array();
        for (const auto& [node, property] : animation.motions) {
            motions.push_back({{"node", node}, {"property", property}});
        }
        const auto& span = animation.span;
        animations.push_back({{"name", animation.name},
                              {"begin_seconds", span ? Json(span->begin) : Json()},
                              {"end_seconds", span ? Json(span->end) : Json()},
                              {"moves", std::move(motions)},
                              {"fault", animation.fault.empty() ? Json() : Json(animation.fault)}});
    }
    return animations;
}

/// The first nodes that an animation moves, each with how it moves, and how many more there are.
std::string text_motions(const SceneAnimation& animation) {
    constexpr std::size_t kMaxNamed = 4;
    std::vector<std::pair<std::string, std::string>> nodes;
    for (const auto& [node, property] : animation.motions) {  // those of a node follow one another
        if (nodes.empty() || nodes.back().first != node) {
            nodes.emplace_back(node, property);
        } else {
            nodes.back().second += ", " + property;
        }
    }
    const std::size_t more = nodes.size() > kMaxNamed ? nodes.size() - kMaxNamed : 0;
    nodes.resize(nodes.size() - more);
    const std::string text = joined(nodes, ", ", [](const auto& node) {
        return fmt::format("{} ({})", printable_line(node.first), node.second);
    });
    return text + (more > 0 ? fmt::format(" and {} more nodes", more) : "");
}

std::string text_animation(const SceneAnimation& animation) {
    if (!animation.fault.empty()) {
        return "cannot be played: " + printable_line(animation.fault);
    }
    return animation.span ? fmt::format("{:.4g} to {:.4g} s, moves {}", animation.span->begin,
                                        animation.span->end, text_motions(animation))
                          : "moves nothing";
}

/// One row for each animation of the file.
std::string text_animations(const Scene& scene) {
    std::string text;
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const std::string name = printable_line(scene.animations[i].name);
        text += fmt::format("{:<12}{}{}: {}\n", i == 0 ? "animations" : "", i + 1,
                            name.empty() ? "" : " '" + name + "'", text_animation(scene.animations[i]));
    }
    return text;
}

}  // namespace

std::vector<std::pair<std::string, std::size_t>> count_materials(const Scene& scene) {
    std::vector<bool> is_used(scene.materials.size());  // others are parts of these, or no triangle has them
    for (const Triangle& triangle : scene.triangles) {
        is_used[triangle.material] = true;
    }
    std::vector<std::pair<std::string, std::size_t>> counts;
    for (const char* kind : {"diffuse", "coated", "glossy", "metal", "glass", "thin glass", "principled",
                             "blend", "invisible"}) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < is_used.size(); ++i) {
            count += is_used[i] && std::string_view(kind_of(scene, scene.materials[i])) == kind ? 1 : 0;
        }
        if (count > 0) {
            counts.emplace_back(kind, count);
        }
    }
    return counts;
}

nlohmann::ordered_json scene_summary_json(const Scene& scene) {
    Json materials = Json::object();
    for (const auto& [kind, count] : count_materials(scene)) {
        materials[kind] = count;
    }
    const Aabb box = bounds(scene);
    const MemoryEstimate memory = estimate_memory(scene);
    return {
        {"scene", scene.name},
        {"source", scene.source.string()},
        {"triangles", scene.triangles.size()},
        {"vertices", scene.vertices.size()},
        {"materials", materials},
        {"textures",
         {{"count", scene.textures.size()}, {"images", scene.images.size()}, {"texels", texel_count(scene)}}},
        {"lights", json_lights(scene)},
        {"camera", json_camera(scene)},
        {"bounds",
         box.is_empty() ? Json() : Json{{"min", json_vector(box.min)}, {"max", json_vector(box.max)}}},
        {"max_depth", scene.max_depth},
        {"samples_per_pixel", scene.samples_per_pixel > 0 ? Json(scene.samples_per_pixel) : Json()},
        {"animations", json_animations(scene)},
        {"notes", json_notes(scene)},
        {"memory_bytes", {{"host", json_parts(memory.host)}, {"device", json_parts(memory.device)}}}};
}

std::string scene_summary_text(const Scene& scene) {
    const std::string materials = joined(count_materials(scene), ", ", [](const auto& kind) {
        return fmt::format("{} {}", kind.second, kind.first);
    });
    const LightCounts lights = count_lights(scene);
    const Aabb box = bounds(scene);
    const MemoryEstimate memory = estimate_memory(scene);
    const auto row = [](const char* name, const std::string& value) {
        return fmt::format("{:<12}{}\n", name, value);
    };
    return row("scene", fmt::format("{} ({})", scene.name, scene.source.string())) +
           row("geometry",
               fmt::format("{} triangles, {} vertices", scene.triangles.size(), scene.vertices.size())) +
           row("bounds", box.is_empty() ? "empty" : text_vector(box.min) + " to " + text_vector(box.max)) +
           row("materials", materials.empty() ? "none" : materials) +
           row("textures", fmt::format("{} of {} images, {} texels", scene.textures.size(),
                                       scene.images.size(), texel_count(scene))) +
           row("lights", fmt::format("{} points, {} spots, {} projectors, {} directional, {} triangles, {} "
                                     "spheres, {} cylinders, {}; {:.6g} W",
                                     lights.points, lights.spots, lights.projectors, lights.directional,
                                     lights.triangles, lights.spheres, lights.cylinders,
                                     text_environment(scene.environment), lights.power)) +
           row("camera",
               fmt::format("{}, {}x{}, {}, at {} towards {}{}", kind_of(scene.camera), scene.camera.width,
                           scene.camera.height, text_lens(scene.camera), text_vector(camera_position(scene)),
                           text_vector(camera_direction(scene)), text_clip(scene.camera))) +
           row("film", text_film(scene.camera)) + row("max depth", std::to_string(scene.max_depth)) +
           row("samples", text_samples(scene.samples_per_pixel)) + text_animations(scene) +
           row("host", text_parts(memory.host)) + row("device", text_parts(memory.device)) +
           row("notes", scene.notes.empty() ? "none" : std::to_string(scene.notes.size()));
}

}  // namespace nearlight::core
