// SPDX-License-Identifier: Apache-2.0
// Camera passes of tests over small scenes.
#pragma once

#include <vector>

#include "host/scene/camera.h"
#include "host/stages/camera_pass.h"
#include "host/stages/close_range.h"
#include "tests/support/scene_on_device.h"

namespace nearlight::core::test {

constexpr uint kManyEdges = 64;

struct GBuffer {
    std::vector<ReceiverPacket> receivers;
    std::vector<CameraVertex> vertices;
};

/// A camera pass over one scene and view.
class Shooting {
  public:
    Shooting(Device& device, const Scene& scene, int width, int height, float range = 1.0f)
        : camera(make_camera(scene.camera, width, height)),
          region(make_close_range(camera, range)),
          device_(&device),
          pass_(device),
          scene_(device, scene),
          cameras_(device, std::span(&camera, 1)),
          regions_(device, std::span(&region, 1)) {}

    GBuffer shoot(const CameraBatch& batch, uint seed = 1) {
        return shoot(batch, seed, nullptr, camera.width);
    }
    /// Looks at the pixels of a list, if there is one, from `width` places in a row.
    GBuffer shoot(const CameraBatch& batch, uint seed, const ListedPixels* only, uint width) {
        const std::size_t packets = packet_count(batch, width);
        Buffer<ReceiverPacket> receivers(*device_, packets);
        Buffer<CameraVertex> vertices(*device_, packets * NEARLIGHT_PACKET_SIZE);
        pass_.run({scene_.buffers, cameras_, width, regions_, batch, seed, only}, {receivers, vertices});
        return {receivers.download(), vertices.download()};
    }
    /// Renders all rows, with all `samples` samples.
    GBuffer shoot_all(uint samples, uint branches, uint seed = 1) {
        return shoot({.tile_row_count = tiles_across(camera.height),
                      .sample_count = samples,
                      .samples_per_pixel = samples,
                      .branch_count = branches,
                      .max_depth = kManyEdges},
                     seed);
    }

    Camera camera;
    CloseRange region;

  private:
    Device* device_;
    CameraPass pass_;
    SceneOnDevice scene_;
    Buffer<Camera> cameras_;
    Buffer<CloseRange> regions_;
};

}  // namespace nearlight::core::test
