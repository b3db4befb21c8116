// SPDX-License-Identifier: Apache-2.0
#include "host/scene/emitters.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

#include "host/scene/distribution.h"
#include "host/scene/environment_table.h"
#include "host/scene/light_tree.h"
#include "host/scene/texture.h"

namespace nearlight::core {
namespace {

double row_sine(int row, int height) {
    return std::sin(std::numbers::pi * (row + 0.5) / height);
}

/// The integral ∫ L dω over all directions. A pixel of row j covers (2π/width)·(cos θ_j − cos θ_{j+1}) =
/// (2π/width)·2·sin(π/2height)·sinθ steradians, θ in the middle of the row; so luminance · sinθ is its exact
/// share.
Vec3 sphere_integral(const EnvironmentLight& environment) {
    double sum[3] = {0, 0, 0};
    const Vec3* pixel = environment.radiance.data();
    for (int row = 0; row < environment.height; ++row) {
        const double sine = row_sine(row, environment.height);
        for (int column = 0; column < environment.width; ++column, ++pixel) {
            sum[0] += sine * pixel->x;
            sum[1] += sine * pixel->y;
            sum[2] += sine * pixel->z;
        }
    }
    const double scale = environment.width > 0 && environment.height > 0
                             ? 4 * std::numbers::pi / environment.width *
                                   std::sin(std::numbers::pi / (2.0 * environment.height))
                             : 0.0;
    return {static_cast<float>(sum[0] * scale), static_cast<float>(sum[1] * scale),
            static_cast<float>(sum[2] * scale)};
}

/// The integral of a spot's falloff over the sphere: 2π·(1 − (sin c − sin b)/(c − b)) for full intensity up
/// to b that falls linearly to none at c; 2π·(1 − cos b) in the limit c = b.
double spot_solid_angle(double beam, double cutoff) {
    const double mean_cosine =
        cutoff - beam > 1e-6 ? (std::sin(cutoff) - std::sin(beam)) / (cutoff - beam) : std::cos(cutoff);
    return 2 * std::numbers::pi * (1 - mean_cosine);
}

/// The mean of the light's image.
Vec3 mean_image(const Scene& scene, const Emitter& emitter) {
    return mean_value(scene, {{1, 1, 1}, static_cast<int>(emitter.image) - 1});
}

/// The luminance of all flux that a light emits, W; for lights that are infinitely far away, of what enters
/// the scene's sphere.
double emitted_power(const Scene& scene, const Emitter& emitter, float scene_radius) {
    const double radiance = luminance(emitter.radiance * mean_image(scene, emitter));
    const double scene_disc = std::numbers::pi * scene_radius * scene_radius;
    switch (emitter.type) {
        case NEARLIGHT_EMITTER_POINT:
            return 4 * std::numbers::pi * radiance;
        case NEARLIGHT_EMITTER_SPOT:
            return spot_solid_angle(emitter.beam_angle, emitter.cutoff_angle) * radiance;
        case NEARLIGHT_EMITTER_TRIANGLE:
        case NEARLIGHT_EMITTER_SPHERE:
        case NEARLIGHT_EMITTER_CYLINDER:
            return std::numbers::pi * emitter.area * radiance;
        case NEARLIGHT_EMITTER_DIRECTIONAL:
            return scene_disc * radiance;
        case NEARLIGHT_EMITTER_SUN:
            return scene_disc * emitter.area * radiance;
        case NEARLIGHT_EMITTER_PROJECTOR:
            return emitter.area * radiance;
        default:
            // From each direction light passes through the sphere's disc: πR²·∫ L dω, and ∫ L dω = 4π·mean.
            return scene_disc * 4 * std::numbers::pi * radiance;
    }
}

Emitter triangle_emitter(const Scene& scene, uint triangle, Vec3 radiance) {
    Emitter emitter{};
    emitter.type = NEARLIGHT_EMITTER_TRIANGLE;
    emitter.triangle = triangle;
    emitter.triangle_count = 1;
    emitter.radiance = radiance;
    emitter.area = triangle_area(scene, scene.triangles[triangle]);
    return emitter;
}

Emitter round_emitter(const RoundLamp& lamp, Vec3 radiance) {
    Emitter emitter{};
    const bool is_sphere = is_zero(lamp.axis);
    emitter.type = is_sphere ? NEARLIGHT_EMITTER_SPHERE : NEARLIGHT_EMITTER_CYLINDER;
    emitter.position = lamp.center;
    emitter.direction = normalize(lamp.axis);
    emitter.length = length(lamp.axis);
    emitter.radius = lamp.radius;
    emitter.outer_radius = lamp.outer_radius;
    emitter.triangle = lamp.first_triangle;
    emitter.triangle_count = lamp.triangle_count;
    emitter.radiance = radiance;
    emitter.area = 2.0f * kPi * lamp.radius * (is_sphere ? 2.0f * lamp.radius : emitter.length);
    return emitter;
}

/// Adds the emissive triangles, and the spheres and cylinders in place of theirs.
void add_area_lights(const Scene& scene, std::vector<Emitter>& emitters) {
    // A texture counts by its mean, which only steers the choice of lights.
    std::vector<Vec3> mean_emission;
    for (const Material& material : scene.materials) {
        const bool emits = !is_zero(material.emission.value);
        mean_emission.push_back(emits ? mean_value(scene, material.emission) : Vec3{0, 0, 0});
    }
    auto lamp = scene.round_lamps.begin();
    for (uint i = 0; i < scene.triangles.size(); ++i) {
        const Vec3 emission = mean_emission[scene.triangles[i].material];
        if (lamp != scene.round_lamps.end() && lamp->first_triangle == i) {
            emitters.push_back(round_emitter(*lamp, emission));
            i += lamp->triangle_count - 1;
            ++lamp;
        } else if (!is_zero(emission)) {
            emitters.push_back(triangle_emitter(scene, i, emission));
        }
    }
}

bool is_directional(const Emitter& emitter) {
    return emitter.type == NEARLIGHT_EMITTER_DIRECTIONAL;
}

/// All lights, even those without power, with probabilities that are not yet filled in.
std::vector<Emitter> collect_emitters(const Scene& scene) {
    std::vector<Emitter> emitters = scene.delta_emitters;
    // The algorithms of std::ranges that return ranges do not compile with Debian 12's clang.
    std::stable_partition(emitters.begin(), emitters.end(), is_directional);
    add_area_lights(scene, emitters);
    if (scene.environment.sun_half_angle > 0.0f) {
        Emitter emitter{};
        emitter.type = NEARLIGHT_EMITTER_SUN;
        emitter.direction = -scene.environment.sun_direction;
        emitter.radiance = scene.environment.sun_radiance;
        emitter.area = static_cast<float>(2.0 * std::numbers::pi * sun_height(scene.environment));
        emitters.push_back(emitter);
    }
    if (scene.environment.width > 0) {
        Emitter emitter{};
        emitter.type = NEARLIGHT_EMITTER_ENVIRONMENT;
        emitter.radiance = sphere_integral(scene.environment) / (4.0f * kPi);
        emitters.push_back(emitter);
    }
    return emitters;
}

/// The kinds of lights that share out the choice evenly: lamps without and with a surface, directional
/// lights, the sun and the sky.
constexpr std::size_t kKindCount = 5;

std::size_t kind_of(const Emitter& emitter) {
    switch (emitter.type) {
        case NEARLIGHT_EMITTER_DIRECTIONAL:
            return 1;
        case NEARLIGHT_EMITTER_SUN:
            return 2;
        case NEARLIGHT_EMITTER_ENVIRONMENT:
            return 3;
        default:
            return is_area_light(emitter) ? 4 : 0;
    }
}

/// The probability of each light. By power alone, a lamp in a room would hardly ever be chosen beside a sky
/// that the room does not see, because the power of the sky grows with the size of the scene around it.
std::vector<double> choice_probabilities(std::span<const Emitter> emitters, std::span<const double> powers) {
    std::array<double, kKindCount> of_kind{};
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        of_kind[kind_of(emitters[i])] += powers[i];
    }
    const auto kinds = static_cast<double>(kKindCount - std::ranges::count(of_kind, 0.0));
    std::vector<double> probabilities(emitters.size());
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        probabilities[i] = powers[i] / (kinds * of_kind[kind_of(emitters[i])]);
    }
    return probabilities;
}

