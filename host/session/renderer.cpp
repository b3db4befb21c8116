// SPDX-License-Identifier: Apache-2.0
#include "host/session/renderer.h"

#include <algorithm>

#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/base/stopwatch.h"
#include "host/bvh/bvh_cache.h"
#include "host/cl/compile/program_compiler.h"
#include "host/session/band_renderer.h"
#include "host/session/passes.h"

namespace nearlight::core {
namespace {

/// Bytes of finished bands that may wait for an earlier one.
constexpr std::size_t kMaxWaitingBytes = std::size_t{256} << 20u;

/// A device with what a picture needs on it.
struct RenderDevice {
    BandStages stages;
    DeviceScene scene;
};

/// What precedes the bands of a picture.
struct Preparation {
    View view;
    VplSet vpls;
    std::vector<Vpl> gathered;  ///< the VPLs in the order in which they are gathered
};

std::uint64_t hash_beauty(std::span<const float> rows, std::uint64_t hash) {
    for (std::size_t i = 0; i < rows.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        hash = fnv1a(std::as_bytes(rows.subspan(i, 3)), hash);
    }
    return hash;
}

/// Settings that were decided, and VPLs that are gathered.
void add_pass(const Preparation& pass, RenderReport& report) {
    const View& view = pass.view;
    const VplSet& vpls = pass.vpls;
    if (report.passes++ == 0) {
        report.width = static_cast<int>(view.camera.width);
        report.height = static_cast<int>(view.camera.height);
        report.range = view.close_range.range;
        report.clamp_radius = view.clamp_radius;
        report.max_depth = view.max_depth;
        report.close_fraction = vpls.close_fraction;
    }
    report.close_vpls += vpls.close_count;
    report.distant_vpls += vpls.distant_count;
    report.sparse_vpls += vpls.sparse_count;
    report.candidates += vpls.candidate_count;
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

uint band_window(const RenderPlan& plan, uint width, std::size_t device_count) {
    const std::size_t band_bytes =
        std::size_t{width} * plan.tile_rows_per_band * 8 * NEARLIGHT_LAYER_CHANNELS * sizeof(float);
    return static_cast<uint>(std::max<std::size_t>(2 * device_count, kMaxWaitingBytes / band_bytes));
}

}  // namespace

struct Renderer::State {
    const Scene& scene;
    RenderSeconds seconds;                ///< of getting ready
    double reported_compile_seconds = 0;  ///< of earlier pictures
    /// Those that have not failed; the first leads.
    std::vector<std::unique_ptr<RenderDevice>> devices;
    GatherConfig gather_config;
    std::optional<SamplerStages> samplers;  ///< of the first device

