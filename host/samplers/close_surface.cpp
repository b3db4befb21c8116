// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/close_surface.h"

#include <utility>

#include "host/base/message.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {

CloseSurface::CloseSurface(SamplerStages& stages, const SamplingTask& task, const CloseSelection& selection)
    : stages_(stages), task_(task), region_(empty_region(stages, task.scene)) {
    const DeviceScene& scene = task.scene;
    const std::size_t all = scene.host_info.triangle_count;
    region_.range.upload(std::span(&task.close_range, 1));
    region_.whole_triangles = selection.whole_triangles;

    Buffer<uint> flags(stages.device, all);
    Buffer<float> areas(stages.device, all);
    Buffer<uint> close_ids(stages.device, all);
    stages.triangle_classifier.classify(scene.vertices, scene.triangles, scene.materials, region_.range,
                                        region_.whole_triangles, all, flags, areas);
    const std::size_t close_count = stages.compaction.list_set(flags, all, close_ids);
    std::size_t count = close_count;
    if (selection.only_lit) {
        stages.light_visibility().run(scene, close_ids, close_count, task.seed, region_.triangles);
        count = stages.compaction.list_set(region_.triangles, all, close_ids);
    } else {
        std::swap(region_.triangles, flags);
    }

    Buffer<Vec3> centroids(stages.device, count);
    Buffer<uint> order(stages.device, count);
    Buffer<uint> ids(stages.device, count);
    stages.triangle_classifier.centroids(scene.vertices, scene.triangles, close_ids, count, centroids);
    stages.morton_sort.order(centroids, count, order);
    stages.compaction.gather(close_ids, order, count, ids);
    surface_ = stages.vpl_placement.surface_of(areas, std::move(ids), count,
                                               area_units_per_square_metre(scene.total_area));
    say_debug(std::to_string(close_count) + " of " + std::to_string(all) +
              " triangles are in the close range, " + std::to_string(count) + " are selected");
}

std::vector<Vpl> CloseSurface::place(std::size_t point_count, uint seed) {
    const DeviceScene& scene = task_.scene;
    const std::size_t slot_count = 2 * point_count;
    Buffer<SurfaceSample> samples(stages_.device, point_count);
    Buffer<Vpl> slots(stages_.device, slot_count);
    Buffer<uint> flags(stages_.device, slot_count);
    const auto area_per_point = static_cast<float>(surface_.area / static_cast<double>(point_count));
    stages_.vpl_placement.place(surface_, scene.vertices, scene.triangles, region_.range,
                                region_.whole_triangles, point_count, seed, samples);
    stages_.patch_vpls.run(scene, samples, point_count, region_, area_per_point, slots, flags);
    return stages_.compaction.download_set(slots, flags, slot_count);
}

}  // namespace nearlight::core
