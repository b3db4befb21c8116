// SPDX-License-Identifier: Apache-2.0
#include "host/cli/memory_estimate.h"

#include <span>

#include "host/cl/devices/tunables.h"
#include "host/session/plan.h"
#include "host/session/scene_memory.h"
#include "host/session/splat_rows.h"
#include "host/stages/splats.h"
#include "kernels/shared/camera_pass.h"
#include "kernels/shared/film_layers.h"
#include "kernels/shared/shared_light.h"

namespace nearlight::core {
namespace {

/// The bytes of a receiver: where it lies, the surface that the camera sees there, its light of three kinds,
/// and what its rays find nearby.
constexpr std::uint64_t kReceiverBytes =
    (sizeof(ReceiverPacket) + 3 * sizeof(IrradiancePacket)) / NEARLIGHT_PACKET_SIZE + sizeof(CameraVertex) +
    sizeof(SharedLight);

/// The bytes of a pixel: its sums and layers, the further camera paths that it may get, and its splats: those
/// of samples, their sums over rows, and those of the light that camera paths bring on their own, which are
/// there twice.
std::uint64_t pixel_bytes(const SceneCamera& camera) {
    constexpr std::uint64_t kLayers = (NEARLIGHT_FILM_CHANNELS + NEARLIGHT_LAYER_CHANNELS) * sizeof(float);
    constexpr std::uint64_t kRefinement = 2 * (sizeof(CameraLight) + sizeof(uint));
    const uint reach = splat_reach(camera.filter, {});
    const std::uint64_t splats = reach == 0
                                     ? 0
                                     : splats_per_pixel(reach) * (sizeof(Splat) + 2 * sizeof(CameraSplat)) +
                                           splat_rows(reach) * sizeof(RowSplat);
    return kLayers + kRefinement + splats;
}

/// What a band of the picture takes on a device, with the default settings and camera paths that divide.
std::uint64_t band_bytes(const SceneCamera& camera) {
    const GatherSettings settings;
    const std::size_t batch_receivers = tunables_row(DeviceKind::cpu).values.batch_receivers;
    const RenderPlan plan =
        make_plan(std::span(&batch_receivers, 1), {.width = static_cast<uint>(camera.width),
                                                   .height = static_cast<uint>(camera.height),
                                                   .samples_per_pixel = settings.samples_per_pixel,
                                                   .branch_count = 2,
                                                   .strata = settings.strata_or_auto()});
    const std::uint64_t pixels =
        std::uint64_t{plan.cover.width} * plan.tile_rows_per_band * NEARLIGHT_TILE_SIZE;
    return plan.max_packets() * NEARLIGHT_PACKET_SIZE * kReceiverBytes + pixels * pixel_bytes(camera);
}

}  // namespace

MemoryEstimate estimate_memory(const Scene& scene) {
    const SceneMemory memory = estimate_scene_memory(scene);
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(scene.camera.width) * static_cast<std::uint64_t>(scene.camera.height);
    MemoryEstimate estimate;
    estimate.host = {{"geometry", memory.geometry},
                     {"trees", memory.trees},
                     {"textures", memory.textures},
                     {"environment", memory.environment_on_host},
                     {"picture", pixels * NEARLIGHT_LAYER_CHANNELS * sizeof(float)}};
    estimate.device = {{"geometry", memory.geometry},
                       {"trees", memory.trees},
                       {"textures", memory.textures},
                       {"environment", memory.environment_on_device},
                       {"picture", band_bytes(scene.camera)}};
    return estimate;
}

}  // namespace nearlight::core
