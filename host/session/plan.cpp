// SPDX-License-Identifier: Apache-2.0
#include "host/session/plan.h"

#include <algorithm>
#include <limits>

namespace nearlight::core {
namespace {

/// The number of bands per device. With many bands, first rows appear soon, and devices wait for the last one
/// for only half a short band on average.
constexpr std::size_t kBandsPerDevice = 30;
/// A band on a single device has at least 1/kMinPart of a batch's receivers, which keeps the device busy.
/// Several devices may get smaller bands.
constexpr std::size_t kMinPart = 8;

/// The number of receivers per batch: enough work to keep the device busy, but little enough for memory and
/// for a smooth progress bar.
std::size_t receivers_per_batch(const Device& device) {
    const std::size_t wanted = device.tunables().batch_receivers;
    // The largest buffer of a batch is that of the camera vertices.
    const std::size_t largest = device.entry().max_allocation_bytes / (2 * sizeof(CameraVertex));
    return std::min(wanted, std::max<std::size_t>(largest, NEARLIGHT_PACKET_SIZE));
}

/// The number of samples of a tile that fill a bundle, or all samples if they do not. The samples in a batch
/// are a multiple of it.
uint samples_per_bundle(uint samples_per_pixel, uint branch_count) {
    return std::min(samples_per_pixel, NEARLIGHT_BUNDLE_PACKETS / branch_count);
}

}  // namespace

std::vector<CameraBand> RenderPlan::batches(uint index) const {
    const uint first_row = index == 0 ? 0 : tile_rows_in_first + (index - 1) * tile_rows_per_band;
    const uint row_count = index == 0 ? tile_rows_in_first : tile_rows_per_band;
    std::vector<CameraBand> result;
    for (uint sample = 0; sample < samples_per_pixel; sample += samples_per_batch) {
        result.push_back({.first_tile_row = first_row,
                          .tile_row_count = std::min(row_count, tile_row_count - first_row),
                          .first_sample = sample,
                          .sample_count = std::min(samples_per_batch, samples_per_pixel - sample),
                          .samples_per_pixel = samples_per_pixel,
                          .branch_count = branch_count});
    }
    return result;
}

uint RenderPlan::run_packets(const CameraBand& batch, uint width) const {
    const uint tile_packets = batch.sample_count * branch_count;
    return samples_per_pixel * branch_count < NEARLIGHT_BUNDLE_PACKETS ? tile_packets * tiles_across(width)
                                                                       : tile_packets;
}

std::size_t RenderPlan::max_packets(uint width) const {
    return packet_count({.tile_row_count = tile_rows_per_band,
                         .sample_count = samples_per_batch,
                         .branch_count = branch_count},
                        width);
}

RenderPlan make_plan(std::span<const Device* const> devices, uint width, uint height, uint samples_per_pixel,
                     uint branch_count) {
    std::size_t budget = std::numeric_limits<std::size_t>::max();
    for (const Device* device : devices) {
        budget = std::min(budget, receivers_per_batch(*device));
    }
    const std::size_t per_row_sample =
        std::size_t{tiles_across(width)} * NEARLIGHT_PACKET_SIZE * branch_count;
    RenderPlan plan;
    plan.tile_row_count = tiles_across(height);
    plan.samples_per_pixel = samples_per_pixel;
    plan.branch_count = branch_count;
    const uint bundled = samples_per_bundle(samples_per_pixel, branch_count);
    const std::size_t fitting = std::max<std::size_t>(budget / per_row_sample / bundled, 1) * bundled;
    plan.samples_per_batch = static_cast<uint>(std::min<std::size_t>(fitting, samples_per_pixel));
    plan.tile_rows_per_band = static_cast<uint>(std::clamp<std::size_t>(
        budget / (per_row_sample * plan.samples_per_batch), 1, std::max(plan.tile_row_count, 1u)));
    const std::size_t min_rows =
        devices.size() > 1 ? 1 : budget / kMinPart / (per_row_sample * plan.samples_per_batch) + 1;
    const std::size_t wanted_rows = plan.tile_row_count / (kBandsPerDevice * devices.size());
    plan.tile_rows_per_band =
        static_cast<uint>(std::min<std::size_t>(std::max(wanted_rows, min_rows), plan.tile_rows_per_band));
    plan.tile_rows_in_first = static_cast<uint>(std::min<std::size_t>(min_rows, plan.tile_rows_per_band));
    return plan;
}

}  // namespace nearlight::core
