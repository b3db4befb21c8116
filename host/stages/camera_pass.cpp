// SPDX-License-Identifier: Apache-2.0
#include "host/stages/camera_pass.h"

#include "host/base/division.h"
#include "host/stages/joint_programs.h"

namespace nearlight::core {

PacketOrder packet_order(const CameraBatch& batch, uint width) {
    return {
        .tile_columns = round_up_to_multiple(tiles_across(width), batch.bundle_columns * batch.interleave),
        .sample_count = batch.sample_count,
        .branch_count = batch.branch_count,
        .bundle_columns = batch.bundle_columns,
        .bundle_rows = batch.bundle_rows,
        .bundle_samples = batch.bundle_samples,
        .interleave = batch.interleave};
}

std::size_t packet_count(const CameraBatch& batch, uint width) {
    return std::size_t{packet_order(batch, width).tile_columns} *
           round_up_to_multiple(batch.tile_row_count, batch.bundle_rows * batch.interleave) *
           batch.sample_count * batch.branch_count;
}

CameraPass::CameraPass(Device& device)
    : program_(device, "camera_pass.cl", kViewProgram),
      camera_pass_(program_, "camera_pass"),
      none_seen_(device, 0),
      none_listed_(device, 0) {}

void CameraPass::run(const CameraPassInput& input, const CameraPassOutput& output) {
    const CameraBatch& batch = input.batch;
    const std::size_t sample_packets = packet_count(batch, input.width) / batch.branch_count;
    const CameraPassParams params{
        .order = packet_order(batch, input.width),
        .first_tile_column = batch.first_tile_column,
        .first_tile_row = batch.first_tile_row,
        .tile_row_count = round_up_to_multiple(batch.tile_row_count, batch.bundle_rows * batch.interleave),
        .first_sample = batch.first_sample,
        .in_middle = are_in_middle(batch.samples_per_pixel, batch.spread_single_samples) ? 1u : 0u,
        .seed = input.seed,
        .limits = {.max_edges = batch.max_depth,
                   .light_samples = batch.light_samples,
                   .light_rays = batch.light_rays,
                   .min_weight = batch.min_weight,
                   .bundle_rays = batch.sky_rays * NEARLIGHT_SKY_RAYS},
        .list = input.only != nullptr ? input.only->list : PixelList{},
        .pad0 = 0};
    camera_pass_.launch_items(sample_packets * NEARLIGHT_PACKET_SIZE, input.scene, input.camera,
                              input.close_range, input.only != nullptr ? input.only->numbers : none_listed_,
                              params, output.receivers, output.vertices,
                              output.seen != nullptr ? *output.seen : none_seen_);
}

}  // namespace nearlight::core
