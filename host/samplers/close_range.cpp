// SPDX-License-Identifier: Apache-2.0
// Close-range VPL sampling [paper §3]: VPLs spread evenly over the lit surfaces near and before the camera, sparse
// light walks for the rest of the scene. docs/method.md has the repairs to the paper's text and why they are needed.
#include <algorithm>
#include <cmath>

#include "host/base/message.h"
#include "host/samplers/close_fraction.h"
#include "host/samplers/sampler.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight {
namespace {

/// For area and environment lights; the patches' irradiance is their power, so its noise is theirs.
constexpr uint kDirectSamplesPerPatch = 64;
/// Points that are placed to learn which share of them becomes VPLs.
constexpr uint kPilotPoints = 4096;
/// Where hardly a point of the selected triangles is lit or in view, more would take for ever.
constexpr double kMostPointsPerVpl = 64;
constexpr uint kPilotSeed = 0x717e5u;

/// The triangles that patches are placed on.
struct Selection {
    CloseRegion region;
    Buffer<uint> ids;  ///< along the Morton curve
    std::size_t count = 0;
};

/// Steps 1 to 3: close-range triangles, of those the ones that light reaches, in Morton order.
Selection select_triangles(SamplerStages& stages, const SamplingTask& task, Buffer<float>& areas) {
    const DeviceScene& scene = task.scene;
    const std::size_t triangle_count = scene.host_info.triangle_count;
    Selection selection;
    selection.region = empty_region(stages, scene);
    selection.region.range.upload(std::span(&task.close_range, 1));
    selection.region.whole_triangles = task.policy == Policy::paper;

    Buffer<uint> flags(stages.device, triangle_count);
    stages.triangle_classifier.classify(scene.vertices, scene.triangles, scene.materials, selection.region.range,
                                        triangle_count, flags, areas);
    Buffer<uint> close_ids(stages.device, triangle_count);
    const std::size_t close_count = stages.compaction.list_set(flags, triangle_count, close_ids);
    stages.light_visibility.run(scene, close_ids, close_count, task.seed, selection.region.triangles);

    selection.count = stages.compaction.list_set(selection.region.triangles, triangle_count, close_ids);
    Buffer<Vec3> centroids(stages.device, selection.count);
    Buffer<uint> order(stages.device, selection.count);
    selection.ids = Buffer<uint>(stages.device, selection.count);
    stages.triangle_classifier.centroids(scene.vertices, scene.triangles, close_ids, selection.count, centroids);
    stages.morton_sort.order(centroids, selection.count, order);
    stages.compaction.gather(close_ids, order, selection.count, selection.ids);
    stages.device.finish();  // the scratch buffers must outlive their kernels
    say_debug(std::to_string(close_count) + " of " + std::to_string(triangle_count) +
              " triangles are in the close range, light reaches " + std::to_string(selection.count));
    return selection;
}

/// Steps 4 to 6: `point_count` points on the selection, the light that falls on them, and the VPLs they become.
std::vector<Vpl> make_patch_vpls(SamplerStages& stages, const SamplingTask& task, const Selection& selection,
                                 std::size_t point_count, uint seed) {
    const DeviceScene& scene = task.scene;
    const std::size_t packet_count = patch_packet_count(point_count);
    const std::size_t slot_count = packet_count * NEARLIGHT_PACKET_SIZE;
    const uint points = static_cast<uint>(point_count);
    Buffer<SurfaceSample> samples(stages.device, point_count);
    Buffer<ReceiverPacket> receivers(stages.device, packet_count);
    Buffer<IrradiancePacket> irradiance(stages.device, packet_count);
    Buffer<Vpl> slots(stages.device, slot_count);
    Buffer<Vpl> kept(stages.device, slot_count);
    Buffer<uint> flags(stages.device, slot_count);
    Buffer<uint> indices(stages.device, slot_count);

    const double area_per_point = stages.vpl_placement.total_area() / static_cast<double>(point_count);
    stages.vpl_placement.place(scene.vertices, scene.triangles, selection.ids, point_count, seed, samples);
    stages.patch_vpls.make_receivers(scene, samples, points, selection.region, receivers);
    stages.direct_light.run(scene, receivers, packet_count, kDirectSamplesPerPatch, seed, irradiance);
    stages.patch_vpls.make_vpls(scene, samples, points, receivers, irradiance, static_cast<float>(area_per_point), slots,
                                flags);
    const std::size_t kept_count = stages.compaction.list_set(flags, slot_count, indices);
    stages.compaction.gather(slots, indices, kept_count, kept);
    std::vector<Vpl> vpls(kept_count);
    kept.download(vpls);
    return vpls;
}

/// About `wanted` patch VPLs. How many points that takes is learnt from an independent pilot: points in the shade,
/// beyond the view or the range become none, and stopping at a number of VPLs would be biased.
std::vector<Vpl> place_about(SamplerStages& stages, const SamplingTask& task, const Selection& selection, uint wanted) {
    if (wanted == 0) {
        return {};
    }
    const std::size_t pilot = make_patch_vpls(stages, task, selection, kPilotPoints, task.seed ^ kPilotSeed).size();
    const double vpls_per_point = std::max(static_cast<double>(pilot) / kPilotPoints, 1.0 / kMostPointsPerVpl);
    const auto points = static_cast<std::size_t>(std::clamp(std::round(wanted / vpls_per_point), 1.0, 1e8));
    return make_patch_vpls(stages, task, selection, points, task.seed);
}

KeepDeposits deposits_to_keep(Policy policy) {
    return policy == Policy::paper ? KeepDeposits::outside : KeepDeposits::indirect_inside;
}

}  // namespace

VplSet sample_close_range(SamplerStages& stages, const SamplingTask& task) {
    Buffer<float> areas(stages.device, task.scene.host_info.triangle_count);
    const Selection selection = select_triangles(stages, task, areas);
    stages.vpl_placement.set_surface(areas, selection.ids, selection.count,
                                     area_units_per_square_metre(task.scene.total_area));
    if (selection.count == 0 || !(stages.vpl_placement.total_area() > 0.0)) {
        say_warning("nothing that light reaches is in the close range; all VPLs come from light walks");
        return sample_instant_radiosity(stages, task);
    }
    VplSet set;
    set.close_triangles = selection.count;
    set.close_fraction = task.close_fraction ? *task.close_fraction : choose_close_fraction(stages, task, selection.region);
    const uint close_budget = static_cast<uint>(std::lround(set.close_fraction * static_cast<float>(task.vpl_count)));
    if (close_budget == 0) {
        return sample_instant_radiosity(stages, task);
    }
    set.vpls = place_about(stages, task, selection, close_budget);
    set.close_count = set.vpls.size();
    const std::vector<Vpl> distant =
        trace_about(stages, task, selection.region, deposits_to_keep(task.policy),
                    std::max(task.vpl_count - close_budget, 1u));  // without any, the far light would be lost
    set.distant_count = distant.size();
    set.vpls.insert(set.vpls.end(), distant.begin(), distant.end());
    return set;
}

}  // namespace nearlight
