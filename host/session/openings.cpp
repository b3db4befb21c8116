// SPDX-License-Identifier: Apache-2.0
#include "host/session/openings.h"

#include <algorithm>

#include "host/base/cosine_direction.h"
#include "host/base/receivers.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/reflectance.h"
#include "host/session/line_waists.h"
#include "host/stages/ray_caster.h"

namespace nearlight::core {
namespace {

constexpr uint kRayStream = 0x09e5u;
constexpr uint kWaistStream = 0x3a157u;
constexpr int kRaysPerReceiver = 16;
/// How many lines are enough. While there are fewer, paths go on over further surfaces, up to kMaxSurfaces in
/// all.
constexpr std::size_t kEnoughLines = 48;
constexpr int kMaxSurfaces = 4;
constexpr int kMaxPanes = 8;  ///< that a path passes between two surfaces
/// Paths are outside at this many radii of the surroundings from their centre.
constexpr float kOutsideInRadii = 2.0f;
/// The camera looks at open country if more of its paths than this part are outside, after whichever surface.
constexpr double kMaxOutsidePart = 0.25;
/// The largest opening, in radii of the surroundings. Walks that aim at a larger one win little.
constexpr float kMaxRadius = 0.5f;
constexpr float kMinRadius = 1e-3f;  ///< the smallest, in the same measure

bool has_light_from_afar(const DeviceScene& on_device, const Scene& scene) {
    return on_device.has_sky() || std::ranges::any_of(scene.delta_emitters, [](const Emitter& emitter) {
               return emitter.type == NEARLIGHT_EMITTER_DIRECTIONAL;
           });
}

/// A ray that has passed panes up to the distance `passed` (m) from where it began.
struct PassingRay {
    HalfLine line;
    float passed = 0.0f;
};

/// Follows paths from what the camera sees.
class PathFollower {
  public:
    PathFollower(Device& device, const DeviceScene& on_device, const Scene& scene,
                 const CloseRange& surroundings)
        : device_(device),
          caster_(device),
          on_device_(on_device),
          triangle_ids_(on_device.tree.triangle_ids.download()),
          scene_(scene),
          surroundings_(surroundings) {
        for (const Material& material : scene.materials) {
            lets_through_.push_back(lets_through(scene, material));
        }
    }

    /// Follows each ray to the next surface, straight through panes. Keeps those that leave the surroundings
    /// as lines, and returns rays that go on from where the others landed.
    std::vector<PassingRay> follow(std::vector<PassingRay> rays, Pcg32& random) {
        std::vector<PassingRay> next;
        for (int pane = 0; pane <= kMaxPanes && !rays.empty(); ++pane) {
            const std::vector<RayHit> hits = cast(rays);
            std::vector<PassingRay> behind;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const HalfLine& line = rays[i].line;
                const Vec3 place = line.origin + line.direction * hits[i].t;
                if (hits[i].slot == ~0u || is_outside(place)) {
                    lines_.push_back(line);
                } else if (lets_through_[triangle_of(hits[i]).material]) {
                    behind.push_back({line, hits[i].t + 4 * stand_off(hits[i])});
                } else {
                    next.push_back({scattered(line.direction, place, hits[i], random)});
                }
            }
            rays = std::move(behind);
        }
        return next;
    }

    [[nodiscard]] const std::vector<HalfLine>& lines() const { return lines_; }

  private:
    [[nodiscard]] const Triangle& triangle_of(const RayHit& hit) const {
        return scene_.triangles[triangle_ids_[hit.slot]];
    }
    [[nodiscard]] std::vector<RayHit> cast(std::span<const PassingRay> rays) {
        std::vector<RayQuery> queries;
        for (const PassingRay& ray : rays) {
            queries.push_back({ray.line.origin, ray.passed, ray.line.direction, kInfinity});
        }
        Buffer<RayHit> hits(device_, rays.size());
        caster_.cast(on_device_.tree, Buffer<RayQuery>(device_, queries), hits);
        return hits.download();
    }
    [[nodiscard]] bool is_outside(Vec3 place) const {
        return length(place - surroundings_.origin) > kOutsideInRadii * surroundings_.range;
    }
    [[nodiscard]] float stand_off(const RayHit& hit) const {
        return triangle_stand_off(scene_, triangle_ids_[hit.slot], on_device_.host_info.size);
    }
    [[nodiscard]] HalfLine scattered(Vec3 arriving, Vec3 place, const RayHit& hit, Pcg32& random) const {
        const Triangle& t = triangle_of(hit);
        const auto corner = [&](uint vertex) { return scene_.vertices[vertex].position; };
        Vec3 normal = normalize(cross(corner(t.v1) - corner(t.v0), corner(t.v2) - corner(t.v0)));
        normal = dot(normal, arriving) > 0.0f ? -normal : normal;
        return {place + normal * stand_off(hit), cosine_direction(normal, random)};
    }

    Device& device_;
    RayCaster caster_;
    const DeviceScene& on_device_;
    std::vector<uint> triangle_ids_;  ///< of the tree's slots
    const Scene& scene_;
    const CloseRange& surroundings_;
    std::vector<bool> lets_through_;  ///< by material
    std::vector<HalfLine> lines_;
};

/// Rays that leave what the camera sees of its surroundings.
std::vector<PassingRay> first_rays(const PilotView& view, const CloseRange& surroundings, Pcg32& random) {
    std::vector<PassingRay> rays;
    for (const ReceiverPacket& packet : view.receivers.download()) {
        for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            const auto [position, normal] = receiver_at(packet, lane);
            const bool is_far = length(position - surroundings.origin) > surroundings.range;
            for (int i = 0; i < kRaysPerReceiver && !is_zero(normal) && !is_far; ++i) {
                rays.push_back({{position, cosine_direction(normal, random)}});
            }
        }
    }
    return rays;
}

}  // namespace

std::vector<Opening> find_openings(Device& device, const DeviceScene& on_device, const Scene& scene,
                                   const PilotView& view, const CloseRange& close_range, uint seed) {
    if (!has_light_from_afar(on_device, scene) || view.packet_count == 0) {
        return {};
    }
    Pcg32 random(seed, kRayStream);
    PathFollower paths(device, on_device, scene, close_range);
    std::vector<PassingRay> rays = first_rays(view, close_range, random);
    const std::size_t first_count = rays.size();
    for (int surface = 0; surface < kMaxSurfaces && paths.lines().size() < kEnoughLines; ++surface) {
        rays = paths.follow(std::move(rays), random);
        if (static_cast<double>(paths.lines().size()) > kMaxOutsidePart * static_cast<double>(first_count)) {
            return {};
        }
    }
    std::vector<Opening> openings;
    float shares = 0.0f;
    for (const Waist& waist : find_waists(paths.lines(), NEARLIGHT_MAX_OPENINGS, Pcg32(seed, kWaistStream))) {
        const float radius = std::max(waist.radius, kMinRadius * close_range.range);
        if (radius < kMaxRadius * close_range.range) {
            openings.push_back({waist.center, radius, waist.direction, waist.share});
            shares += waist.share;
        }
    }
    for (Opening& opening : openings) {
        opening.share /= shares;
    }
    return openings;
}

}  // namespace nearlight::core
