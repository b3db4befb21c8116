// SPDX-License-Identifier: Apache-2.0
// How a session makes a picture on its own and on remote devices.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

#include "host/session/band_progress.h"
#include "host/session/picture_window.h"
#include "host/session/receiver_weight.h"
#include "host/session/session.h"
#include "host/session/sky_part.h"
#include "host/session/splat_rows.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

/// The maximum bytes of finished bands that wait for an earlier one.
constexpr std::size_t kMaxWaitingBytes = std::size_t{256} << 20u;

/// How many finished bands may wait for an earlier one.
uint max_waiting_bands(const RenderPlan& plan, std::size_t device_count, uint reach) {
    const std::size_t band_bytes = std::size_t{plan.cover.width} * plan.tile_rows_per_band *
                                   NEARLIGHT_TILE_SIZE * band_floats_per_pixel(reach) * sizeof(float);
    return static_cast<uint>(std::max<std::size_t>(2 * device_count, kMaxWaitingBytes / band_bytes));
}

BandMaker band_maker(PoolDevice& device, const PictureTask& picture, const VplBuffer& vpls) {
    auto bands = std::make_shared<BandRenderer>(device.bands, device.scene, picture, vpls);
    return [bands](uint index, const WorkProgress& progress) { return bands->render(index, progress); };
}

std::vector<BandWorker> band_workers(const DevicePool& pool, const PictureTask& picture,
                                     const VplBuffer& vpls) {
    std::vector<BandWorker> workers;
    for (const auto& device : pool.devices()) {
        workers.push_back({.name = device->device().entry().label(), .start = [&, device = device.get()] {
                               return band_maker(*device, picture, vpls);
                           }});
    }
    return workers;
}

/// The part of the picture with samples that count in the window.
PixelWindow with_border(const PixelWindow& window, const Camera& camera) {
    const uint reach = camera.splat_reach;
    const uint x = window.x - std::min(window.x, reach);
    const uint y = window.y - std::min(window.y, reach);
    return {x, y, std::min(window.x + window.width + reach, camera.width) - x,
            std::min(window.y + window.height + reach, camera.height) - y};
}

/// Replaces the colours of all layers of light by their luminance, and their variances s² by its variance.
/// With the weights w of the luminance, this lies between Σ w²s², where the noise of the channels is
/// independent, and (Σ ws)², where the channels rise and fall together. The latter is taken: it is an upper
/// bound, and most noise of VPLs and of paths is in how much light arrives, which the channels share.
void make_monochrome(std::span<float> rows) {
    for (std::size_t pixel = 0; pixel < rows.size(); pixel += NEARLIGHT_LAYER_CHANNELS) {
        for (const std::size_t layer :
             {NEARLIGHT_LAYER_BEAUTY, NEARLIGHT_LAYER_DIRECT, NEARLIGHT_LAYER_INDIRECT}) {
            float* const rgb = rows.data() + pixel + layer;
            std::fill_n(rgb, NEARLIGHT_CHANNELS_RGB, luminance({rgb[0], rgb[1], rgb[2]}));
        }
        float* const variance = rows.data() + pixel + NEARLIGHT_LAYER_VARIANCE;
        const float noise =
            luminance({std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2])});
        std::fill_n(variance, NEARLIGHT_CHANNELS_RGB, noise * noise);
    }
}

/// The work of a picture's strips, by which its progress goes, unless it is made too soon for that to matter.
std::vector<double> work_of(DevicePool& pool, const PictureTask& picture, const View& view) {
    constexpr double kFewSamples = 1e6;
    const PixelWindow& cover = picture.plan.cover;
    if (1.0 * cover.width * cover.height * picture.plan.samples_per_pixel < kFewSamples) {
        return {1.0};
    }
    return pool.on_leader([&](PoolDevice& leader) {
        return work_of_strips(
            leader.device(), leader.bands.camera_pass, leader.scene, view.scene_camera,
            {.branch_count = picture.plan.branch_count, .min_weight = min_receiver_weight(picture.settings)},
            picture.seed);
    });
}

/// Deletes a picture, and has remote devices end work on it if they were shown it.
struct PictureEnd {
    std::function<void(PictureNumber)> end;

    void operator()(PlannedPicture* planned) const noexcept {
        try {
            if (planned->shown) {
                end(*planned->shown);
            }
        } catch (...) {
            // Memory for the message is lacking. Who does not hear of the end only keeps the picture for
            // longer.
        }
        delete planned;
    }
};

}  // namespace

