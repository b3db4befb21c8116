// SPDX-License-Identifier: Apache-2.0
#include "host/session/camera_refinement.h"

#include <algorithm>

#include "host/base/division.h"

namespace nearlight::core {
namespace {

/// The number of the first samples that are the first half, where each pixel has `times` times
/// `sample_count`.
uint first_half(uint sample_count, uint times) {
    return sample_count / 2 * times;
}

}  // namespace

CameraRefinement::CameraRefinement(Device& device, RefinementStages& stages, std::size_t max_pixels,
                                   std::size_t max_packets, uint sample_count)
    : device_(&device),
      stages_(&stages),
      max_packets_(max_packets),
      sample_count_(sample_count),
      lights_(device, max_pixels),
      added_(device, std::min(max_packets * NEARLIGHT_PACKET_SIZE,
                              round_up_to_multiple(max_pixels, NEARLIGHT_PACKET_SIZE))),
      rounds_(device, max_pixels),
      listed_(device, max_pixels) {}

void CameraRefinement::begin(const PixelWindow& pixels) {
    pixels_ = pixels;
    lights_.fill_zero();
}

void CameraRefinement::add(const CameraBatch& batch, const Buffer<CameraVertex>& vertices) {
    stages_->camera_lights.add(vertices, batch, pixels_.width, pixels_.height, first_half(sample_count_, 1),
                               lights_);
}

bool CameraRefinement::finish(CameraPass& camera_pass, const CameraPassInput& input,
                              const CameraPassOutput& output, Buffer<float>& sums,
                              const std::function<bool()>& goes_on) {
    const CameraLightBand band{pixels_.width, pixels_.height, sample_count_};
    stages_->camera_lights.choose(lights_, sums, band, rounds_);
    const std::size_t pixel_count = std::size_t{pixels_.width} * pixels_.height;
    for (uint times = 1;; times *= 2) {
        const std::size_t count = stages_->compaction.list_set(rounds_, pixel_count, listed_);
        if (count == 0) {
            return true;
        }
        const std::size_t tile_packets = std::size_t{sample_count_} * times * input.batch.branch_count;
        const std::size_t max_tiles = std::max<std::size_t>(max_packets_ / tile_packets, 1);
        for (std::size_t first = 0; first < count; first += max_tiles * NEARLIGHT_PACKET_SIZE) {
            const std::size_t some = std::min(max_tiles * NEARLIGHT_PACKET_SIZE, count - first);
            const PixelList list{.count = static_cast<uint>(some),
                                 .first = static_cast<uint>(first),
                                 .width = pixels_.width,
                                 .x = pixels_.x,
                                 .y = pixels_.y};
            if (!add_round(camera_pass, input, output, list, times, goes_on)) {
                return false;
            }
            stages_->camera_lights.refine(listed_, first, some, added_, 0.5f / static_cast<float>(times),
                                          lights_, sums, rounds_);
        }
    }
}

/// Adds up in `added_` one round of the listed pixels, which have `times` times the samples of all pixels and
/// get as many more. These pixels stand in one row of tiles, and their samples are launched in as many parts
/// as fit. Returns false if cancelled.
bool CameraRefinement::add_round(CameraPass& camera_pass, CameraPassInput input,
                                 const CameraPassOutput& output, const PixelList& list, uint times,
                                 const std::function<bool()>& goes_on) {
    const ListedPixels pixels{listed_, list};
    const uint tiles = divide_rounding_up(list.count, NEARLIGHT_PACKET_SIZE);
    const std::size_t sample_packets = std::size_t{tiles} * input.batch.branch_count;
    const auto max_samples = static_cast<uint>(std::max<std::size_t>(max_packets_ / sample_packets, 1));
    const uint before = sample_count_ * times;
    input.only = &pixels;
    input.width = tiles * NEARLIGHT_TILE_SIZE;
    input.batch = one_tile_row(input.batch);
    input.batch.min_weight = 0;  // further paths look for no light of receivers, however little these weigh
    added_.fill_zero();
    for (uint done = 0; done < before; done += input.batch.sample_count) {
        input.batch.first_sample = before + done;
        input.batch.sample_count = std::min(max_samples, before - done);
        camera_pass.run(input, output);
        stages_->camera_lights.add(output.vertices, input.batch, input.width, NEARLIGHT_TILE_SIZE,
                                   before + first_half(sample_count_, times), added_);
        device_->finish();
        if (!goes_on()) {
            return false;
        }
    }
    return true;
}

}  // namespace nearlight::core
