// SPDX-License-Identifier: Apache-2.0
#include "host/session/light_shares.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "host/base/cosine_direction.h"
#include "host/base/random.h"
#include "host/base/seen_normal.h"
#include "host/scene/emitters.h"
#include "host/scene/environment_map.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/texture.h"
#include "host/stages/ray_caster.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kSurfaceSamples = 4096;  ///< of all area lights together, and at least one a triangle
constexpr std::size_t kMaxSamplesPerTriangle = 64;
constexpr std::size_t kEnvironmentSamples = 1024;
constexpr std::size_t kSunSamples = 16;
/// Shadow rays end before the light that they ask about.
constexpr float kRayEnd = 0.9995f;

/// Light that reaches the point if nothing is in between.
struct LightProbe {
    RayQuery ray{};
    std::size_t share = 0;
    Vec3 irradiance{0, 0, 0};
    Vec3 taken_by_clamp{0, 0, 0};
};

nearlight::Vec3 public_vec(Vec3 v) {
    return {v.x, v.y, v.z};
}

void add_to(nearlight::Vec3& sum, Vec3 v) {
    sum = {sum.x + v.x, sum.y + v.y, sum.z + v.z};
}

/// The classes of emissive triangles that share vertices.
class TriangleGroups {
  public:
    explicit TriangleGroups(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    std::size_t find(std::size_t i) {
        while (parent_[i] != i) {
            i = parent_[i] = parent_[parent_[i]];
        }
        return i;
    }
    void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

  private:
    std::vector<std::size_t> parent_;
};

/// Makes shares and the probes that decide them.
class ShareMaker {
  public:
    ShareMaker(const Scene& scene, const LitPoint& point, float extent)
        : scene_(scene),
          point_(point),
          start_(moved_off(point.position, point.normal, extent)),
          random_(point.seed) {}

    void add_vpl(const Vpl& vpl) {
        const std::size_t share = begin_share(LightKind::vpl, vpl.position);
        const Vec3 way = vpl.position - start_;
        const float square = dot(way, way);
        const float distance = std::sqrt(square);
        const float cosines = dot(point_.normal, way) * -dot(vpl.normal, way) / square;
        const bool is_seen = dot(seen_normal(vpl), way) < 0.0f;
        if (!(dot(point_.normal, way) > 0.0f) || !(cosines > 0.0f) || !(distance > 0.0f) || !is_seen) {
            return;
        }
        const float clamped_square = std::max(square, point_.clamp_radius * point_.clamp_radius);
        const Vec3 intensity = vpl.power * (cosines / kPi);
        probes_.push_back({.ray = {start_, 0.0f, way, kRayEnd},
                           .share = share,
                           .irradiance = intensity / clamped_square,
                           .taken_by_clamp = intensity * (1.0f / square - 1.0f / clamped_square)});
    }

    void add_emitters() {
        const EmitterTable table = build_emitter_table(scene_);
        std::vector<const Emitter*> areas;
        emitter_count_ = 0;
        for (const Emitter& emitter : table.emitters) {
            if (is_area_light(emitter)) {
                areas.push_back(&emitter);
            } else if (emitter.type == NEARLIGHT_EMITTER_ENVIRONMENT) {
                add_environment();
            } else if (emitter.type == NEARLIGHT_EMITTER_SUN) {
                add_sun(emitter);
            } else {
                add_delta_light(emitter);
            }
        }
        add_area_lights(areas);
    }

    [[nodiscard]] const std::vector<LightProbe>& probes() const { return probes_; }
    std::vector<LightShare>& shares() { return shares_; }

  private:
    std::size_t begin_share(LightKind kind, Vec3 position) {
        const std::size_t index =
            kind == LightKind::vpl ? shares_.size() : static_cast<std::size_t>(emitter_count_++);
        shares_.push_back({.kind = kind, .index = index, .position = public_vec(position)});
        return shares_.size() - 1;
    }

    /// Light from infinitely far away: `across` is what a surface across the direction receives.
    void add_distant(std::size_t share, Vec3 direction, Vec3 across) {
        const float cosine = dot(point_.normal, direction);
        if (cosine > 0.0f) {
            probes_.push_back(
                {.ray = {start_, 0.0f, direction, kInfinity}, .share = share, .irradiance = across * cosine});
        }
    }