std::shared_ptr<PlannedPicture> Session::plan(const View& view, const VplSet& vpls,
                                              const GatherSettings& settings, uint seed) {
    if (vpls.asked_count > 0 && settings.roulette > 0.0f) {
        throw Error(ErrorKind::invalid_argument,
                    "these VPLs are asked by cuts, which leave nothing to Russian roulette", "roulette");
    }
    const PixelWindow window = window_of(view, settings);
    Camera camera = view.camera;
    camera.splat_reach = splat_reach(view.scene_camera.filter, settings);
    std::vector<RemoteDevice> devices = own_devices();
    devices.insert(devices.end(), remote_.devices.begin(), remote_.devices.end());
    std::vector<std::size_t> batch_receivers;
    std::ranges::transform(devices, std::back_inserter(batch_receivers), &RemoteDevice::batch_receivers);
    const RenderPlan plan =
        make_plan(batch_receivers, {.width = view.camera.width,
                                    .height = view.camera.height,
                                    .samples_per_pixel = settings.samples_per_pixel,
                                    .branch_count = pool_.leader().scene.divides_paths ? 2u : 1u,
                                    .strata = settings.strata_or_auto(),
                                    .interleave = settings.interleave,
                                    .window = with_border(window, camera)});
    const PictureTask picture{.camera = camera,
                              .close_range = view.close_range,
                              .max_depth = view.max_depth,
                              .settings = settings,
                              .budget = budget_of(view, vpls, settings),
                              .seed = seed,
                              .plan = plan,
                              .asked_count = vpls.asked_count,
                              .local = vpls.local,
                              .shares_sky = view.sky_part > 0 && view.sky_part <= kMaxSharedSkyPart};
    if (remote_.devices.empty()) {
        return std::make_shared<PlannedPicture>(PlannedPicture{.task = picture, .window = window});
    }
    // It is made before it is shown, so that nothing that is shown lacks an end.
    PictureEnd end{remote_.end};
    const std::shared_ptr<PlannedPicture> planned(new PlannedPicture{.task = picture, .window = window},
                                                  std::move(end));
    planned->shown = remote_.show(picture, vpls.vpls.on_host());
    return planned;
}

GatherOutcome Session::gather(const View& view, const VplSet& vpls, const GatherSettings& settings, uint seed,
                              const RowSink& sink, const WorkProgress& progress,
                              const PictureSequence& order) {
    const std::shared_ptr<PlannedPicture> planned =
        order.present ? order.present : plan(view, vpls, settings, seed);
    const RenderPlan& plan = planned->task.plan;
    const uint reach = planned->task.camera.splat_reach;
    SplatRows splats(plan.cover.width, reach, plan.samples_per_pixel);
    WindowCut window_cut(plan.cover, planned->window);
    GatherOutcome outcome;
    const auto send = [&](std::span<float> rows) {
        if (view.scene_camera.is_monochrome) {
            make_monochrome(rows);
        }
        if (const std::span<const float> wanted = window_cut.cut(rows); !wanted.empty()) {
            sink(wanted);
        }
    };
    const auto take_band = [&](FinishedBand& band) {
        outcome.local_lights += band.local_lights;
        splats.take(band.rows);
        send(band.rows);
    };
    const std::vector<double> strips = work_of(pool_, planned->task, view);
    std::vector<BandWorker> workers = band_workers(pool_, planned->task, vpls.vpls);
    NextPicture next;
    if (order.next) {
        next.prepare_by(workers.front(), order.next);
    }
    add_remote_workers(remote_, *planned, next, workers);
    BandOutcome shared = share_bands(
        plan.band_count(), max_waiting_bands(plan, workers.size(), reach), workers, take_band,
        [&](double fraction) { return progress(part_of_work(plan, view.camera.height, strips, fraction)); });
    if (!shared.interrupted) {
        std::vector<float> last = splats.finish();
        send(last);
    }
    drop_failed(shared.shares);
    outcome.shares = std::move(shared.shares);
    outcome.interrupted = shared.interrupted;
    return outcome;
}

void Session::drop_failed(std::span<const BandShare> shares) {
    const std::size_t own = pool_.size();
    for (std::size_t i = shares.size(); i-- > own;) {
        if (shares[i].failed) {
            remote_.devices.erase(remote_.devices.begin() + static_cast<std::ptrdiff_t>(i - own));
        }
    }
    pool_.drop_failed(shares.first(own));
}

std::vector<RemoteDevice> Session::own_devices() const {
    std::vector<RemoteDevice> result;
    for (const auto& device : pool_.devices()) {
        result.push_back({.number = result.size(),
                          .name = device->device().entry().label(),
                          .batch_receivers = receivers_per_batch(device->device())});
    }
    return result;
}

BandMaker Session::helper(std::size_t number, const PictureTask& picture, const VplBuffer& vpls) const {
    return band_maker(*pool_.devices()[number], picture, vpls);
}

}  // namespace nearlight::core
