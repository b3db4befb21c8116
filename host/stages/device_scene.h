// SPDX-License-Identifier: Apache-2.0
// A scene in device memory, as kernels/lib/scene.cl sees it.
#pragma once

#include "host/scene/scene.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {

struct DeviceScene {
    DeviceTree tree;   ///< tree of opaque surfaces
    DeviceTree glass;  ///< tree of glass, which only the camera sees
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
    Buffer<LightNode> light_nodes;
    Buffer<SceneInfo> info;

    // The host needs these without asking the device.
    SceneInfo host_info{};
    bool has_lobes = false;    ///< some material (a coat or glass) divides camera paths in two
    float mean_albedo = 0.5f;  ///< luminance of light_albedo(), averaged over area
    float total_power = 0.0f;  ///< luminance of the emitted flux of all lights, W
    double total_area = 0.0;   ///< area of all triangles, m²

    /// Calls visit(buffer) for every buffer, in the order of SCENE_PARAMETERS.
    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        visit(tree), visit(tree.triangle_ids), visit(glass), visit(glass.triangle_ids);
        visit(vertices), visit(triangles), visit(materials), visit(textures), visit(texels);
        visit(emitters), visit(environment), visit(environment_pixels), visit(row_cdf), visit(column_cdf);
        visit(light_nodes), visit(info);
    }
};

/// Uploads a scene for gathers with `kernel`. The trees must have the shapes that tree_shapes() asks for.
DeviceScene upload_scene(Device& device, const Scene& scene, const SceneTrees& trees,
                         GatherKernel kernel = GatherKernel::automatic);
/// Uploads a scene for gathers with `kernel`, and widens the trees first where the device needs wide ones.
DeviceScene upload_scene(Device& device, const Scene& scene, const SceneBvhs& bvhs,
                         GatherKernel kernel = GatherKernel::automatic);

}  // namespace nearlight::core
