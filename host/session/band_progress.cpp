// SPDX-License-Identifier: Apache-2.0
#include "host/session/band_progress.h"

#include <algorithm>
#include <cmath>

#include "host/base/receivers.h"
#include "host/stages/small_view.h"

namespace nearlight::core {
namespace {

constexpr int kStripCount = 12;
constexpr int kMaxSmallWidth = 256;
/// The work of a pixel whose camera ray meets nothing, as a part of the work of a receiver.
constexpr double kRayWork = 0.05;

/// The pixel row of `cover` to which so many bands reach; the first and the last may have fewer tile rows.
double row_after(const RenderPlan& plan, double bands) {
    const double first = std::min(plan.tile_row_count, plan.tile_rows_in_first);
    const double whole = std::clamp(std::floor(bands), 0.0, std::max(0.0, plan.band_count() - 1.0));
    const auto tile_rows = [&](double band) {
        return band <= 0.0
                   ? 0.0
                   : std::min<double>(plan.tile_row_count, first + (band - 1.0) * plan.tile_rows_per_band);
    };
    const double begun = tile_rows(whole);
    return NEARLIGHT_TILE_SIZE * (begun + (bands - whole) * (tile_rows(whole + 1.0) - begun));
}

/// The work above a pixel row.
double work_above(const std::vector<double>& strips, uint height, double row) {
    const double at = std::clamp(row / height, 0.0, 1.0) * static_cast<double>(strips.size());
    double work = 0;
    for (std::size_t i = 0; i < strips.size(); ++i) {
        work += strips[i] * std::clamp(at - static_cast<double>(i), 0.0, 1.0);
    }
    return work;
}

}  // namespace

std::vector<double> work_of_strips(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                                   const SceneCamera& camera, const CameraBatch& batch, uint seed) {
    constexpr int kHeight = kStripCount * NEARLIGHT_TILE_SIZE;
    const int width =
        std::clamp(static_cast<int>(std::int64_t{kHeight} * camera.width / std::max(camera.height, 1)), 8,
                   kMaxSmallWidth);
    const SmallView small =
        look_at_few_pixels(device, camera_pass, scene, camera, width, kHeight, batch, seed);
    const std::vector<ReceiverPacket> found = small.receivers.download();
    std::vector<double> work(kStripCount, kRayWork * width * NEARLIGHT_TILE_SIZE);
    for (std::size_t i = 0; i < found.size(); ++i) {
        work[i * kStripCount / found.size()] += static_cast<double>(present_count(found[i]));
    }
    return work;
}

double part_of_work(const RenderPlan& plan, uint height, const std::vector<double>& strips,
                    double part_of_bands) {
    const double top = plan.cover.y;
    const double bands = plan.band_count();
    const double before = work_above(strips, height, top);
    const double all = work_above(strips, height, top + row_after(plan, bands)) - before;
    const double done = work_above(strips, height, top + row_after(plan, part_of_bands * bands)) - before;
    return all > 0.0 ? done / all : part_of_bands;
}

}  // namespace nearlight::core
