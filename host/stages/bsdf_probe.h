// SPDX-License-Identifier: Apache-2.0
// BSDFs of points on triangles, as kernels compute them. Only checks need this, no picture does.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "host/cl/kernel.h"
#include "kernels/shared/bsdf_query.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// A scene without trees or lights. As made, it is one triangle in the plane z = 0, with its front up, u
/// along x and v along y, and without normals.
struct BsdfScene {
    std::vector<Vertex> vertices{
        {{0, 0, 0}, 0, {0, 0, 0}, 0}, {{1, 0, 0}, 1, {0, 0, 0}, 0}, {{0, 1, 0}, 0, {0, 0, 0}, 1}};
    std::vector<Triangle> triangles{{0, 1, 2, 0}};
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<uint> texels;
    std::vector<float> curves = std::vector<float>(NEARLIGHT_CURVE_SIZE, 1.0f);
    std::vector<Vec3> vertex_colors;
    std::vector<std::array<float, 2>> second_uvs;
    SceneInfo info{};
};

class BsdfProbe {
  public:
    explicit BsdfProbe(Device& device);

    /// Returns an answer for each query.
    std::vector<BsdfAnswer> ask(const BsdfScene& scene, std::span<const BsdfQuery> queries);
    BsdfAnswer ask(const BsdfScene& scene, const BsdfQuery& query) {
        return ask(scene, std::span(&query, 1))[0];
    }

  private:
    Device* device_;
    Kernel kernel_;
};

}  // namespace nearlight::core