    void add_delta_light(const Emitter& emitter) {
        if (emitter.type == NEARLIGHT_EMITTER_DIRECTIONAL) {
            const std::size_t share = begin_share(LightKind::directional, -emitter.direction);
            add_distant(share, -emitter.direction, emitter.radiance);
            return;
        }
        const bool is_point = emitter.type == NEARLIGHT_EMITTER_POINT;
        const bool is_spot = emitter.type == NEARLIGHT_EMITTER_SPOT;
        const std::size_t share = begin_share(is_point  ? LightKind::point
                                              : is_spot ? LightKind::spot
                                                        : LightKind::projector,
                                              emitter.position);
        const Vec3 way = emitter.position - start_;
        const float distance = length(way);
        const float cosine = dot(point_.normal, way) / distance;
        const float falloff = is_point ? 1.0f : falloff_of(emitter, way / -distance);
        if (cosine > 0.0f && falloff > 0.0f) {
            probes_.push_back({.ray = {start_, 0.0f, way, kRayEnd},
                               .share = share,
                               .irradiance = emitter.radiance * mean_value(scene_, image_of(emitter)) *
                                             (falloff * cosine / (distance * distance))});
        }
    }

    static Parameter image_of(const Emitter& emitter) {
        return {{1, 1, 1}, static_cast<int>(emitter.image) - 1};
    }

    /// The part of a spot's or projector's intensity that goes in this direction.
    static float falloff_of(const Emitter& emitter, Vec3 direction) {
        const float cosine = dot(direction, emitter.direction);
        if (emitter.type == NEARLIGHT_EMITTER_PROJECTOR) {
            const bool is_inside = cosine > 0.0f &&
                                   std::abs(dot(direction, emitter.x_axis)) <= 0.5f * cosine &&
                                   std::abs(dot(direction, emitter.y_axis)) <= 0.5f * cosine;
            return is_inside ? 1.0f / (cosine * cosine * cosine) : 0.0f;
        }
        const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
        const float width = std::max(emitter.cutoff_angle - emitter.beam_angle, 1e-6f);
        return std::clamp((emitter.cutoff_angle - angle) / width, 0.0f, 1.0f);
    }

    void add_sun(const Emitter& emitter) {
        const Vec3 direction = scene_.environment.sun_direction;
        const std::size_t share = begin_share(LightKind::sun, direction);
        const auto [right, up] = orthonormal_basis(direction);
        const float rim = std::tan(scene_.environment.sun_half_angle);
        for (std::size_t i = 0; i < kSunSamples; ++i) {
            const float radius = rim * std::sqrt(random_.uniform());
            const float angle = 2.0f * kPi * random_.uniform();
            add_distant(
                share,
                normalize(direction + right * (radius * std::cos(angle)) + up * (radius * std::sin(angle))),
                emitter.radiance * (emitter.area / static_cast<float>(kSunSamples)));
        }
    }

    void add_environment() {
        const std::size_t share = begin_share(LightKind::environment, {0, 0, 0});
        const EnvironmentLight& map = scene_.environment;
        const MapShape shape{.width = static_cast<uint>(map.width),
                             .height = static_cast<uint>(map.height),
                             .is_interpolated = map.is_interpolated};
        const auto radiance_of = [&](MapPixel pixel) {
            return map.radiance[pixel.row * std::size_t{shape.width} + pixel.column];
        };
        const Mat4 to_local = inverse(map.to_world);
        for (std::size_t i = 0; i < kEnvironmentSamples; ++i) {
            const Vec3 direction = normalize(cosine_direction(point_.normal, random_));
            const Vec3 local = normalize(transform_vector(to_local, direction));
            probes_.push_back({.ray = {start_, 0.0f, direction, kInfinity},
                               .share = share,
                               .irradiance = map_radiance(shape, local, radiance_of) *
                                             (kPi / static_cast<float>(kEnvironmentSamples))});
        }
    }

