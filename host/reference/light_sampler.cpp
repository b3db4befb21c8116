// SPDX-License-Identifier: Apache-2.0
#include "host/reference/light_sampler.h"

#include <span>

#include "host/base/math.h"
#include "host/scene/ray_epsilon.h"

namespace nearlight::core {
namespace {

// With more point and spot lights than this, one of them is chosen by power.
constexpr uint kMaxDeltaRays = 16;

/// Index of the first entry above u, or of the last entry if rounding leaves none above.
uint pick_entry(std::span<const float> cdf, float u) {
    const auto found = std::upper_bound(cdf.begin(), cdf.end(), u);
    return static_cast<uint>(std::min(found - cdf.begin(), std::ptrdiff_t(cdf.size()) - 1));
}

const Emitter& pick_emitter(std::span<const Emitter> emitters, float u) {
    const auto found =
        std::upper_bound(emitters.begin(), emitters.end(), u,
                         [](float value, const Emitter& emitter) { return value < emitter.cdf; });
    return found == emitters.end() ? emitters.back() : *found;
}

/// Intensity (W/sr) of a point or spot light in the unit direction away from it.
Vec3 intensity(const Emitter& emitter, Vec3 direction) {
    if (emitter.type == NEARLIGHT_EMITTER_POINT) {
        return emitter.radiance;
    }
    const float angle = std::acos(std::clamp(dot(direction, emitter.direction), -1.0f, 1.0f));
    if (angle <= emitter.beam_angle) {
        return emitter.radiance;
    }
    if (angle >= emitter.cutoff_angle) {
        return {0, 0, 0};
    }
    return emitter.radiance * ((emitter.cutoff_angle - angle) / (emitter.cutoff_angle - emitter.beam_angle));
}

}  // namespace

Vec3 delta_light_irradiance(const EmbreeScene& embree, const Emitter& emitter, Vec3 position, Vec3 normal) {
    const bool is_delta = emitter.type == NEARLIGHT_EMITTER_POINT || emitter.type == NEARLIGHT_EMITTER_SPOT;
    const Vec3 to_light = emitter.position - position;
    const float distance2 = dot(to_light, to_light);
    if (!is_delta || !(distance2 > 0.0f)) {
        return {0, 0, 0};
    }
    const Vec3 direction = to_light / std::sqrt(distance2);
    const float cosine = dot(normal, direction);
    const Vec3 arriving = intensity(emitter, -direction);
    if (cosine <= 0.0f || is_zero(arriving) || embree.blocked(position, emitter.position)) {
        return {0, 0, 0};
    }
    return arriving * (cosine / distance2);
}

LightSampler::LightSampler(const Scene& scene)
    : scene_(scene),
      table_(build_emitter_table(scene)),
      environment_(build_environment_table(scene)),
      extent_(max_component(bounds(scene).size())) {
    const std::span<const Emitter> area_lights =
        std::span(table_.emitters).subspan(table_.delta_emitter_count);
    for (const Emitter& emitter : area_lights) {
        area_share_ += emitter.probability;
    }
    for (const Emitter& emitter : area_lights) {
        const float probability = emitter.probability / area_share_;
        if (emitter.type == NEARLIGHT_EMITTER_ENVIRONMENT) {
            environment_probability_ = probability;
        } else if (!is_glass(scene.materials[scene.triangles[emitter.triangle].material])) {
            triangle_density_.resize(scene.triangles.size(), 0.0f);
            triangle_density_[emitter.triangle] = probability / emitter.area;
        }
    }
}

Vec3 LightSampler::triangle_normal(uint triangle) const {
    const Triangle& t = scene_.triangles[triangle];
    const Vec3 v0 = scene_.vertices[t.v0].position;
    return normalize(cross(scene_.vertices[t.v1].position - v0, scene_.vertices[t.v2].position - v0));
}

Vec3 LightSampler::emitted_radiance(uint triangle, Vec3 direction) const {
    const Vec3 emission = scene_.materials[scene_.triangles[triangle].material].emission;
    return is_zero(emission) || dot(triangle_normal(triangle), direction) >= 0.0f ? Vec3{0, 0, 0} : emission;
}

Vec3 LightSampler::sampled_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                      LightRandom random) const {
    Vec3 sum = delta_irradiance(embree, position, normal, random.pick);
    if (!(area_share_ > 0.0f)) {
        return sum;
    }
    const auto area_lights = std::span(table_.emitters).subspan(table_.delta_emitter_count);
    const Emitter& emitter = pick_emitter(area_lights, 1.0f - area_share_ * (1.0f - random.pick));
    const float probability = emitter.probability / area_share_;
    if (emitter.type == NEARLIGHT_EMITTER_ENVIRONMENT) {
        // The part of the random number that the choice of the light left unused chooses the row.
        const float first = 1.0f - environment_probability_;
        random.pick = std::clamp((random.pick - first) / environment_probability_, 0.0f, 0x1.fffffep-1f);
        sum += environment_irradiance(embree, position, normal, probability, random);
    } else {
        sum += triangle_irradiance(embree, position, normal, emitter, probability, random.place);
    }
    return sum;
}

