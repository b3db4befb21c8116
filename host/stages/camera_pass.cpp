// SPDX-License-Identifier: Apache-2.0
#include "host/stages/camera_pass.h"

#include "host/base/division.h"
#include "host/stages/joint_programs.h"

namespace nearlight::core {

PacketOrder packet_order(const CameraBand& band, uint width) {
    return {.tile_columns = round_up_to_multiple(tiles_across(width), band.bundle_columns * band.interleave),
            .sample_count = band.sample_count,
            .branch_count = band.branch_count,
            .bundle_columns = band.bundle_columns,
            .bundle_rows = band.bundle_rows,
            .bundle_samples = band.bundle_samples,
            .interleave = band.interleave};
}

std::size_t packet_count(const CameraBand& band, uint width) {
    return std::size_t{packet_order(band, width).tile_columns} *
           round_up_to_multiple(band.tile_row_count, band.bundle_rows * band.interleave) * band.sample_count *
           band.branch_count;
}

CameraPass::CameraPass(Device& device)
    : program_(device, "camera_pass.cl", kViewProgram),
      camera_pass_(program_, "camera_pass"),
      none_seen_(device, 0) {}

void CameraPass::run(const DeviceScene& scene, const Buffer<Camera>& camera, uint width,
                     const Buffer<CloseRange>& close_range, const CameraBand& band, uint seed,
                     Buffer<ReceiverPacket>& receivers, Buffer<CameraVertex>& vertices,
                     Buffer<SeenSurface>* seen) {
    const std::size_t sample_packets = packet_count(band, width) / band.branch_count;
    camera_pass_.launch_items(sample_packets * NEARLIGHT_PACKET_SIZE, scene, camera, close_range,
                              packet_order(band, width), band.first_tile_column, band.first_tile_row,
                              round_up_to_multiple(band.tile_row_count, band.bundle_rows * band.interleave),
                              band.first_sample, band.samples_per_pixel, band.max_depth, band.light_samples,
                              band.light_rays, band.min_weight, band.sky_rays * NEARLIGHT_SKY_RAYS, seed,
                              receivers, vertices, seen != nullptr ? *seen : none_seen_);
}

}  // namespace nearlight::core
