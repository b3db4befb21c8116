// SPDX-License-Identifier: Apache-2.0
// A scene in device memory, as kernels/lib/scene.cl sees it.
#pragma once

#include <array>
#include <optional>

#include "host/scene/scene.h"
#include "host/stages/device_tree.h"
#include "host/stages/veil_trees.h"
#include "kernels/shared/caustic_aims.h"

namespace nearlight::core {

/// Where receivers aim to find light over mirrors and glass, in the order of CAUSTIC_PARAMETERS
/// (host/stages/caustic_aims.h). Without cells, none aims.
struct CausticAims {
    CausticAims() = default;
    explicit CausticAims(Device& device) : cells(device, 0), targets(device, 0) {}

    CausticTable table{};
    Buffer<CausticCell> cells;  ///< the entries of the table
    Buffer<Vec3> targets;

    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        visit(table), visit(cells), visit(targets);
    }
};

struct DeviceScene {
    DeviceTree tree;
    std::optional<VeilTrees> veil_trees{};  ///< in a scene that has veils
    Buffer<Vertex> vertices;
    Buffer<Triangle> triangles;
    Buffer<Material> materials;
    Buffer<Texture> textures;
    Buffer<uint> texels;  ///< words of all bitmaps
    Buffer<Vec3> vertex_colors;
    Buffer<std::array<float, 2>> second_uvs;
    Buffer<float> curves;  ///< transmission curves
    Buffer<Emitter> emitters;
    Buffer<Environment> environment;
    Buffer<float> environment_pixels;  ///< RGBA
    Buffer<float> row_cdf;
    Buffer<float> column_cdf;
    Buffer<float> row_cosines;
    Buffer<uint> block_details;
    Buffer<float> detail_cdf;
    Buffer<LightNode> light_nodes;
    Buffer<SceneInfo> info;
    CausticAims caustic_aims;

    // The host needs these without asking the device.
    SceneInfo host_info{};
    bool has_rough_gloss = false;  ///< some material spreads light by gloss
    bool has_mirrors = false;      ///< some material is a smooth mirror or the boundary of a glass body
    bool divides_paths = false;    ///< some material (a coat or glass) divides camera paths in two
    float mean_albedo = 0.5f;      ///< luminance of what surfaces reflect or let through, averaged over area
    float total_power = 0.0f;      ///< luminance of the emitted flux of all lights, W
    double total_area = 0.0;       ///< area of all triangles, m²

    [[nodiscard]] bool has_sky() const { return host_info.has_sky != 0; }
    [[nodiscard]] bool has_maps() const { return host_info.has_maps != 0; }
    [[nodiscard]] bool has_veils() const { return host_info.veils != NEARLIGHT_VEILS_NONE; }

    /// The transmission curves for a gather; null where all of them are 1.
    [[nodiscard]] const Buffer<float>* curves_in_use() const {
        return host_info.has_curves != 0 ? &curves : nullptr;
    }

    // The triangles of the tree that are no veils, in its slots.
    [[nodiscard]] const Buffer<BvhTriangle>& solid_triangles() const {
        return veil_trees ? veil_trees->solid_triangles : tree.triangles;
    }
    [[nodiscard]] const Buffer<TriangleBlock>& solid_blocks() const {
        return veil_trees ? veil_trees->solid_blocks : tree.blocks;
    }

    /// Calls visit(buffer) for every buffer, in the order of SCENE_PARAMETERS.
    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        visit(tree), visit(tree.triangle_ids);
        visit(vertices), visit(triangles), visit(materials), visit(textures), visit(texels);
        visit(vertex_colors), visit(second_uvs), visit(curves);
        visit(emitters), visit(environment), visit(environment_pixels), visit(row_cdf), visit(column_cdf);
        visit(row_cosines), visit(block_details), visit(detail_cdf), visit(light_nodes), visit(info);
        if (tree.has_wide_rays) {
            visit(solid_blocks());
        } else {
            visit(solid_triangles());
        }
    }
};

/// The arguments for single rays that meet veils alone, in the order of VEIL_PARAMETERS. In a scene without
/// veil trees they are those of all surfaces, which no kernel then asks.
struct VeilsForRays {
    const DeviceScene& scene;

    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        const DeviceTree& tree = scene.veil_trees ? scene.veil_trees->veils : scene.tree;
        visit(tree), visit(tree.triangle_ids);
    }
};

/// Uploads a scene for gathers with `kernel`. The tree must have the shapes that tree_shapes() asks for.
DeviceScene upload_scene(Device& device, const Scene& scene, const ShapedBvh& tree,
                         GatherKernel kernel = GatherKernel::automatic);
/// Uploads a scene for gathers with `kernel`, and widens the tree first where the device needs a wide one.
DeviceScene upload_scene(Device& device, const Scene& scene, const Bvh& bvh,
                         GatherKernel kernel = GatherKernel::automatic);

}  // namespace nearlight::core