    void add_area_lights(std::span<const Emitter* const> lights) {
        const std::vector<std::size_t> groups = groups_of(lights);
        std::size_t triangles = 0;
        for (const Emitter* const light : lights) {
            triangles += std::max(light->triangle_count, 1u);
        }
        const std::size_t samples = std::clamp<std::size_t>(
            kSurfaceSamples / std::max<std::size_t>(triangles, 1), 1, kMaxSamplesPerTriangle);
        std::map<std::size_t, std::size_t> share_of_group;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            auto found = share_of_group.find(groups[i]);
            if (found == share_of_group.end()) {
                const std::size_t share = begin_share(LightKind::area, {0, 0, 0});
                found = share_of_group.emplace(groups[i], share).first;
                area_of_.resize(share + 1);
            }
            for (uint t = 0; t < std::max(lights[i]->triangle_count, 1u); ++t) {
                add_triangle(scene_.triangles[lights[i]->triangle + t], lights[i]->radiance, samples,
                             found->second);
            }
        }
        for (const auto& [group, share] : share_of_group) {
            const float area = std::max(area_of_[share], 1e-30f);
            nearlight::Vec3& middle = shares_[share].position;
            middle = {middle.x / area, middle.y / area, middle.z / area};
        }
    }

    /// The group of each light: lights whose triangles share vertices are one.
    [[nodiscard]] std::vector<std::size_t> groups_of(std::span<const Emitter* const> lights) const {
        TriangleGroups groups(lights.size());
        std::map<uint, std::size_t> light_at_vertex;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            for (uint t = 0; t < std::max(lights[i]->triangle_count, 1u); ++t) {
                const Triangle& triangle = scene_.triangles[lights[i]->triangle + t];
                for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
                    groups.join(i, light_at_vertex.try_emplace(vertex, i).first->second);
                }
            }
        }
        std::vector<std::size_t> result(lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) {
            result[i] = groups.find(i);
        }
        return result;
    }

    void add_triangle(const Triangle& triangle, Vec3 radiance, std::size_t samples, std::size_t share) {
        const Vec3 a = scene_.vertices[triangle.v0].position;
        const Vec3 edge1 = scene_.vertices[triangle.v1].position - a;
        const Vec3 edge2 = scene_.vertices[triangle.v2].position - a;
        const Vec3 twice_area = cross(edge1, edge2);
        const float area = 0.5f * length(twice_area);
        area_of_[share] += area;
        add_to(shares_[share].position, (a + (edge1 + edge2) / 3.0f) * area);
        for (std::size_t i = 0; i < samples; ++i) {
            const float root =
                std::sqrt((static_cast<float>(i) + random_.uniform()) / static_cast<float>(samples));
            const float v = random_.uniform();
            const Vec3 way = a + edge1 * (root * (1.0f - v)) + edge2 * (root * v) - start_;
            const float square = dot(way, way);
            const float cosine = dot(point_.normal, way);
            const float projected = -0.5f * dot(twice_area, way);  // times the cosine at the light
            if (cosine > 0.0f && projected > 0.0f) {
                probes_.push_back(
                    {.ray = {start_, 0.0f, way, kRayEnd},
                     .share = share,
                     .irradiance =
                         radiance * (cosine * projected / (square * square * static_cast<float>(samples)))});
            }
        }
    }

    const Scene& scene_;
    const LitPoint& point_;
    Vec3 start_;
    Pcg32 random_;
    std::vector<LightShare> shares_;
    std::vector<LightProbe> probes_;
    std::vector<float> area_of_;  ///< by share
    std::size_t emitter_count_ = 0;
};

}  // namespace

std::vector<LightShare> light_shares(Device& device, const DeviceScene& on_device, const Scene& scene,
                                     std::span<const Vpl> vpls, const LitPoint& point) {
    ShareMaker maker(scene, point, on_device.host_info.extent);
    for (const Vpl& vpl : vpls) {
        maker.add_vpl(vpl);
    }
    maker.add_emitters();
    std::vector<RayQuery> rays;
    std::ranges::transform(maker.probes(), std::back_inserter(rays), &LightProbe::ray);
    const std::vector<uint> is_occluded = RayCaster(device).occluded(on_device.tree, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (is_occluded[i] == 0) {
            LightShare& share = maker.shares()[maker.probes()[i].share];
            add_to(share.irradiance, maker.probes()[i].irradiance);
            add_to(share.taken_by_clamp, maker.probes()[i].taken_by_clamp);
        }
    }
    return std::move(maker.shares());
}

}  // namespace nearlight::core
