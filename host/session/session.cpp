// SPDX-License-Identifier: Apache-2.0
#include "host/session/session.h"

#include <algorithm>
#include <utility>

#include "host/base/memory.h"
#include "host/base/message.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/base/stopwatch.h"
#include "host/bvh/bvh_cache.h"
#include "host/cl/compile/program_compiler.h"
#include "host/samplers/incident_light.h"
#include "host/scene/ray_epsilon.h"
#include "host/session/key_vpls.h"
#include "host/session/light_shares.h"
#include "host/session/openings.h"
#include "host/session/picture_window.h"
#include "host/session/ray_budget.h"
#include "host/session/scene_memory.h"
#include "host/session/sky_part.h"
#include "host/session/vpl_file.h"

namespace nearlight::core {
namespace {

constexpr uint kThinningStream = 0x7417eu;
/// The pilot of the ray budget gathers no more than about twice as many VPLs: more of them would tell little
/// about rays, and take as long as the choice of the set.
constexpr std::size_t kMaxPilotVpls = 2048;

std::vector<ReceiverPacket> pack_points(std::span<const Vec3> points, std::span<const Vec3> normals,
                                        float extent) {
    std::vector<ReceiverPacket> packets(receiver_packet_count(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        set_receiver(packets[i / NEARLIGHT_PACKET_SIZE], i % NEARLIGHT_PACKET_SIZE,
                     {moved_off(points[i], normals[i], extent), normals[i]});
    }
    return packets;
}

SamplingTask sampling_task(const DeviceScene& scene, const View& view, const PilotView& pilot,
                           const SamplingSettings& settings, uint seed) {
    return {.scene = scene,
            .view = pilot,
            .sampler = settings.sampler,
            .policy = settings.policy,
            .vpl_count = settings.set_count_or_auto(),
            .for_cuts = settings.asks_part(),
            .bounce_count = view.bounce_count(),
            .close_fraction = settings.close_fraction,
            .close_range = view.close_range,
            .openings = view.openings,
            .clamp_radius = view.clamp_radius,
            .seed = seed};
}

/// About `wanted` of the VPLs, or fewer than twice as many, at even distances along their order. Each has the
/// power of all for which it stands.
VplBuffer thinned(Device& device, const VplBuffer& vpls, std::size_t wanted, uint seed) {
    const std::vector<Vpl> all = vpls.download();
    const std::size_t step = all.size() / wanted;
    std::vector<Vpl> some;
    for (std::size_t i = Pcg32(seed, kThinningStream).next() % step; i < all.size(); i += step) {
        some.push_back(all[i]);
        some.back().power *= static_cast<float>(step);
    }
    return {device, some};
}

/// The number of samples of all pixels in all passes.
double samples_of(const PixelWindow& window, std::span<const MattePass> passes) {
    double of_pixel = 0.0;
    for (const MattePass& pass : passes) {
        of_pixel += pass.samples_per_pixel;
    }
    return of_pixel * window.width * window.height;
}

}  // namespace

RayBudget budget_of(const View& view, const VplSet& vpls, const GatherSettings& settings) {
    RayBudget budget = vpls.ray_budget.value_or(RayBudget{.clamp_radius = view.clamp_radius});
    if (!settings.compensate) {
        budget.clamp_radius = view.clamp_radius;
    }
    budget.direct_samples_per_pixel =
        settings.direct_samples_per_pixel.value_or(budget.direct_samples_per_pixel);
    budget.shared_limit = settings.shared_limit.value_or(budget.shared_limit);
    return budget;
}

/// Kernels compile while the tree is built: compiling waits for the driver, building for memory.
Session::Session(std::span<Device* const> devices, const Scene& scene, const SessionOptions& options)
    : scene_(scene), pool_(devices, options.gather_kernel) {
    const Stopwatch total;
    check_scene_memory(scene, pool_.cpu_count(), std::min(free_memory(), free_address_space()));
    Stopwatch watch;
    const ShapedBvh tree =
        find_or_build_scene_tree(scene, {.quality = options.bvh_quality}, pool_.tree_shapes(),
                                 {.folder = pool_.leader().device().options().cache_dir});
    seconds_.build_bvh = watch.lap();
    pool_.upload(scene, tree);
    seconds_.upload = watch.lap();
    seconds_.total = total.seconds();
}
Session::Session(Device& device, const Scene& scene, const SessionOptions& options)
    : Session(std::vector{&device}, scene, options) {}

View Session::look(const SceneCamera& camera, const ViewSettings& settings, uint seed) {
    return pool_.on_leader([&](PoolDevice& leader) {
        View view = choose_view(leader.device(), leader.bands.camera_pass, leader.scene, scene_, camera,
                                settings, seed);
        view.openings =
            find_openings(leader.device(), leader.scene, scene_, view.pilot, view.close_range, seed);
        view.sky_part =
            sky_part(leader.device(), leader.bands.receiver_paths, leader.scene, view.pilot, seed);
        is_width_told_ = is_width_told_ || warn_of_width(leader.scene, view);
        return view;
    });
}

VplSet Session::read_vpls(const View& view, const std::filesystem::path& file) {
    const VplFile stored = read_vpl_file(file);
    check_vpls(stored, scene_, view.max_depth, file);
    return pool_.on_leader([&](PoolDevice& leader) {
        VplSet set = vpl_set_of(leader.device(), stored);
        if (!view.clamp_radius_is_open && set.ray_budget) {
            set.ray_budget->clamp_radius = view.clamp_radius;
        }
        if (!is_alone()) {
            set.vpls.keep_on_host();
        }
        return set;
    });
}

void Session::save_vpls(const View& view, const VplSet& vpls, const std::filesystem::path& file) {
    write_vpl_file(file, vpl_file_of(vpls, {.scene = lighting_hash(scene_), .max_depth = view.max_depth}));
}

VplSet Session::sample(const View& view, const SamplingSettings& settings, uint seed) {
    if (!settings.file.empty()) {
        return read_vpls(view, settings.file);
    }
    return pool_.on_leader([&](PoolDevice& leader) {
        // If the leader has failed since, its pilot view is gone; the same seed makes the same view again.
        std::optional<PilotView> again;
        if (!view.pilot.is_on(leader.device())) {
            again = look_at_scene(leader.device(), leader.bands.camera_pass, leader.scene, view.scene_camera,
                                  view.seed);
        }
        const PilotView& pilot = again ? *again : view.pilot;
        VplSet set = sample_vpls(*leader.samplers, sampling_task(leader.scene, view, pilot, settings, seed));
        if (settings.asks_part() && set.vpls.count() > settings.vpl_count) {
            set.asked_count = settings.vpl_count;
        }
        if (view.has_ray_budget_pilot && !set.local && !set.vpls.empty() && pilot.packet_count > 0) {
            const std::size_t asked = set.asked_count > 0 ? set.asked_count : set.vpls.count();
            const VplBuffer few = thinned(leader.device(), set.vpls, std::min(asked, kMaxPilotVpls), seed);
            set.ray_budget = choose_ray_budget({.stages = leader.bands,
                                                .scene = leader.scene,
                                                .view = pilot,
                                                .vpls = few,
                                                .asked_count = set.asked_count,
                                                .set_count = set.vpls.count(),
                                                .max_edges = view.bounce_count() + 1,
                                                .clamp_radius = view.clamp_radius,
                                                .rays_per_pixel = GatherSettings{}.rays_per_pixel,
                                                .radius_is_open = view.clamp_radius_is_open,
                                                .seed = seed});
        }
        if (!is_alone()) {
            set.vpls.keep_on_host();
        }
        return set;
    });
}

VplSet Session::join(std::span<const VplPart> parts) {
    return pool_.on_leader([&](PoolDevice& leader) {
        auto [set, vpls] = join_on_host(parts);
        const bool has_order = parts.size() < 2 || vpls.empty();
        set.vpls = has_order ? VplBuffer(leader.device(), vpls) : leader.samplers->vpl_order.sort(vpls);
        if (!is_alone()) {
            set.vpls.keep_on_host();
        }
        return std::move(set);
    });
}

std::vector<Vec3> Session::irradiance(std::span<const Vec3> points, std::span<const Vec3> normals,
                                      const View& view, const VplSet& vpls,
                                      const IrradianceSettings& settings, uint seed) {
    if (points.size() != normals.size()) {
        throw Error(ErrorKind::invalid_argument, "irradiance at " + std::to_string(points.size()) +
                                                     " points needs as many normals as points, not " +
                                                     std::to_string(normals.size()));
    }
    if (view.max_depth < 2) {
        return std::vector<Vec3>(points.size());  // Light on a surface is seen over two edges at least.
    }
    return pool_.on_leader([&](PoolDevice& leader) {
        Device& device = leader.device();
        const std::vector<ReceiverPacket> packets =
            pack_points(points, normals, leader.scene.host_info.extent);
        const Buffer<ReceiverPacket> receivers(device, std::span<const ReceiverPacket>(packets));
        Buffer<IrradiancePacket> light(device, packets.size());
        const VplBuffer copy = vpls.vpls.is_on(device) ? VplBuffer() : vpls.vpls.copy_to(device);
        gather_incident_light(
            *leader.samplers,
            {.scene = leader.scene,
             .bounce_count = view.bounce_count(),
             .vpls = vpls.vpls.is_on(device) ? vpls.vpls : copy,
             .clamp_radius = budget_of(view, vpls, {.compensate = settings.paths > 0}).clamp_radius},
            receivers, packets.size(), {.direct_samples = settings.direct_samples, .paths = settings.paths},
            seed, light);
        return unpack(light, points.size());
    });
}

std::vector<LightShare> Session::light_shares(Vec3 point, Vec3 normal, const View& view, const VplSet& vpls,
                                              uint seed) {
    return pool_.on_leader([&](PoolDevice& leader) {
        const LitPoint lit{.position = point,
                           .normal = normal,
                           .clamp_radius = budget_of(view, vpls, {}).clamp_radius,
                           .seed = seed};
        return core::light_shares(leader.device(), leader.scene, scene_, vpls.vpls.download(), lit);
    });
}

std::vector<uint> Session::see_first(const Camera& camera, const SampleBlock& block, uint seed) {
    return pool_.on_leader([&](PoolDevice& leader) {
        Device& device = leader.device();
        if (!leader.first_surfaces) {
            leader.first_surfaces.emplace(device);
        }
        const Buffer<Camera> own_camera(device, std::span(&camera, 1));
        Buffer<uint> triangles(device, block.size());
        leader.first_surfaces->run(leader.scene, own_camera, block, seed, triangles);
        return triangles.download();
    });
}

void Session::mattes(const Camera& camera, const std::optional<PixelWindow>& wanted,
                     std::span<const MattePass> passes, std::span<const NamedKind> kinds,
                     const MatteSink& sink, const WorkProgress& progress) {
    const PixelWindow window = window_of(camera.width, camera.height, wanted);
    const double all_samples = samples_of(window, passes);
    double samples = 0.0;
    MatteCounter counter(scene_, kinds);
    for (const PixelWindow& band : matte_bands(window, passes)) {
        counter.begin(std::size_t{band.width} * band.height);
        for (const MattePass& pass : passes) {
            for (const SampleBlock& block : sample_blocks(band, pass)) {
                counter.add(see_first(camera, block, pass.seed));
                samples += static_cast<double>(block.size());
                if (!progress(samples / all_samples)) {
                    return;
                }
            }
        }
        if (!sink(counter.rows())) {
            return;
        }
    }
}

double Session::new_compile_seconds() {
    const double all = pool_.leader().device().compiler().busy_seconds();
    return all - std::exchange(told_compile_seconds_, all);
}

// Programs begin to compile in the order in which they are needed. They stay with their device when the
// stages are gone.
void begin_compiling(std::span<Device* const> devices, const SessionOptions& options,
                     const SamplingSettings& settings) {
    const SamplerEntry& sampler = sampler_entry(settings.sampler);
    const auto begin_bands = [&](Device& device) {
        BandStages bands(device, options.gather_kernel);
        if (settings.asks_part()) {
            bands.light_cuts.emplace(device);
            bands.gatherer.expect_selections();
        }
        if (sampler.makes_local_lights) {
            const LocalGather local_gather(device);
        }
    };
    for (Device* device : devices) {
        try {
            begin_bands(*device);
            if (device == devices.front()) {
                SamplerStages stages(*device, {.kernel = options.gather_kernel});
                if (sampler.begin_compiling != nullptr && settings.file.empty()) {
                    sampler.begin_compiling(stages, settings.policy);
                }
            }
        } catch (const Error& error) {
            say_debug("device " + device->entry().label() + " begins to compile nothing: " + error.what());
        }
    }
}

}  // namespace nearlight::core
