// SPDX-License-Identifier: Apache-2.0
// The G-buffer: where camera paths meet their first diffuse surface.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "kernels/shared/camera_pass.h"
#include "kernels/shared/packet_order.h"
#include "kernels/shared/shared_light.h"

namespace nearlight::core {

/// Which tiles and samples of the picture one launch covers. As many columns of tiles as its width in pixels
/// takes stand side by side, from the first one on.
struct CameraBand {
    uint first_tile_column = 0;  ///< a multiple of bundle_columns x interleave, if that is above 1
    uint first_tile_row = 0;     ///< a multiple of bundle_rows x interleave, if that is above 1
    uint tile_row_count = 0;     ///< the last row may reach below the picture
    uint first_sample = 0;
    uint sample_count = 1;
    uint samples_per_pixel = 1;  ///< over all batches; if it is 1, the sample goes through the pixel's centre
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
    /// Receivers of less weight than this are absent, and rays of their own bring their light; 0: none are.
    float min_weight = 0.0f;
};

/// The order of the receiver packets of a band of so many pixels' width.
PacketOrder packet_order(const CameraBand& band, uint width);
/// The number of receiver packets in a band: tiles × samples × branches, with tiles filled up to whole
/// bundles.
std::size_t packet_count(const CameraBand& band, uint width);

/// Pixels to look at, by their numbers in a part of the picture, row by row.
struct ListedPixels {
    const Buffer<uint>& numbers;
    PixelList list;
};

/// The band of a launch that looks at listed pixels: the places of a single row of tiles.
constexpr CameraBand one_tile_row(CameraBand band) {
    band.first_tile_column = band.first_tile_row = 0;
    band.tile_row_count = 1;
    band.bundle_columns = band.bundle_rows = band.bundle_samples = band.interleave = 1;
    return band;
}

/// What the camera pass looks at. `camera` and `close_range` hold one element each.
struct CameraPassInput {
    const DeviceScene& scene;
    const Buffer<Camera>& camera;
    uint width;  ///< of the columns of tiles, in pixels
    const Buffer<CloseRange>& close_range;
    CameraBand band;
    uint seed = 0;
    const ListedPixels* only = nullptr;  ///< the pixels that take the places of the band; null: its own
};

/// What the camera pass writes: packet_count() packets and 64 vertices for each of them, in the order that
/// kernels/shared/packet_order.h states. With band.sky_rays, `seen` gets what SharedSky::add() must know of
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
