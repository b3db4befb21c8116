// SPDX-License-Identifier: Apache-2.0
#include "host/stages/small_view.h"

#include "host/scene/camera.h"

namespace nearlight::core {

SmallView look_at_few_pixels(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                             const SceneCamera& camera, int width, int height, CameraBatch batch, uint seed) {
    // A filter only decides how pixels share light, which does not matter to the receivers.
    SceneCamera unfiltered = camera;
    unfiltered.filter = {};
    const Camera small = make_camera(unfiltered, width, height);
    batch.tile_row_count = tiles_across(small.height);
    const std::size_t packets = packet_count(batch, small.width);
    SmallView view{.origin = small.origin,
                   .packet_count = packets,
                   .receivers = Buffer<ReceiverPacket>(device, packets),
                   .vertices = Buffer<CameraVertex>(device, packets * NEARLIGHT_PACKET_SIZE)};
    const Buffer<Camera> camera_buffer(device, std::span(&small, 1));
    const CloseRange nothing{};
    const Buffer<CloseRange> close_range(device, std::span(&nothing, 1));
    camera_pass.run({scene, camera_buffer, small.width, close_range, batch, seed},
                    {view.receivers, view.vertices});
    return view;
}

}  // namespace nearlight::core
