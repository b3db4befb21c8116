// SPDX-License-Identifier: Apache-2.0
#include "host/reference/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/math.h"
#include "host/reference/delta_light.h"
#include "host/reference/seen_cylinder.h"
#include "host/reference/seen_sphere.h"
#include "host/reference/spherical_triangle.h"
#include "host/reference/surface.h"
#include "host/scene/ray_epsilon.h"

namespace nearlight::core {
namespace {

/// Density per steradian of a point that is uniform over a triangle, seen under the given cosine.
double area_density(const Emitter& emitter, double distance, double cosine) {
    return cosine > 0.0 ? distance * distance / (cosine * static_cast<double>(emitter.area)) : 0.0;
}

/// The barycentric weights of the second and the third corner at a point of the triangle.
Point2 weights_at(const std::array<Vec3, 3>& corners, Vec3 point) {
    const Vec3 edge1 = corners[1] - corners[0];
    const Vec3 edge2 = corners[2] - corners[0];
    const Vec3 normal = cross(edge1, edge2);
    const float scale = 1.0f / std::max(dot(normal, normal), std::numeric_limits<float>::min());
    const float weight1 = dot(cross(point - corners[0], edge2), normal) * scale;
    const float weight2 = dot(cross(edge1, point - corners[0]), normal) * scale;
    return {std::clamp(weight1, 0.0f, 1.0f), std::clamp(weight2, 0.0f, 1.0f)};
}

/// A sample of a sphere or cylinder, as it is seen.
template <typename Seen>
LightPick round_pick(const Emitter& emitter, const Seen& seen, Point2 u, float extent) {
    LightPick pick;
    pick.can_be_met = true;
    if (!seen.is_seen()) {
        return pick;
    }
    pick.direction = seen.sample(u);
    const Vec3 entry = seen.entry(pick.direction);
    pick.target = moved_off(entry, seen.outwards(entry), extent_about(entry, emitter.radius, extent));
    pick.density = seen.density(pick.direction);
    if (pick.density > 0.0) {
        pick.radiance = emitter.radiance;
    }
    return pick;
}

}  // namespace

Vec3 delta_light_irradiance(const Scene& scene, const EmbreeScene& embree, const Emitter& emitter,
                            Vec3 position, Vec3 normal) {
    const LightPick pick = LightSampler::exact_light(scene, emitter, position);
    const float cosine = dot(normal, pick.direction);
    if (cosine <= 0.0f || is_zero(pick.radiance) || !LightSampler::is_visible(embree, position, pick)) {
        return {0, 0, 0};
    }
    return pick.radiance * cosine;
}

LightSampler::LightSampler(const Scene& scene)
    : scene_(scene),
      table_(build_emitter_table(scene)),
      environment_(scene),
      scene_size_(bounds(scene).size()) {
    sampled_first_ =
        table_.delta_emitter_count <= NEARLIGHT_MAX_EXACT_LIGHTS ? table_.delta_emitter_count : 0;
    sampled_before_ = sampled_first_ > 0 ? table_.emitters[sampled_first_ - 1].cdf : 0.0;
}

std::span<const Emitter> LightSampler::exact_lights() const {
    return std::span(table_.emitters).first(sampled_first_);
}

LightPick LightSampler::exact_light(const Scene& scene, const Emitter& emitter, Vec3 position) {
    const DeltaLight light = delta_light_at(scene, emitter, position);
    return {.direction = light.direction,
            .target = emitter.position,
            .radiance = light.irradiance,
            .density = 1.0,
            .infinite = light.infinite,
            .is_delta = true,
            .can_be_met = false};
}

std::array<Vec3, 3> LightSampler::corners_of(uint triangle) const {
    const Triangle& t = scene_.triangles[triangle];
    return {scene_.vertices[t.v0].position, scene_.vertices[t.v1].position, scene_.vertices[t.v2].position};
}

Vec3 LightSampler::triangle_normal(uint triangle) const {
    const auto [v0, v1, v2] = corners_of(triangle);
    return normalize(cross(v1 - v0, v2 - v0));
}

Vec3 LightSampler::emitted_radiance(const BvhHit& hit, Vec3 direction) const {
    const Parameter& emission = scene_.materials[scene_.triangles[hit.triangle].material].emission;
    if (is_zero(emission.value) || dot(triangle_normal(hit.triangle), direction) >= 0.0f) {
        return {0, 0, 0};
    }
    return max(value_at(scene_, surface_at(scene_, hit, direction), emission), Vec3{0, 0, 0});
}

double LightSampler::choice_probability(const Emitter& emitter) const {
    return emitter.probability / (1.0 - sampled_before_);
}

LightPick LightSampler::triangle_pick(const Emitter& emitter, Vec3 position, Point2 u) const {
    const std::array<Vec3, 3> corners = corners_of(emitter.triangle);
    const Vec3 light_normal = triangle_normal(emitter.triangle);
    LightPick pick;
    pick.can_be_met = true;
    const double height = dot(light_normal, position - corners[0]);
    if (!(height > 0.0)) {
        return pick;
    }
    Vec3 point;
    const SphericalTriangle seen(corners, position);
    if (seen.solid_angle() > 0.0) {
        pick.direction = seen.sample(u);
        const double approach = -dot(light_normal, pick.direction);
        point = position + pick.direction * static_cast<float>(height / std::max(approach, 1e-12));
        pick.density = 1.0 / seen.solid_angle();
    } else {
        const Point2 weights = sample_triangle(u);
        point = corners[0] + (corners[1] - corners[0]) * weights.x + (corners[2] - corners[0]) * weights.y;
        pick.direction = normalize(point - position);
        const double distance = length(point - position);
        pick.density = area_density(emitter, distance, -dot(light_normal, pick.direction));
    }
    pick.target = point + light_normal * triangle_stand_off(corners[0], corners[1], corners[2], scene_size_);
    if (pick.density > 0.0) {
        const auto [u1, u2] = weights_at(corners, point);
        pick.radiance = emitted_radiance({0.0f, u1, u2, emitter.triangle}, pick.direction);
    }
    return pick;
}

LightPick LightSampler::sample(Vec3 position, LightRandom random) const {
    const auto lights = std::span(table_.emitters).subspan(sampled_first_);
    if (lights.empty()) {
        return {};
    }
    // Rounding is away from the entries that are summed exactly.
    const double u = 1.0 - (1.0 - sampled_before_) * (1.0 - static_cast<double>(random.pick));
    const auto found =
        std::upper_bound(lights.begin(), lights.end(), u,
                         [](double value, const Emitter& emitter) { return value < emitter.cdf; });
    const Emitter& emitter = found == lights.end() ? lights.back() : *found;
    LightPick pick;
    if (emitter.type == NEARLIGHT_EMITTER_ENVIRONMENT || emitter.type == NEARLIGHT_EMITTER_SUN) {
        // The part of the random number that the choice of the light left unused chooses the row.
        const double before = static_cast<double>(emitter.cdf) - static_cast<double>(emitter.probability);
        const double row = std::clamp((u - before) / emitter.probability, 0.0, 0x1.fffffep-1);
        const Vec3 direction = emitter.type == NEARLIGHT_EMITTER_SUN
                                   ? environment_.sample_sun(random.place)
                                   : environment_.sample(static_cast<float>(row), random.place);
        return {.direction = direction,
                .target = position,
                .radiance = environment_.radiance(direction),
                .density = distant_density(direction),
                .infinite = true,
                .is_delta = false,
                .can_be_met = true};
    }
    if (emitter.type == NEARLIGHT_EMITTER_TRIANGLE) {
        pick = triangle_pick(emitter, position, random.place);
    } else if (emitter.type == NEARLIGHT_EMITTER_SPHERE) {
        pick = round_pick(emitter, SeenSphere(emitter, position), random.place, max_component(scene_size_));
    } else if (emitter.type == NEARLIGHT_EMITTER_CYLINDER) {
        pick = round_pick(emitter, SeenCylinder(emitter, position), random.place, max_component(scene_size_));
    } else {
        pick = exact_light(scene_, emitter, position);
    }
    pick.density *= choice_probability(emitter);
    return pick;
}

const Emitter* LightSampler::emitter_of_triangle(uint triangle) const {
    const auto lights = std::span(table_.emitters).subspan(table_.delta_emitter_count);
    const auto behind = std::partition_point(lights.begin(), lights.end(), [&](const Emitter& emitter) {
        return is_area_light(emitter) && emitter.triangle <= triangle;
    });
    if (behind == lights.begin()) {
        return nullptr;
    }
    const Emitter& last = *(behind - 1);
    return triangle < last.triangle + last.triangle_count ? &last : nullptr;
}

double LightSampler::distant_density(Vec3 direction) const {
    double density = 0.0;
    for (auto emitter = table_.emitters.rbegin(); emitter != table_.emitters.rend(); ++emitter) {
        if (emitter->type == NEARLIGHT_EMITTER_SUN) {
            density += choice_probability(*emitter) * environment_.sun_density(direction);
        } else if (emitter->type == NEARLIGHT_EMITTER_ENVIRONMENT) {
            density += choice_probability(*emitter) * environment_.density(direction);
        } else {
            break;  // these two stand last in the table
        }
    }
    return density;
}

double LightSampler::pdf(Vec3 position, Vec3 direction, const BvhHit& hit) const {
    if (hit.triangle == ~0u) {
        return distant_density(direction);
    }
    const Emitter* emitter = emitter_of_triangle(hit.triangle);
    if (emitter == nullptr) {
        return 0.0;
    }
    const double light_cosine = -dot(triangle_normal(hit.triangle), direction);
    if (!(light_cosine > 0.0)) {
        return 0.0;
    }
    if (emitter->type == NEARLIGHT_EMITTER_SPHERE) {
        return choice_probability(*emitter) * SeenSphere(*emitter, position).density(direction);
    }
    if (emitter->type == NEARLIGHT_EMITTER_CYLINDER) {
        return choice_probability(*emitter) * SeenCylinder(*emitter, position).density(direction);
    }
    const SphericalTriangle seen(corners_of(hit.triangle), position);
    return choice_probability(*emitter) * (seen.solid_angle() > 0.0
                                               ? 1.0 / seen.solid_angle()
                                               : area_density(*emitter, hit.t, light_cosine));
}

bool LightSampler::is_visible(const EmbreeScene& embree, Vec3 position, const LightPick& pick) {
    return pick.infinite ? !embree.occluded(position, pick.direction, 0.0f, kInfinity)
                         : !embree.blocked(position, pick.target);
}

Vec3 LightSampler::sampled_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                      LightRandom random) const {
    Vec3 sum{0, 0, 0};
    for (const Emitter& emitter : exact_lights()) {
        sum += delta_light_irradiance(scene_, embree, emitter, position, normal);
    }
    const LightPick pick = sample(position, random);
    const float cosine = dot(normal, pick.direction);
    if (cosine <= 0.0f || is_zero(pick.radiance) || !is_visible(embree, position, pick)) {
        return sum;
    }
    const double cosine_density = pick.can_be_met ? cosine / std::numbers::pi : 0.0;
    return sum + pick.radiance * static_cast<float>(cosine / (pick.density + cosine_density));
}

Vec3 LightSampler::met_radiance(const BvhHit& hit, Vec3 position, Vec3 direction, Vec3 normal) const {
    const Vec3 radiance =
        hit.triangle == ~0u ? environment_radiance(direction) : emitted_radiance(hit, direction);
    const double cosine_density = std::max(0.0f, dot(normal, direction)) / std::numbers::pi;
    if (is_zero(radiance) || !(cosine_density > 0.0)) {
        return {0, 0, 0};
    }
    const double density = pdf(position, direction, hit);
    return radiance * static_cast<float>(cosine_density / (cosine_density + density));
}

}  // namespace nearlight::core
