// SPDX-License-Identifier: Apache-2.0
#include "host/session/camera_refinement.h"

#include <algorithm>

#include "host/base/division.h"

namespace nearlight::core {
namespace {

/// How many samples, from the first on, make the first half where each pixel has `times` times `sample_count`
/// of them.
uint first_half(uint sample_count, uint times) {
    return sample_count / 2 * times;
}

/// The maximum number of pixels to which one list of them brings light.
std::size_t max_added(const RefinementSize& size) {
    return std::min(size.max_packets * NEARLIGHT_PACKET_SIZE,
                    round_up_to_multiple(size.max_pixels, NEARLIGHT_PACKET_SIZE));
}

std::size_t splats_of_pixel(const RefinementSize& size) {
    return size.splat_reach > 0 ? splats_per_pixel(size.splat_reach) : 0;
}

}  // namespace

CameraRefinement::CameraRefinement(Device& device, RefinementStages& stages, Splats* splat_stage,
                                   const RefinementSize& size)
    : device_(&device),
      stages_(&stages),
      splat_stage_(splat_stage),
      size_(size),
      lights_(device, size.max_pixels),
      added_(device, max_added(size)),
      rounds_(device, size.max_pixels),
      listed_(device, size.max_pixels),
      splats_(device, size.max_pixels * splats_of_pixel(size)),
      added_splats_(device, max_added(size) * splats_of_pixel(size)) {}

void CameraRefinement::begin(const PixelWindow& pixels) {
    pixels_ = pixels;
    lights_.fill_zero();
    if (size_.splat_reach > 0) {
        splats_.fill_zero();
    }
}

void CameraRefinement::add(const CameraBatch& batch, const Buffer<Camera>& camera,
                           const Buffer<CameraVertex>& vertices) {
    const uint half_end = first_half(size_.sample_count, 1);
    stages_->camera_lights.add(vertices, batch, pixels_.width, pixels_.height, half_end, lights_);
    if (size_.splat_reach > 0) {
        splat_stage_->add_camera_light(vertices, camera, batch, {pixels_.width, pixels_.height, half_end},
                                       splats_);
    }
}

const Buffer<CameraSplat>* CameraRefinement::splats() const {
    return size_.splat_reach > 0 ? &splats_ : nullptr;
}

bool CameraRefinement::finish(CameraPass& camera_pass, const CameraPassInput& input,
                              const CameraPassOutput& output, Buffer<float>& sums,
                              const std::function<bool()>& goes_on) {
    const CameraLightBand band{pixels_.width, pixels_.height, size_.sample_count};
    stages_->camera_lights.choose(lights_, sums, band, rounds_);
    const std::size_t pixel_count = std::size_t{pixels_.width} * pixels_.height;
    for (uint times = 1;; times *= 2) {
        const std::size_t count = stages_->compaction.list_set(rounds_, pixel_count, listed_);
        if (count == 0) {
            return true;
        }
        const std::size_t tile_packets = std::size_t{size_.sample_count} * times * input.batch.branch_count;
        const std::size_t max_tiles = std::max<std::size_t>(size_.max_packets / tile_packets, 1);
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
            if (size_.splat_reach > 0) {
                splat_stage_->refine(listed_, first, some, size_.splat_reach, added_splats_,
                                     1.0f / static_cast<float>(times), splats_);
            }
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
    const auto max_samples = static_cast<uint>(std::max<std::size_t>(size_.max_packets / sample_packets, 1));
    const uint before = size_.sample_count * times;
    input.only = &pixels;
    input.width = tiles * NEARLIGHT_TILE_SIZE;
    input.batch = one_tile_row(input.batch);
    input.batch.min_weight = 0;  // further paths look for no light of receivers, however little these weigh
    added_.fill_zero();
    if (size_.splat_reach > 0) {
        added_splats_.fill_zero();
    }
    const uint half_end = before + first_half(size_.sample_count, times);
    for (uint done = 0; done < before; done += input.batch.sample_count) {
        input.batch.first_sample = before + done;
        input.batch.sample_count = std::min(max_samples, before - done);
        camera_pass.run(input, output);
        stages_->camera_lights.add(output.vertices, input.batch, input.width, NEARLIGHT_TILE_SIZE, half_end,
                                   added_);
        if (size_.splat_reach > 0) {
            splat_stage_->add_camera_light(output.vertices, input.camera, input.batch,
                                           {input.width, NEARLIGHT_TILE_SIZE, half_end}, added_splats_);
        }
        device_->finish();
        if (!goes_on()) {
            return false;
        }
    }
    return true;
}

}  // namespace nearlight::core
