// SPDX-License-Identifier: Apache-2.0
#include "host/session/band_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/base/division.h"
#include "host/session/receiver_weight.h"
#include "host/session/splat_rows.h"

namespace nearlight::core {
namespace {

/// The part of `per_pixel` that each camera sample takes, at least 1.
uint per_sample(uint per_pixel, const GatherSettings& settings) {
    return std::max(1u, divide_rounding_up(per_pixel, settings.samples_per_pixel));
}

/// Whether bundles share what the rays of their receivers find.
bool shares_lights(const PictureTask& picture) {
    return picture.settings.compensate && std::isfinite(picture.budget.clamp_radius);
}

ReceiverPathSettings path_settings(const DeviceScene& scene, const PictureTask& picture) {
    const GatherSettings& settings = picture.settings;
    const uint rays = per_sample(settings.rays_per_pixel, settings);
    return {.light_samples = per_sample(picture.budget.direct_samples_per_pixel, settings),
            .rays = settings.compensate ? rays : 0,
            .aimed_rays = picture.budget.aimed_rays,
            .max_edges = std::max(picture.max_depth, 1u) - 1,
            .clamp_radius = picture.budget.clamp_radius,
            .seed = picture.seed,
            .shared_limit = picture.budget.shared_limit,
            .shares_sky = shares_lights(picture) && picture.shares_sky && scene.has_sky(),
            .shares_veiled = shares_lights(picture) && scene.has_veils(),
            .shares_reflections = shares_lights(picture) && scene.has_rough_gloss};
}

/// A batch of the plan with all else that the camera pass needs: the plan knows only how samples are divided.
CameraBatch with_light(CameraBatch batch, const PictureTask& picture, const ReceiverPathSettings& paths) {
    batch.spread_single_samples = picture.settings.spread_single_samples;
    batch.max_depth = picture.max_depth;
    batch.min_weight = min_receiver_weight(picture.settings);
    batch.light_samples = per_sample(picture.budget.direct_samples_per_pixel, picture.settings);
    batch.light_rays = per_sample(picture.settings.rays_per_pixel, picture.settings);
    batch.sky_rays = paths.shares_sky ? paths.rays : 0;
    return batch;
}

std::size_t pixels_per_band(const PictureTask& picture) {
    return static_cast<std::size_t>(picture.plan.cover.width) * picture.plan.tile_rows_per_band *
           NEARLIGHT_TILE_SIZE;
}

}  // namespace

BandRenderer::BatchBuffers::BatchBuffers(Device& device, std::size_t packets, std::size_t pixels,
                                         const ReceiverPathSettings& paths, uint reach)
    : receivers(device, packets),
      vertices(device, packets * NEARLIGHT_PACKET_SIZE),
      seen(device, paths.shares_sky ? packets * NEARLIGHT_PACKET_SIZE : 0),
      direct(device, packets),
      indirect(device, packets),
      found(device, packets, paths),
      gathered(device, packets),
      sums(device, pixels * NEARLIGHT_FILM_CHANNELS),
      layers(device, pixels * NEARLIGHT_LAYER_CHANNELS),
      splats(device, reach > 0 ? pixels * splats_per_pixel(reach) : 0),
      row_splats(device, reach > 0 ? pixels * splat_rows(reach) : 0) {}

void BandStages::expect(const DeviceScene& scene) {
    if (scene.has_sky()) {
        shared_sky.emplace(device);
    }
    if (scene.has_veils()) {
        shared_veiled.emplace(device);
    }
    if (scene.has_rough_gloss) {
        shared_reflections.emplace(device);
    }
}

BandRenderer::BandRenderer(BandStages& stages, const DeviceScene& scene, const PictureTask& picture,
                           const VplBuffer& vpls)
    : stages_(stages),
      scene_(scene),
      picture_(picture),
      given_vpls_(vpls),
      camera_(stages.device, std::span(&picture.camera, 1)),
      close_range_(stages.device, std::span(&picture.close_range, 1)),
      own_vpls_(vpls.is_on(stages.device) ? VplBuffer() : vpls.copy_to(stages.device)),
      paths_(path_settings(scene, picture)),
      buffers_(stages.device, picture.plan.max_packets(), pixels_per_band(picture), paths_,
               picture.camera.splat_reach) {
    if (reach() > 0 && !stages.splats) {
        stages.splats.emplace(stages.device);
    }
    if (picture.local) {
        if (!stages.local_gather) {
            stages.local_gather.emplace(stages.device);
        }
        stages.local_gather->set_vpls(scene, this->vpls(), *picture.local);
    }
    if (picture.asked_count > 0) {
        if (!stages.light_cuts) {
            stages.light_cuts.emplace(stages.device);
        }
        cut_tree_ = stages.light_cuts->make_tree(this->vpls().buffer(), this->vpls().count());
    }
    if (may_refine(picture.settings)) {
        if (!stages.refinement) {
            stages.refinement.emplace(stages.device);
        }
        refinement_.emplace(stages.device, *stages.refinement, stages.splats ? &*stages.splats : nullptr,
                            RefinementSize{.max_pixels = pixels_per_band(picture),
                                           .max_packets = picture.plan.max_packets(),
                                           .sample_count = picture.settings.samples_per_pixel,
                                           .splat_reach = reach()});
    }
}

const VplBuffer& BandRenderer::vpls() const {
    return given_vpls_.is_on(stages_.device) ? given_vpls_ : own_vpls_;
}

/// Selects VPLs by cuts if there are more than a pixel asks about, or else by Russian roulette if the
/// settings ask for it. Returns nothing otherwise: every bundle then asks about all VPLs of its stratum.
std::optional<VplSelection> BandRenderer::select_vpls(std::size_t packets, const VplStrata& strata) {
    if (cut_tree_) {
        return stages_.light_cuts->select({.vpls = vpls().buffer(),
                                           .tree = *cut_tree_,
                                           .receivers = buffers_.receivers,
                                           .packet_count = packets,
                                           .strata = strata,
                                           .clamp_radius = picture_.budget.clamp_radius,
                                           .asked_count = picture_.asked_count,
                                           .seed = picture_.seed});
    }
    if (!(picture_.settings.roulette > 0.0f)) {
        return std::nullopt;
    }
    if (!stages_.roulette) {
        stages_.roulette.emplace(stages_.device);
    }
    return stages_.roulette->select({.vpls = vpls().buffer(),
                                     .vpl_count = vpls().count(),
                                     .receivers = buffers_.receivers,
                                     .packet_count = packets,
                                     .strata = &strata,
                                     .clamp_radius = picture_.budget.clamp_radius,
                                     .threshold = picture_.settings.roulette,
                                     .seed = picture_.seed});
}

/// Gathers the light of VPLs for a batch's receivers. Returns false if cancelled.
bool BandRenderer::gather_vpls(const CameraBatch& batch, const GatherProgress& progress) {
    const uint width = picture_.plan.cover.width;
    const std::size_t packets = packet_count(batch, width);
    const VplStrata strata(stages_.device, picture_.plan.strata,
                           picture_.plan.strata_of_bundles(batch, picture_.seed));
    if (picture_.local) {
        return stages_.local_gather->run(stages_.gatherer, scene_, buffers_.receivers, packets, strata,
                                         buffers_.gathered, progress);
    }
    const std::optional<VplSelection> selection = select_vpls(packets, strata);
    return stages_.gatherer.gather({.tree = scene_.tree,
                                    .vpls = vpls().buffer(),
                                    .vpl_count = vpls().count(),
                                    .receivers = buffers_.receivers,
                                    .packet_count = packets,
                                    .clamp_radius = picture_.budget.clamp_radius,
                                    .strata = cut_tree_ ? nullptr : &strata,
                                    .selection = selection ? &*selection : nullptr,
                                    .curves = scene_.curves_in_use(),
                                    .has_maps = scene_.has_maps()},
                                   buffers_.gathered, progress);
}

/// Finds the direct light of a batch's receivers and what their rays bring, and lets each bundle share what
/// these rays find.
void BandRenderer::trace_sharing_receivers(std::size_t packets) {
    const ReceiverBatch batch{scene_, buffers_.receivers, packets, paths_};
    const FoundLights& found = buffers_.found;
    SharedLightLists& lists = stages_.shared_light_lists;
    stages_.receiver_paths.run_sharing(batch, buffers_.direct, buffers_.indirect, buffers_.found);
    stages_.shared_lights.add(batch, lists, found.near, buffers_.indirect);
    if (paths_.shares_reflections) {
        stages_.shared_reflections->add(batch, lists, found, buffers_.indirect);
    }
    if (paths_.shares_veiled) {
        stages_.shared_veiled->add(batch, lists, found.veiled, buffers_.indirect);
    }
    if (paths_.shares_sky) {
        stages_.shared_sky->add(batch, lists, found.sky,
                                {.surfaces = buffers_.seen,
                                 .vertices = buffers_.vertices,
                                 .rays = per_sample(picture_.settings.rays_per_pixel, picture_.settings)},
                                buffers_.direct);
    }
}

/// Finds the direct light of a batch's receivers and what their rays bring. Both are 0 as far as the settings
/// leave them out.
void BandRenderer::trace_receivers(std::size_t packets) {
    if (picture_.settings.indirect_only && !picture_.settings.compensate) {
        buffers_.direct.fill_zero();
        buffers_.indirect.fill_zero();
        return;
    }
    if (shares_lights(picture_)) {
        trace_sharing_receivers(packets);
    } else {
        stages_.receiver_paths.run({scene_, buffers_.receivers, packets, paths_}, buffers_.direct,
                                   buffers_.indirect);
    }
    if (picture_.settings.indirect_only) {
        buffers_.direct.fill_zero();
    }
}

CameraPassInput BandRenderer::camera_input(const CameraBatch& batch) const {
    return {scene_, camera_, picture_.plan.cover.width, close_range_, batch, picture_.seed};
}

CameraPassOutput BandRenderer::camera_output() {
    return {buffers_.receivers, buffers_.vertices, &buffers_.seen};
}

/// Renders one batch: receivers, direct light, indirect light, film. Returns false if cancelled.
bool BandRenderer::add_batch(const CameraBatch& batch, uint row_count, const GatherProgress& progress) {
    const uint width = picture_.plan.cover.width;
    const std::size_t packets = packet_count(batch, width);
    stages_.camera_pass.run(camera_input(batch), camera_output());
    if (refinement_) {
        refinement_->add(batch, camera_, buffers_.vertices);
    }
    trace_receivers(packets);
    const bool finished = gather_vpls(batch, progress);
    if (finished) {
        add_to_film(batch, row_count);
    }
    return finished;
}

SplatPixels BandRenderer::splat_pixels(uint row_count) const {
    return {.width = picture_.plan.cover.width,
            .row_count = row_count,
            .half_end = picture_.settings.samples_per_pixel / 2};
}

void BandRenderer::add_to_film(const CameraBatch& batch, uint row_count) {
    const ReceivedIrradiance light{
        .direct = buffers_.direct, .gathered = buffers_.gathered.light, .indirect = buffers_.indirect};
    stages_.film.add(buffers_.receivers, buffers_.vertices, light, batch, picture_.plan.cover.width,
                     row_count, buffers_.sums);
    if (reach() > 0) {
        stages_.splats->add(buffers_.vertices, light, camera_, batch, splat_pixels(row_count), !refinement_,
                            buffers_.splats);
    }
}

/// Gives pixels of the band of `batch` more camera paths where they need them. Returns false if cancelled.
bool BandRenderer::refine(const CameraBatch& batch, const WorkProgress& progress) {
    return !refinement_ ||
           refinement_->finish(stages_.camera_pass, camera_input(with_light(batch, picture_, paths_)),
                               camera_output(), buffers_.sums, [&] { return progress(1.0); });
}

std::optional<FinishedBand> BandRenderer::render(uint index, const WorkProgress& progress) {
    const auto batches = picture_.plan.batches(index);
    const PixelWindow& cover = picture_.plan.cover;
    const uint first_row = batches.front().first_tile_row * NEARLIGHT_TILE_SIZE - cover.y;
    const uint row_count =
        std::min(batches.front().tile_row_count * NEARLIGHT_TILE_SIZE, cover.height - first_row);
    FinishedBand band;
    const std::size_t lights_before = picture_.local ? stages_.local_gather->light_count() : 0;
    buffers_.sums.fill_zero();
    if (reach() > 0) {
        buffers_.splats.fill_zero();
    }
    if (refinement_) {
        refinement_->begin({cover.x, cover.y + first_row, cover.width, row_count});
    }
    for (std::size_t i = 0; i < batches.size(); ++i) {
        const auto batch_progress = [&](std::uint64_t done, std::uint64_t total) {
            const double within = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
            return progress((static_cast<double>(i) + within) / static_cast<double>(batches.size()));
        };
        if (!add_batch(with_light(batches[i], picture_, paths_), row_count, batch_progress)) {
            return std::nullopt;
        }
    }
    if (!refine(batches.front(), progress)) {
        return std::nullopt;
    }
    band.local_lights = picture_.local ? stages_.local_gather->light_count() - lights_before : 0;
    band.rows = finished_rows(row_count);
    return band;
}

std::vector<float> BandRenderer::finished_rows(uint row_count) {
    const std::size_t pixel_count = static_cast<std::size_t>(picture_.plan.cover.width) * row_count;
    stages_.film.resolve(buffers_.sums, pixel_count, picture_.settings.samples_per_pixel, buffers_.layers);
    std::vector<float> rows(pixel_count * band_floats_per_pixel(reach()));
    const std::size_t layers = pixel_count * NEARLIGHT_LAYER_CHANNELS;
    buffers_.layers.download(std::span(rows).first(layers));
    if (reach() > 0) {
        stages_.splats->gather(buffers_.splats, refinement_ ? refinement_->splats() : nullptr,
                               splat_pixels(row_count), reach(), buffers_.row_splats);
        std::vector<RowSplat> splats(pixel_count * splat_rows(reach()));
        buffers_.row_splats.download(splats);
        std::memcpy(rows.data() + layers, splats.data(), splats.size() * sizeof(RowSplat));
    }
    return rows;
}

}  // namespace nearlight::core
