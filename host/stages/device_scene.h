// SPDX-License-Identifier: Apache-2.0
// A scene in device memory, as kernels/lib/scene.cl sees it.
#pragma once

#include "host/scene/scene.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {

struct DeviceScene {
    DeviceTree tree;   ///< of opaque surfaces
    DeviceTree glass;  ///< of what only the camera sees
    Buffer<Vertex> vertices;
    Buffer<Triangle> triangles;
    Buffer<Material> materials;
    Buffer<Texture> textures;
    Buffer<uint> texels;
    Buffer<Emitter> emitters;
    Buffer<Environment> environment;
    Buffer<float> environment_pixels;  ///< RGBA
    Buffer<float> row_cdf;
    Buffer<float> column_cdf;
    Buffer<SceneInfo> info;

    // What the host needs to know without asking the device.
    SceneInfo host_info{};
    bool has_lobes = false;    ///< some material gives camera paths two ways on (a coat or glass)
    float mean_albedo = 0.5f;  ///< luminance that light transport sees, averaged over area
    float total_power = 0.0f;  ///< luminance of all emitted flux, W
    double total_area = 0.0;   ///< of all triangles, m²

    /// In the order of SCENE_PARAMETERS.
    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        visit(tree), visit(tree.triangle_ids), visit(glass), visit(glass.triangle_ids);
        visit(vertices), visit(triangles), visit(materials), visit(textures), visit(texels);
        visit(emitters), visit(environment), visit(environment_pixels), visit(row_cdf), visit(column_cdf);
        visit(info);
    }
};

/// For gathers with `kernel`. The trees must have the shapes that the device wants (tree_shapes()).
DeviceScene upload_scene(Device& device, const Scene& scene, const SceneTrees& trees,
                         GatherKernel kernel = GatherKernel::automatic);
/// The same with trees that are widened here where the device wants it.
DeviceScene upload_scene(Device& device, const Scene& scene, const SceneBvhs& bvhs,
                         GatherKernel kernel = GatherKernel::automatic);

}  // namespace nearlight::core
