// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <future>

#include "host/base/hash.h"
#include "host/base/stopwatch.h"
#include "host/render/local_gather.h"
#include "host/render/plan.h"
#include "host/stages/film.h"

namespace nearlight {
namespace {

/// Every stage of a render, compiled.
struct RenderStages {
    RenderStages(Device& device, GatherKernel gather_kernel)
        : camera_pass(device), samplers(device, {.kernel = gather_kernel}), film(device) {}

    CameraPass camera_pass;
    SamplerStages samplers;
    Film film;
    std::optional<LocalGather> local_gather{};  ///< compiled when first wanted
};

/// Device memory that all batches of a picture use in turn.
struct BatchBuffers {
    BatchBuffers(Device& device, std::size_t packets, std::size_t pixels)
        : receivers(device, packets),
          vertices(device, packets * NEARLIGHT_PACKET_SIZE),
          direct(device, packets),
          indirect(device, packets),
          sums(device, pixels * NEARLIGHT_FILM_CHANNELS),
          layers(device, pixels * NEARLIGHT_LAYER_CHANNELS) {}

    Buffer<ReceiverPacket> receivers;
    Buffer<CameraVertex> vertices;
    Buffer<IrradiancePacket> direct;
    Buffer<IrradiancePacket> indirect;
    Buffer<float> sums;
    Buffer<float> layers;
};

/// What stays the same from batch to batch.
struct Picture {
    const DeviceScene& scene;
    const View& view;
    const RenderSettings& settings;
    const Buffer<PinholeCamera>& camera;
    const Buffer<CloseRange>& close_range;
    const Buffer<Vpl>& vpls;
    std::size_t vpl_count;
    LocalGather* local;  ///< null: VPLs are all there is
};

uint direct_samples_per_sample(const RenderSettings& settings) {
    return std::max(1u, (settings.direct_samples_per_pixel + settings.samples_per_pixel - 1) / settings.samples_per_pixel);
}

/// Indirect light of a batch's receivers. False if cancelled.
bool gather_indirect(RenderStages& stages, const Picture& picture, std::size_t packets, BatchBuffers& buffers,
                     const GatherProgress& progress) {
    Gatherer& gatherer = stages.samplers.gatherer;
    if (picture.local != nullptr) {
        return picture.local->run(gatherer, picture.scene, buffers.receivers, packets, buffers.indirect, progress);
    }
    return gatherer.gather({.nodes = picture.scene.nodes,
                            .triangles = picture.scene.bvh_triangles,
                            .wide_nodes = picture.scene.wide_nodes,
                            .blocks = picture.scene.blocks,
                            .vpls = picture.vpls,
                            .vpl_count = picture.vpl_count,
                            .receivers = buffers.receivers,
                            .packet_count = packets,
                            .clamp_radius = picture.view.clamp_radius},
                           buffers.indirect, progress);
}

/// One batch: receivers, direct light, indirect light, film. False if cancelled.
bool render_batch(RenderStages& stages, const Picture& picture, const CameraBand& band, uint row_count,
                  BatchBuffers& buffers, const GatherProgress& progress) {
    const uint width = picture.view.camera.width;
    const std::size_t packets = packet_count(band, width);
    stages.camera_pass.run(picture.scene, picture.camera, width, picture.close_range, band, picture.settings.seed,
                           buffers.receivers, buffers.vertices);
    if (picture.settings.indirect_only) {
        buffers.direct.fill_zero();
    } else {
        stages.samplers.direct_light.run(picture.scene, buffers.receivers, packets, direct_samples_per_sample(picture.settings),
                                         picture.settings.seed, buffers.direct);
    }
    const bool finished = gather_indirect(stages, picture, packets, buffers, progress);
    if (finished) {
        stages.film.add(buffers.receivers, buffers.vertices, buffers.direct, buffers.indirect, band, width, row_count,
                        buffers.sums);
    }
    return finished;
}

std::uint64_t hash_beauty(std::span<const float> rows, std::uint64_t hash) {
    for (std::size_t i = 0; i < rows.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        hash = fnv1a(std::as_bytes(rows.subspan(i, 3)), hash);
    }
    return hash;
}

/// All bands from top to bottom. Sets report.interrupted and stops where the caller wants no more.
void render_bands(Device& device, RenderStages& stages, const Picture& picture, const RowSink& sink,
                  const RenderProgress& progress, RenderReport& report) {
    const uint width = picture.view.camera.width;
    const uint height = picture.view.camera.height;
    const uint spp = picture.settings.samples_per_pixel;
    const RenderPlan plan = make_plan(device, width, height, spp, picture.scene.has_lobes ? 2 : 1);
    const std::size_t pixels_per_band = static_cast<std::size_t>(width) * plan.tile_rows_per_band * 8;
    BatchBuffers buffers(device, plan.max_packets(width), pixels_per_band);
    std::vector<float> rows(pixels_per_band * NEARLIGHT_LAYER_CHANNELS);
    report.image_hash = kFnvSeed;
    for (uint band = 0; band < plan.band_count(); ++band) {
        const auto batches = plan.batches(band);
        const uint first_row = batches.front().first_tile_row * 8;
        const uint row_count = std::min(batches.front().tile_row_count * 8, height - first_row);
        const double batch_total = static_cast<double>(plan.band_count()) * static_cast<double>(batches.size());
        buffers.sums.fill_zero();
        for (std::size_t i = 0; i < batches.size(); ++i) {
            const auto batch_progress = [&](std::uint64_t done, std::uint64_t total) {
                const double within = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
                const double before = band * static_cast<double>(batches.size()) + static_cast<double>(i);
                return progress("gathering", (before + within) / batch_total);
            };
            if (!render_batch(stages, picture, batches[i], row_count, buffers, batch_progress)) {
                report.interrupted = true;
                return;
            }
        }
        const std::size_t pixel_count = static_cast<std::size_t>(width) * row_count;
        stages.film.resolve(buffers.sums, pixel_count, spp, buffers.layers);
        const std::span finished = std::span(rows).first(pixel_count * NEARLIGHT_LAYER_CHANNELS);
        buffers.layers.download(finished);
        report.image_hash = hash_beauty(finished, report.image_hash);
        sink(finished);
    }
}

void fill_report(const View& view, const VplSet& vpls, RenderReport& report) {
    report.width = static_cast<int>(view.camera.width);
    report.height = static_cast<int>(view.camera.height);
    report.range = view.close_range.range;
    report.clamp_radius = view.clamp_radius;
    report.max_depth = view.max_depth;
    report.close_vpls = vpls.close_count;
    report.distant_vpls = vpls.distant_count;
    report.sparse_vpls = vpls.sparse_count;
    report.candidates = vpls.candidate_count;
    report.close_fraction = vpls.close_fraction;
}

SamplingTask sampling_task(const DeviceScene& scene, const View& view, const RenderSettings& settings) {
    return {.scene = scene,
            .view = view.pilot,
            .sampler = settings.sampler,
            .policy = settings.policy,
            .vpl_count = settings.vpl_count,
            .bounce_count = view.bounce_count(),
            .close_fraction = settings.close_fraction,
            .close_range = view.close_range,
            .clamp_radius = view.clamp_radius,
            .seed = settings.seed};
}

}  // namespace

struct Renderer::State {
    Device& device;
    const Scene& scene;
    RenderSeconds seconds;  ///< of getting ready
    RenderStages stages;
    DeviceScene device_scene;