Vec3 LightSampler::delta_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal, float pick) const {
    const auto lights = std::span(table_.emitters).first(table_.delta_emitter_count);
    if (lights.size() > kMaxDeltaRays) {
        const float share = lights.back().cdf;
        const Emitter& emitter = pick_emitter(lights, pick * share);
        return delta_light_irradiance(embree, emitter, position, normal) * (share / emitter.probability);
    }
    Vec3 sum{0, 0, 0};
    for (const Emitter& emitter : lights) {
        sum += delta_light_irradiance(embree, emitter, position, normal);
    }
    return sum;
}

Vec3 LightSampler::triangle_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                       const Emitter& emitter, float probability, Point2 u) const {
    const Triangle& triangle = scene_.triangles[emitter.triangle];
    const Vec3 v0 = scene_.vertices[triangle.v0].position;
    const Vec3 edge1 = scene_.vertices[triangle.v1].position - v0;
    const Vec3 edge2 = scene_.vertices[triangle.v2].position - v0;
    const Point2 weights = sample_triangle(u);
    const Vec3 light_normal = normalize(cross(edge1, edge2));
    const Vec3 target = stand_off(v0 + edge1 * weights.x + edge2 * weights.y, light_normal, extent_);

    const Vec3 to_light = target - position;
    const float distance2 = dot(to_light, to_light);
    const Vec3 direction = normalize(to_light);
    const float cosine = dot(normal, direction);
    const float light_cosine = -dot(light_normal, direction);
    if (cosine <= 0.0f || light_cosine <= 0.0f || embree.blocked(position, target)) {
        return {0, 0, 0};
    }
    const float density = probability / emitter.area * distance2 / light_cosine;
    const bool can_be_met = !triangle_density_.empty() && triangle_density_[emitter.triangle] > 0.0f;
    return emitter.radiance * (cosine / (density + (can_be_met ? cosine / kPi : 0.0f)));
}

Vec3 LightSampler::environment_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                          float probability, LightRandom random) const {
    const Environment& parameters = environment_.parameters;
    Pixel pixel;
    pixel.row = pick_entry(environment_.row_cdf, random.pick);
    const std::span columns =
        std::span(environment_.column_cdf).subspan(pixel.row * parameters.width, parameters.width);
    pixel.column = pick_entry(columns, random.place.x);
    const float before = pixel.column > 0 ? columns[pixel.column - 1] : 0.0f;
    const float share = columns[pixel.column] - before;
    const float within = share > 0.0f ? std::clamp((random.place.x - before) / share, 0.0f, 1.0f) : 0.5f;

    const float width = static_cast<float>(parameters.width);
    const float height = static_cast<float>(parameters.height);
    const float azimuth = 2.0f * kPi * (static_cast<float>(pixel.column) + within) / width;
    const float cos_top = std::cos(kPi * static_cast<float>(pixel.row) / height);
    const float cos_bottom = std::cos(kPi * static_cast<float>(pixel.row + 1) / height);
    const float y = cos_top + (cos_bottom - cos_top) * random.place.y;
    const float sine = std::sqrt(std::max(0.0f, 1.0f - y * y));
    const Vec3 local{std::sin(azimuth) * sine, y, -std::cos(azimuth) * sine};
    const float* m = parameters.world_to_local;  // a rotation, so its transpose is its inverse
    const Vec3 direction{m[0] * local.x + m[3] * local.y + m[6] * local.z,
                         m[1] * local.x + m[4] * local.y + m[7] * local.z,
                         m[2] * local.x + m[5] * local.y + m[8] * local.z};

    const float cosine = dot(normal, direction);
    if (cosine <= 0.0f || embree.occluded(position, direction, 0.0f, kInfinity)) {
        return {0, 0, 0};
    }
    const float* rgba = &environment_.pixels[4 * (pixel.row * std::size_t{parameters.width} + pixel.column)];
    const float density = probability * pixel_density(pixel);
    return Vec3{rgba[0], rgba[1], rgba[2]} * (cosine / (density + cosine / kPi));
}

