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
      none_seen_(device, 0),
      none_listed_(device, 0) {}

void CameraPass::run(const CameraPassInput& input, const CameraPassOutput& output) {
    const CameraBand& band = input.band;
    const std::size_t sample_packets = packet_count(band, input.width) / band.branch_count;
    const CameraPassParams params{
        .order = packet_order(band, input.width),
        .first_tile_column = band.first_tile_column,
        .first_tile_row = band.first_tile_row,
        .tile_row_count = round_up_to_multiple(band.tile_row_count, band.bundle_rows * band.interleave),
        .first_sample = band.first_sample,
        .sequence_length = band.samples_per_pixel,
        .seed = input.seed,
        .limits = {.max_edges = band.max_depth,
                   .light_samples = band.light_samples,
                   .light_rays = band.light_rays,
                   .min_weight = band.min_weight,
                   .bundle_rays = band.sky_rays * NEARLIGHT_SKY_RAYS},
        .list = input.only != nullptr ? input.only->list : PixelList{},
        .pad0 = 0};
    camera_pass_.launch_items(sample_packets * NEARLIGHT_PACKET_SIZE, input.scene, input.camera,
                              input.close_range, input.only != nullptr ? input.only->numbers : none_listed_,
                              params, output.receivers, output.vertices,
                              output.seen != nullptr ? *output.seen : none_seen_);
}

}  // namespace nearlight::core