    /// Kernels compile while the tree is built: one waits for the driver, the other for memory.
    static std::unique_ptr<State> make(Device& device, const Scene& scene, GatherKernel gather_kernel,
                                       BvhQuality bvh_quality) {
        const Stopwatch total;
        RenderSeconds seconds;
        auto building = std::async(std::launch::async, [&] {
            Stopwatch watch;
            SceneBvhs bvhs = build_scene_bvhs(scene, {.quality = bvh_quality});
            seconds.build_bvh = watch.seconds();
            return bvhs;
        });
        Stopwatch watch;
        auto state = std::unique_ptr<State>(new State{device, scene, {}, RenderStages(device, gather_kernel), {}});
        seconds.compile = watch.lap();
        building.wait();
        watch.lap();
        state->device_scene = upload_scene(device, scene, building.get());  // the host's trees end here
        seconds.generate = watch.lap();
        seconds.total = total.seconds();
        state->seconds = seconds;
        return state;
    }
};

Renderer::Renderer(Device& device, const Scene& scene, GatherKernel gather_kernel, BvhQuality bvh_quality)
    : state_(State::make(device, scene, gather_kernel, bvh_quality)) {}
Renderer::~Renderer() = default;

RenderReport Renderer::render(const RenderSettings& settings, const RenderStart& start, const RowSink& sink,
                              const RenderProgress& progress) {
    auto& [device, scene, seconds, stages, device_scene] = *state_;
    RenderReport report{.seconds = std::exchange(seconds, {})};
    Stopwatch watch;
    const Stopwatch total;
    const View view = choose_view(device, stages.camera_pass, device_scene, scene, settings);
    const VplSet vpls = sample_vpls(stages.samplers, sampling_task(device_scene, view, settings));
    const Buffer<Vpl> vpl_buffer = stages.samplers.vpl_order.upload_sorted(vpls.vpls);
    if (vpls.local) {
        if (!stages.local_gather) {
            stages.local_gather.emplace(device);
        }
        stages.local_gather->set_vpls(device_scene, vpl_buffer.download(), *vpls.local);
    }
    report.seconds.generate += watch.lap();

    fill_report(view, vpls, report);
    start(report, view, vpls);
    const Buffer<PinholeCamera> camera(device, std::span(&view.camera, 1));
    const Buffer<CloseRange> close_range(device, std::span(&view.close_range, 1));
    watch.lap();
    render_bands(device, stages,
                 {.scene = device_scene,
                  .view = view,
                  .settings = settings,
                  .camera = camera,
                  .close_range = close_range,
                  .vpls = vpl_buffer,
                  .vpl_count = vpls.vpls.size(),
                  .local = vpls.local ? &*stages.local_gather : nullptr},
                 sink, progress, report);
    report.seconds.gather = watch.lap();
    report.local_lights = vpls.local ? stages.local_gather->light_count() : 0;
    report.seconds.total += total.seconds();
    report.device_bytes = device.peak_bytes();
    return report;
}

RenderReport render(Device& device, const Scene& scene, const RenderSettings& settings, const RenderStart& start,
                    const RowSink& sink, const RenderProgress& progress) {
    return Renderer(device, scene, settings.gather_kernel, settings.bvh_quality).render(settings, start, sink, progress);
}

}  // namespace nearlight