LightSampler::Pixel LightSampler::pixel_towards(Vec3 direction) const {
    const Environment& parameters = environment_.parameters;
    const float* m = parameters.world_to_local;
    const Vec3 local{m[0] * direction.x + m[1] * direction.y + m[2] * direction.z,
                     m[3] * direction.x + m[4] * direction.y + m[5] * direction.z,
                     m[6] * direction.x + m[7] * direction.y + m[8] * direction.z};
    float azimuth = std::atan2(local.x, -local.z) / (2.0f * kPi);
    azimuth -= std::floor(azimuth);
    const float inclination = std::acos(std::clamp(local.y, -1.0f, 1.0f)) / kPi;
    return {std::min(static_cast<uint>(azimuth * static_cast<float>(parameters.width)), parameters.width - 1),
            std::min(static_cast<uint>(inclination * static_cast<float>(parameters.height)),
                     parameters.height - 1)};
}

float LightSampler::pixel_density(Pixel pixel) const {
    const Environment& parameters = environment_.parameters;
    const auto step = [](std::span<const float> cdf, uint i) { return i > 0 ? cdf[i] - cdf[i - 1] : cdf[i]; };
    const std::span columns =
        std::span(environment_.column_cdf).subspan(pixel.row * parameters.width, parameters.width);
    const float probability = step(environment_.row_cdf, pixel.row) * step(columns, pixel.column);
    const float height = static_cast<float>(parameters.height);
    const float zone = std::cos(kPi * static_cast<float>(pixel.row) / height) -
                       std::cos(kPi * static_cast<float>(pixel.row + 1) / height);
    return probability * static_cast<float>(parameters.width) / (2.0f * kPi * zone);
}

Vec3 LightSampler::environment_radiance(Vec3 direction) const {
    if (environment_.parameters.width == 0) {
        return {0, 0, 0};
    }
    const Pixel pixel = pixel_towards(direction);
    const float* rgba =
        &environment_.pixels[4 * (pixel.row * std::size_t{environment_.parameters.width} + pixel.column)];
    return {rgba[0], rgba[1], rgba[2]};
}

Vec3 LightSampler::met_radiance(const BvhHit& hit, Vec3 direction, Vec3 normal) const {
    const float cosine_density = std::max(0.0f, dot(normal, direction)) / kPi;
    if (hit.triangle == ~0u) {
        const Vec3 radiance = environment_radiance(direction);
        if (is_zero(radiance)) {
            return radiance;
        }
        const float density = environment_probability_ * pixel_density(pixel_towards(direction));
        return radiance * (cosine_density / (cosine_density + density));
    }
    const float chosen = triangle_density_.empty() ? 0.0f : triangle_density_[hit.triangle];
    const float light_cosine = chosen > 0.0f ? -dot(triangle_normal(hit.triangle), direction) : 0.0f;
    if (light_cosine <= 0.0f) {
        return {0, 0, 0};
    }
    const float density = chosen * hit.t * hit.t / light_cosine;
    return emitted_radiance(hit.triangle, direction) * (cosine_density / (cosine_density + density));
}

}  // namespace nearlight::core
