// SPDX-License-Identifier: Apache-2.0
// The camera pass: receivers at the ends of camera paths, and the light that these paths bring on their own.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "kernels/shared/camera_pass.h"
#include "kernels/shared/packet_order.h"
#include "kernels/shared/shared_light.h"

namespace nearlight::core {

/// A batch: which tiles and samples of the picture one launch covers, and how its paths are followed. As many
/// columns of tiles as its width in pixels takes stand side by side, from the first one on.
struct CameraBatch {
    uint first_tile_column = 0;  ///< a multiple of bundle_columns x interleave, if that is above 1
    uint first_tile_row = 0;     ///< a multiple of bundle_rows x interleave, if that is above 1
    uint tile_row_count = 0;     ///< the last row may reach below the picture
    uint first_sample = 0;
    uint sample_count = 1;
    uint samples_per_pixel = 1;  ///< over all batches
    uint branch_count = 1;       ///< 2 if camera paths may divide, else 1
    uint bundle_columns = 1;     ///< tiles that stand together in the order of packets, side by side
    uint bundle_rows = 1;        ///< and one below the other
    uint bundle_samples = 1;     ///< consecutive samples that stand together; divides sample_count
    uint interleave = 1;         ///< distance of a tile's pixels (PacketOrder)
    uint max_depth = 8;          ///< maximum number of edges of a path from the camera to a light
    /// Samples of area lights and the environment at each surface that reflects other than by a Lambertian
    /// part; at least 1.
    uint light_samples = 1;
    /// Rays that each of these surfaces sends in search of such lights where the camera sees it straight or
    /// in mirrors and through glass; the first of them goes on as the path. At least 1.
    uint light_rays = 1;
    /// Rays of a receiver, if bundles share what these find of the sky with the first surfaces of the
    /// camera's paths too; 0: they do not.
    uint sky_rays = 0;
    /// Receivers of less weight than this are absent, and so are those behind mirrors or glass to which
    /// max_depth leaves at most two edges; rays of their own bring their light. 0: none are.
    float min_weight = 0.0f;
    /// Whether a pixel's only sample lies anywhere in the reach of its filter (GatherSettings), and not in
    /// the middle.
    bool spread_single_samples = false;
};

/// Whether the samples of a picture, or of one of its passes, go through the middles of their pixels. Only a
/// pixel's single sample does, unless it is to be spread.
constexpr bool are_in_middle(uint samples_per_pixel, bool spread_single_samples) {
    return samples_per_pixel == 1 && !spread_single_samples;
}

/// The order of the receiver packets of a batch that is `width` pixels wide.
PacketOrder packet_order(const CameraBatch& batch, uint width);
/// The number of receiver packets in a batch: tiles × samples × branches, with tiles filled up to whole
/// bundles.
std::size_t packet_count(const CameraBatch& batch, uint width);

/// Pixels to look at, by their numbers in a part of the picture, row by row.
struct ListedPixels {
    const Buffer<uint>& numbers;
    PixelList list;
};

/// The batch of a launch that looks at listed pixels: the places of a single row of tiles.
constexpr CameraBatch one_tile_row(CameraBatch batch) {
    batch.first_tile_column = batch.first_tile_row = 0;
    batch.tile_row_count = 1;
    batch.bundle_columns = batch.bundle_rows = batch.bundle_samples = batch.interleave = 1;
    return batch;
}

/// What the camera pass looks at. `camera` and `close_range` hold one element each.
struct CameraPassInput {
    const DeviceScene& scene;
    const Buffer<Camera>& camera;
    uint width;  ///< of the columns of tiles, in pixels
    const Buffer<CloseRange>& close_range;
    CameraBatch batch;
    uint seed = 0;
    const ListedPixels* only = nullptr;  ///< the pixels that take the places of the batch; null: its own
};

/// What the camera pass writes: packet_count() packets and 64 vertices for each of them, in the order that
/// kernels/shared/packet_order.h states. With batch.sky_rays, `seen` gets what SharedSky::add() must know of
/// the surfaces, one entry for each vertex.
struct CameraPassOutput {
    Buffer<ReceiverPacket>& receivers;
    Buffer<CameraVertex>& vertices;
    Buffer<SeenSurface>* seen = nullptr;
};

class CameraPass {
  public:
    explicit CameraPass(Device& device);

    void run(const CameraPassInput& input, const CameraPassOutput& output);

  private:
    Program program_;
    Kernel camera_pass_;
    Buffer<SeenSurface> none_seen_;
    Buffer<uint> none_listed_;
};

}  // namespace nearlight::core
