// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "viewer/channels.h"
#include "viewer/frame.h"
#include "viewer/vectors.h"

namespace nearlight::viewer {
namespace {

constexpr IrradianceSettings kManySamples{.direct_samples = 1024, .paths = 1024};
constexpr IrradianceSettings kNoPaths{.direct_samples = 1024, .paths = 0};

/// The value of a layer of three channels at a pixel; zero if the picture lacks the layer.
Vec3 vector_at(const Image& image, std::string_view layer, int x, int y) {
    const auto [first, count] = channels_of(image, layer);
    return count == 3 ? Vec3{image.at(x, y, first), image.at(x, y, first + 1), image.at(x, y, first + 2)}
                      : Vec3{};
}

Vec3 irradiance_at(Session& session, const Inspection& at, const VplSet& vpls,
                   const IrradianceSettings& settings) {
    const std::array points{at.position};
    const std::array normals{at.normal};
    return session.irradiance(points, normals, vpls, settings).front();
}

Vec3 above_zero(Vec3 v) {
    return {std::max(v.x, 0.0f), std::max(v.y, 0.0f), std::max(v.z, 0.0f)};
}

}  // namespace

Inspection inspect(Session& session, const Frame& frame, int x, int y) {
    Inspection result{.x = x, .y = y};
    const Vec3 normal = vector_at(frame.image, "N", x, y);
    if (!(length(normal) > 0.5f) || !frame.vpls || !frame.view) {
        return result;
    }
    result.hits_surface = true;
    result.position = vector_at(frame.image, "P", x, y);
    result.normal = normalize(normal);
    result.shares = session.light_shares(result.position, result.normal, *frame.vpls);
    for (const LightShare& share : result.shares) {
        if (share.kind == LightKind::vpl) {
            result.from_vpls = result.from_vpls + share.irradiance;
            result.clamped = result.clamped + share.taken_by_clamp;
        }
    }
    const VplSet none = session.sample(*frame.view, {.vpl_count = 0});
    result.direct = irradiance_at(session, result, none, kNoPaths);
    const Vec3 all = irradiance_at(session, result, *frame.vpls, kManySamples);
    result.remainder = above_zero(all - result.direct - result.from_vpls);
    return result;
}

}  // namespace nearlight::viewer