/// Which lights have a tree: area lights, and lamps without a surface where they are too many to be summed.
void set_tree_range(EmitterTable& table) {
    const auto count_if = [&](auto&& is_kind) {
        return static_cast<uint>(std::ranges::count_if(table.emitters, is_kind));
    };
    const bool are_summed = table.delta_emitter_count <= NEARLIGHT_MAX_EXACT_LIGHTS;
    table.tree_first = are_summed ? table.delta_emitter_count : count_if(is_directional);
    table.tree_end = table.delta_emitter_count + count_if(is_area_light);
    if (table.tree_end - table.tree_first < kMinTreeLights) {
        table.tree_end = table.tree_first;
    }
}

}  // namespace

bool is_area_light(const Emitter& emitter) {
    return emitter.type == NEARLIGHT_EMITTER_TRIANGLE || emitter.type == NEARLIGHT_EMITTER_SPHERE ||
           emitter.type == NEARLIGHT_EMITTER_CYLINDER;
}

bool is_distant(const Emitter& emitter) {
    return emitter.type == NEARLIGHT_EMITTER_ENVIRONMENT || emitter.type == NEARLIGHT_EMITTER_SUN;
}

bool is_delta_light(const Emitter& emitter) {
    return !is_area_light(emitter) && !is_distant(emitter);
}

EmitterTable build_emitter_table(const Scene& scene) {
    const float scene_radius = bounding_sphere(scene).radius;
    EmitterTable table;
    std::vector<double> powers;
    double total = 0;
    for (const Emitter& emitter : collect_emitters(scene)) {
        const double power = emitted_power(scene, emitter, scene_radius);
        if (!(power > 0)) {
            continue;
        }
        table.emitters.push_back(emitter);
        table.delta_emitter_count += is_delta_light(emitter) ? 1u : 0u;
        powers.push_back(power);
        total += power;
    }
    const std::vector<float> cdf = cumulative_distribution(choice_probabilities(table.emitters, powers));
    for (std::size_t i = 0; i < cdf.size(); ++i) {
        table.emitters[i].cdf = cdf[i];
        table.emitters[i].probability = i > 0 ? cdf[i] - cdf[i - 1] : cdf[i];
    }
    set_tree_range(table);
    table.light_tree = build_light_tree(scene, table.emitters, table.tree_first, table.tree_end);
    table.total_power = static_cast<float>(total);
    return table;
}

}  // namespace nearlight::core
