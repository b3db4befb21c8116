// SPDX-License-Identifier: Apache-2.0
#include "host/stages/pilot_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/receivers.h"
#include "host/stages/importon_groups.h"
#include "host/stages/small_view.h"

namespace nearlight::core {
namespace {

constexpr double kPixelCount = 1024;
/// Few importons suffice, because they only steer a choice. Many candidates gather from them, so each costs
/// time (bench/log/generation.md).
constexpr std::size_t kFewSquaredImportons = 32;
constexpr std::size_t kGroupedImportons = 1024;
constexpr std::size_t kImportonGroups = 64;

std::vector<float> receiver_distances(const std::vector<ReceiverPacket>& packets, Vec3 origin) {
    std::vector<float> distances;
    for (const ReceiverPacket& packet : packets) {
        for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            const auto [position, normal] = receiver_at(packet, lane);
            const float distance = length(position - origin);
            if (!is_zero(normal) && std::isfinite(distance)) {
                distances.push_back(distance);
            }
        }
    }
    std::sort(distances.begin(), distances.end());
    return distances;
}

/// Picks `wanted` importons at even distances in the array.
std::vector<Importon> some_of(std::span<const Importon> importons, std::size_t wanted) {
    const std::size_t count = std::min(importons.size(), wanted);
    std::vector<Importon> some;
    for (std::size_t i = 0; i < count; ++i) {
        some.push_back(importons[i * importons.size() / count]);
    }
    return some;
}

Importons upload(Device& device, std::span<const Importon> importons) {
    return {.importons = Buffer<Importon>(device, importons), .count = importons.size()};
}

Importons squared(Device& device, std::vector<Importon> importons) {
    for (Importon& importon : importons) {
        importon.response = importon.response * importon.response * (1.0f / kPi);
        importon.flags = NEARLIGHT_IMPORTON_SQUARED;
    }
    return upload(device, importons);
}

ImportonGroups grouped(Device& device, std::vector<Importon> importons) {
    ImportonGroups result;
    result.importon_count = importons.size();
    const std::vector<std::vector<Importon>> groups = group_importons(std::move(importons), kImportonGroups);
    for (const std::vector<Importon>& group : groups) {
        result.group_size = std::max(result.group_size, static_cast<uint>(group.size()));
    }
    std::vector<Importon> in_order;
    for (const std::vector<Importon>& group : groups) {
        in_order.insert(in_order.end(), group.begin(), group.end());
        in_order.resize(++result.group_count * result.group_size);  // without a normal, so none is reached
    }
    result.importons = Buffer<Importon>(device, std::span<const Importon>(in_order));
    return result;
}

}  // namespace

std::vector<Importon> make_importons(const std::vector<ReceiverPacket>& packets,
                                     const std::vector<CameraVertex>& vertices) {
    std::vector<Importon> importons;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto [position, normal] = receiver_at(packets, i);
        const Vec3 response = vertices[i].throughput * vertices[i].albedo;
        if (!is_zero(normal) && luminance(response) > 0.0f) {
            importons.push_back({.position = position,
                                 .pad0 = 0,
                                 .normal = normal,
                                 .flags = 0,
                                 .response = response,
                                 .pad1 = 0.0f});
        }
    }
    return importons;
}

void set_importons(Device& device, PilotView& view, std::span<const Importon> importons) {
    view.importons = upload(device, importons);
    view.few_squared_importons = squared(device, some_of(importons, kFewSquaredImportons));
    view.importon_groups = grouped(device, some_of(importons, kGroupedImportons));
}

const Importons& PilotView::importons_of(ContributionNorm norm) const {
    switch (norm) {
        case ContributionNorm::mean:
            return importons;
        case ContributionNorm::error_of_draw:
            return few_squared_importons;
    }
    return importons;
}

PilotView look_at_scene(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                        const SceneCamera& camera, uint seed) {
    const double aspect = static_cast<double>(camera.width) / camera.height;
    const int width = std::clamp(static_cast<int>(std::lround(std::sqrt(kPixelCount * aspect))), 8, 256);
    const int height = std::clamp(static_cast<int>(std::lround(width / aspect)), 8, 256);
    // Each pixel has the first of two samples, because a pixel's only sample would lie in its middle.
    SmallView small =
        look_at_few_pixels(device, camera_pass, scene, camera, width, height, {.samples_per_pixel = 2}, seed);
    PilotView view;
    view.device = &device;
    view.packet_count = static_cast<uint>(small.packet_count);
    view.receivers = std::move(small.receivers);
    const std::vector<ReceiverPacket> packets = view.receivers.download();
    view.distances = receiver_distances(packets, small.origin);
    set_importons(device, view, make_importons(packets, small.vertices.download()));
    return view;
}

}  // namespace nearlight::core
