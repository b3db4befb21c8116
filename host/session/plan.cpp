// SPDX-License-Identifier: Apache-2.0
#include "host/session/plan.h"

#include <algorithm>

#include "host/base/random.h"
#include "host/stages/splats.h"

namespace nearlight::core {
namespace {

/// The number of bands per device. With many bands, first rows appear soon, and devices wait for the last one
/// for only half a short band on average.
constexpr std::size_t kBandsPerDevice = 30;
/// A band on a single device has at least 1/kMinPart of a batch's receivers, which keeps the device busy.
/// Several devices may get smaller bands.
constexpr std::size_t kMinPart = 8;
constexpr uint kStrataStream = 0x57a7a5u;

/// The number of strata that the samples of one pixel ask, if all pixels of a square share them.
uint strata_of_pixel(uint strata, uint interleave) {
    return std::max(strata / (interleave * interleave), 1u);
}

/// The number of the stratum that is asked in turn `turn` of `turns`: in the first half of the turns the odd
/// ones, then the even ones. So both halves of a pixel's samples ask a half of the set that lies spread over
/// it, and how far apart their light lies tells the error of the whole set.
uint stratum_in_turn(uint turn, uint turns) {
    return turn < turns / 2 ? 2 * turn + 1 : 2 * (turn - turns / 2);
}

/// The number of a pixel in a square of `side` x `side` pixels, in the order of a Bayer matrix, which numbers
/// pixels that are far apart one after the other.
uint bayer_number(uint x, uint y, uint side) {
    uint number = 0;
    for (uint bit = 1; bit < side; bit *= 2) {
        number = 4 * number + ((x ^ y) & bit ? 2 : 0) + (y & bit ? 1 : 0);
    }
    return number;
}

/// The number of consecutive samples of a tile that share a bundle. Those of a tile go through the tree
/// faster together than those of several tiles, but only samples of one stratum can.
uint samples_per_bundle(const PictureSize& picture) {
    const uint strata = strata_of_pixel(picture.strata, picture.interleave);
    const uint run = strata == 1                               ? picture.samples_per_pixel
                     : picture.samples_per_pixel % strata == 0 ? picture.samples_per_pixel / strata
                                                               : 1;
    return run % 4 == 0 ? 4 : run % 2 == 0 ? 2 : 1;
}

/// Sets what a bundle holds: four samples of one tile, two of two tiles or one of four tiles.
void set_bundles(const PictureSize& picture, RenderPlan& plan) {
    plan.bundle_samples = samples_per_bundle(picture);
    const uint tiles = NEARLIGHT_BUNDLE_PACKETS / plan.bundle_samples;
    plan.bundle_columns = std::min(tiles, 2u);
    plan.bundle_rows = tiles / plan.bundle_columns;
}

/// The part of the picture that has all wanted pixels and begins and ends with bundles of the given size in
/// pixels, or with the picture.
PixelWindow covering_bundles(const PictureSize& picture, uint bundle_width, uint bundle_height) {
    const PixelWindow wanted = picture.window.value_or(PixelWindow{0, 0, picture.width, picture.height});
    const uint x = wanted.x / bundle_width * bundle_width;
    const uint y = wanted.y / bundle_height * bundle_height;
    const auto end = [](uint wanted_end, uint bundle, uint limit) {
        return std::min(round_up_to_multiple(wanted_end, bundle), limit);
    };
    return {x, y, end(wanted.x + wanted.width, bundle_width, picture.width) - x,
            end(wanted.y + wanted.height, bundle_height, picture.height) - y};
}

/// The rows of the bundles that fit whole into `rows`, but at least those of one bundle.
std::size_t round_down_to_bundles(std::size_t rows, uint bundle_rows) {
    return std::max<std::size_t>(rows / bundle_rows, 1) * bundle_rows;
}

}  // namespace

std::vector<CameraBatch> RenderPlan::batches(uint index) const {
    const uint first_row = index == 0 ? 0 : tile_rows_in_first + (index - 1) * tile_rows_per_band;
    const uint row_count = index == 0 ? tile_rows_in_first : tile_rows_per_band;
    std::vector<CameraBatch> result;
    for (uint sample = 0; sample < samples_per_pixel; sample += samples_per_batch) {
        result.push_back({.first_tile_column = cover.x / NEARLIGHT_TILE_SIZE,
                          .first_tile_row = cover.y / NEARLIGHT_TILE_SIZE + first_row,
                          .tile_row_count = std::min(row_count, tile_row_count - first_row),
                          .first_sample = sample,
                          .sample_count = std::min(samples_per_batch, samples_per_pixel - sample),
                          .samples_per_pixel = samples_per_pixel,
                          .branch_count = branch_count,
                          .bundle_columns = bundle_columns,
                          .bundle_rows = bundle_rows,
                          .bundle_samples = bundle_samples,
                          .interleave = interleave});
    }
    return result;
}

std::vector<uint> RenderPlan::strata_of_bundles(const CameraBatch& batch, uint seed) const {
    const uint first = Pcg32(seed, kStrataStream).next() % strata;
    const uint own_strata = strata_of_pixel(strata, interleave);
    const uint turns = std::min(own_strata, samples_per_pixel);
    const uint across = interleave > 1 ? tile_columns / bundle_columns : 1;
    std::vector<uint> result;
    for (uint i = 0; i < across * interleave; ++i) {
        const uint pixel = bayer_number(i % across % interleave, i / across, interleave);
        for (uint sample = 0; sample < batch.sample_count; sample += bundle_samples) {
            const std::uint64_t done = std::uint64_t{batch.first_sample} + sample;
            const auto turn = static_cast<uint>(done * turns / samples_per_pixel);
            const uint own = stratum_in_turn(turn, turns) * own_strata / turns;
            result.insert(result.end(), branch_count,
                          (first + pixel + own * interleave * interleave) % strata);
        }
    }
    return result;
}

std::size_t RenderPlan::max_packets() const {
    return packet_count({.tile_row_count = tile_rows_per_band,
                         .sample_count = samples_per_batch,
                         .branch_count = branch_count,
                         .bundle_columns = bundle_columns,
                         .bundle_rows = bundle_rows,
                         .bundle_samples = bundle_samples,
                         .interleave = interleave},
                        cover.width);
}

/// Little enough for memory and for a smooth progress bar.
std::size_t receivers_per_batch(const Device& device) {
    const std::size_t wanted = device.tunables().batch_receivers;
    // The largest buffers of a batch are those of the camera vertices and of the splats of pixels, each of
    // which has at least one receiver.
    const std::size_t of_receiver =
        std::max(2 * sizeof(CameraVertex), splats_per_pixel(NEARLIGHT_MAX_SPLAT_REACH) * sizeof(Splat));
    const std::size_t largest = device.entry().max_allocation_bytes / of_receiver;
    return std::min(wanted, std::max<std::size_t>(largest, NEARLIGHT_PACKET_SIZE));
}

RenderPlan make_plan(std::span<const std::size_t> batch_receivers, const PictureSize& picture) {
    const std::size_t budget = std::ranges::min(batch_receivers);
    RenderPlan plan;
    plan.samples_per_pixel = picture.samples_per_pixel;
    plan.branch_count = picture.branch_count;
    plan.strata = picture.strata;
    plan.interleave = picture.interleave;
    set_bundles(picture, plan);
    const uint columns = plan.bundle_columns * plan.interleave;
    const uint rows = plan.bundle_rows * plan.interleave;
    plan.cover = covering_bundles(picture, columns * NEARLIGHT_TILE_SIZE, rows * NEARLIGHT_TILE_SIZE);
    plan.tile_row_count = tiles_across(plan.cover.height);
    plan.tile_columns = round_up_to_multiple(tiles_across(plan.cover.width), columns);
    const std::size_t per_row_sample =
        std::size_t{plan.tile_columns} * NEARLIGHT_PACKET_SIZE * plan.branch_count;
    const std::size_t fitting = budget / (per_row_sample * rows) / plan.bundle_samples * plan.bundle_samples;
    plan.samples_per_batch =
        static_cast<uint>(std::clamp<std::size_t>(fitting, plan.bundle_samples, plan.samples_per_pixel));
    const std::size_t per_row = per_row_sample * plan.samples_per_batch;
    const std::size_t all_rows = std::max(round_up_to_multiple(plan.tile_row_count, rows), rows);
    const std::size_t max_rows = std::min(budget / per_row, all_rows);
    const std::size_t min_rows = batch_receivers.size() > 1 ? 1 : budget / kMinPart / per_row + 1;
    const std::size_t wanted_rows = plan.tile_row_count / (kBandsPerDevice * batch_receivers.size());
    plan.tile_rows_per_band =
        static_cast<uint>(round_down_to_bundles(std::min(std::max(wanted_rows, min_rows), max_rows), rows));
    plan.tile_rows_in_first = static_cast<uint>(
        std::min<std::size_t>(round_down_to_bundles(min_rows, rows), plan.tile_rows_per_band));
    return plan;
}

}  // namespace nearlight::core