    State(std::span<Device* const> on_devices, const Scene& of_scene, GatherKernel gather_kernel,
          BvhQuality bvh_quality);
    [[nodiscard]] Device& leader() const { return devices.front()->stages.device; }
    [[nodiscard]] std::vector<const Device*> plain_devices() const;
    [[nodiscard]] TreeShapes wanted_shapes() const;
    void upload(const SceneTrees& trees);
    void drop(std::size_t index);
    void lose(std::size_t index, const Error& error);
    [[nodiscard]] double compile_seconds();
    Preparation prepare(const RenderSettings& settings);
    Preparation prepare_on_leader(const RenderSettings& settings);
    std::vector<BandWorker> band_workers(const Picture& picture);
    void render_bands(const Preparation& prepared, const RenderSettings& settings, const RowSink& sink,
                      const RenderProgress& progress, RenderReport& report);
    Preparation begin_pass(const RenderSettings& settings, RenderReport& report);
    void render_passes(const RenderSettings& settings, const RenderStart& start, const RowSink& sink,
                       const RenderProgress& progress, RenderReport& report);
};

/// Kernels compile while the tree is built: one waits for the driver, the other for memory.
Renderer::State::State(std::span<Device* const> on_devices, const Scene& of_scene, GatherKernel gather_kernel,
                       BvhQuality bvh_quality)
    : scene(of_scene), gather_config{.kernel = gather_kernel} {
    const Stopwatch total;
    for (Device* device : on_devices) {
        devices.push_back(
            std::make_unique<RenderDevice>(RenderDevice{BandStages(*device, gather_kernel), {}}));
    }
    samplers.emplace(leader(), gather_config);
    Stopwatch watch;
    const SceneTrees trees = find_or_build_scene_trees(scene, {.quality = bvh_quality}, wanted_shapes(),
                                                       {.folder = leader().options().cache_dir});
    seconds.build_bvh = watch.lap();
    upload(trees);
    seconds.upload = watch.lap();
    seconds.total = total.seconds();
}

double Renderer::State::compile_seconds() {
    const double all = leader().compiler().busy_seconds();
    return all - std::exchange(reported_compile_seconds, all);
}

std::vector<const Device*> Renderer::State::plain_devices() const {
    std::vector<const Device*> result;
    for (const auto& device : devices) {
        result.push_back(&device->stages.device);
    }
    return result;
}

TreeShapes Renderer::State::wanted_shapes() const {
    TreeShapes all;
    for (const auto& device : devices) {
        const TreeShapes shapes = tree_shapes(device->stages.device, gather_config.kernel);
        all = {.binary = all.binary || shapes.binary, .wide = all.wide || shapes.wide};
    }
    return all;
}

void Renderer::State::upload(const SceneTrees& trees) {
    for (std::size_t i = devices.size(); i-- > 0;) {
        try {
            devices[i]->scene = upload_scene(devices[i]->stages.device, scene, trees, gather_config.kernel);
        } catch (const Error& error) {
            lose(i, error);
        }
    }
}

void Renderer::State::drop(std::size_t index) {
    if (index == 0) {
        samplers.reset();
    }
    devices.erase(devices.begin() + static_cast<std::ptrdiff_t>(index));
    if (index == 0) {
        samplers.emplace(leader(), gather_config);
    }
}

/// Must be called while `error` is handled: where there is no other device, it is thrown on.
void Renderer::State::lose(std::size_t index, const Error& error) {
    if (devices.size() == 1) {
        throw;
    }
    say_warning("device " + devices[index]->stages.device.entry().label() +
                " failed, others do its part: " + error.what());
    drop(index);
}

Preparation Renderer::State::prepare_on_leader(const RenderSettings& settings) {
    RenderDevice& device = *devices.front();
    Preparation prepared;
    prepared.view = choose_view(leader(), device.stages.camera_pass, device.scene, scene, settings);
    prepared.vpls = sample_vpls(*samplers, sampling_task(device.scene, prepared.view, settings));
    prepared.gathered = samplers->vpl_order.sorted(prepared.vpls.vpls);
    return prepared;
}

Preparation Renderer::State::prepare(const RenderSettings& settings) {
    for (;;) {
        try {
            return prepare_on_leader(settings);
        } catch (const Error& error) {
            lose(0, error);
        }
    }
}

std::vector<BandWorker> Renderer::State::band_workers(const Picture& picture) {
    std::vector<BandWorker> workers;
    for (const auto& device : devices) {
        workers.push_back(
            {.name = device->stages.device.entry().label(), .start = [&picture, device = device.get()] {
                 auto bands = std::make_shared<BandRenderer>(device->stages, device->scene, picture);
                 return [bands](uint index, const BandProgress& progress) {
                     return bands->render(index, progress);
                 };
             }});
    }
    return workers;
}

/// All bands, sent from top to bottom. Sets report.interrupted where the caller wants no more.
void Renderer::State::render_bands(const Preparation& prepared, const RenderSettings& settings,
                                   const RowSink& sink, const RenderProgress& progress,
                                   RenderReport& report) {
    const PinholeCamera& camera = prepared.view.camera;
    const RenderPlan plan = make_plan(plain_devices(), camera.width, camera.height,
                                      settings.samples_per_pixel, devices.front()->scene.has_lobes ? 2 : 1);
    const Picture picture{.view = prepared.view,
                          .settings = settings,
                          .plan = plan,
                          .vpls = prepared.gathered,
                          .local = prepared.vpls.local};
    const Stopwatch watch;
    const auto take_band = [&](const FinishedBand& band) {
        report.local_lights += band.local_lights;
        sink(band.rows);
    };
    BandOutcome outcome =
        share_bands(plan.band_count(), band_window(plan, camera.width, devices.size()), band_workers(picture),
                    take_band, [&](double fraction) { return progress("gathering", fraction); });
    report.seconds.gather += watch.seconds();
    report.interrupted = outcome.interrupted;
    std::size_t device_bytes = 0;
    for (const auto& device : devices) {
        device_bytes += device->stages.device.peak_bytes();
    }
    report.device_bytes = std::max(report.device_bytes, device_bytes);
    for (std::size_t i = outcome.shares.size(); i-- > 0;) {
        if (outcome.shares[i].failed) {
            drop(i);
        }
    }
    add_shares(outcome.shares, report.shares);
}

Preparation Renderer::State::begin_pass(const RenderSettings& settings, RenderReport& report) {
    const Stopwatch watch;
    Preparation prepared = prepare(settings);
    add_pass(prepared, report);
    report.seconds.generate += watch.seconds();
    return prepared;
}

/// What the first pass decided of the view holds for all, or they would not be renderings of one thing.
void Renderer::State::render_passes(const RenderSettings& settings, const RenderStart& start,
                                    const RowSink& sink, const RenderProgress& progress,
                                    RenderReport& report) {
    PassClock clock(settings, report.seconds.total);
    const Preparation first = begin_pass(settings, report);
    PassAverage average(first.view.camera.width, first.view.camera.height);
    const auto add_rows = [&](std::span<const float> rows) { average.add_rows(rows); };
    const auto pass_progress = [&](const std::string& stage, double fraction) {
        return progress(stage, clock.fraction(fraction));
    };
    render_bands(first, settings, add_rows, pass_progress, report);
    RenderSettings another = settings;
    another.range = first.view.close_range.range;
    another.clamp_radius = first.view.clamp_radius;
    while (!report.interrupted && clock.has_another()) {
        another.seed = pass_seed(settings.seed, report.passes);
        average.begin_pass();
        render_bands(begin_pass(another, report), another, add_rows, pass_progress, report);
    }
    start(report, first.view, first.vpls);
    average.send(sink);
}

Renderer::Renderer(std::span<Device* const> devices, const Scene& scene, GatherKernel gather_kernel,
                   BvhQuality bvh_quality)
    : state_(std::make_unique<State>(devices, scene, gather_kernel, bvh_quality)) {}
Renderer::Renderer(Device& device, const Scene& scene, GatherKernel gather_kernel, BvhQuality bvh_quality)
    : Renderer(std::vector{&device}, scene, gather_kernel, bvh_quality) {}
Renderer::~Renderer() = default;

RenderReport Renderer::render(const RenderSettings& settings, const RenderStart& start, const RowSink& sink,
                              const RenderProgress& progress) {
    RenderReport report;
    report.seconds = std::exchange(state_->seconds, {});
    report.image_hash = kFnvSeed;
    const Stopwatch total;
    const auto hash_and_send = [&](std::span<const float> rows) {
        report.image_hash = hash_beauty(rows, report.image_hash);
        sink(rows);
    };
    if (settings.passes.value_or(settings.seconds ? 2 : 1) > 1) {
        state_->render_passes(settings, start, hash_and_send, progress, report);
    } else {
        const Preparation prepared = state_->begin_pass(settings, report);
        start(report, prepared.view, prepared.vpls);
        state_->render_bands(prepared, settings, hash_and_send, progress, report);
    }
    report.seconds.compile = state_->compile_seconds();
    report.seconds.total += total.seconds();
    return report;
}

RenderReport render(std::span<Device* const> devices, const Scene& scene, const RenderSettings& settings,
                    const RenderStart& start, const RowSink& sink, const RenderProgress& progress) {
    return Renderer(devices, scene, settings.gather_kernel, settings.bvh_quality)
        .render(settings, start, sink, progress);
}
RenderReport render(Device& device, const Scene& scene, const RenderSettings& settings,
                    const RenderStart& start, const RowSink& sink, const RenderProgress& progress) {
    return render(std::vector{&device}, scene, settings, start, sink, progress);
}

// In the order of need. Programs stay with their device when the stages are gone.
void begin_compiling(std::span<Device* const> devices, const RenderSettings& settings) {
    const auto begin_bands = [&](Device& device) {
        const BandStages bands(device, settings.gather_kernel);
        if (settings.sampler == SamplerKind::local) {
            const LocalGather local_gather(device);
        }
    };
    begin_bands(*devices.front());
    SamplerStages samplers(*devices.front(), {.kernel = settings.gather_kernel});
    if (settings.sampler == SamplerKind::close_range && settings.policy != Policy::complete) {
        samplers.light_visibility();
    } else if (settings.sampler == SamplerKind::metropolis) {
        samplers.metropolis_chains();
    } else if (settings.sampler == SamplerKind::bidirectional || settings.sampler == SamplerKind::local) {
        samplers.reverse_vpls();
    }
    for (Device* device : devices.subspan(1)) {
        begin_bands(*device);
    }
}

}  // namespace nearlight::core
