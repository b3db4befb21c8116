// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/materials.h"
#include "host/scene/gltf/nodes.h"
#include "host/scene/gltf/primitive_data.h"
#include "host/scene/mesh.h"

namespace nearlight::core::gltf {

/// Adds the triangles of nodes to the scene, in the pose in which the file has them.
class MeshMaker {
  public:
    /// The materials may belong to another scene; then `scene` gets nothing but shapes.
    MeshMaker(const GltfFile& file, Scene& scene, MaterialMaker& materials, NoteSink& notes)
        : file_(file), scene_(scene), notes_(notes), materials_(materials) {}

    /// Adds the node's mesh, if it has one, once for each instance (EXT_mesh_gpu_instancing). Points and
    /// lines are left out, with a note.
    void add(const PlacedNode& placed);
    /// Lets the backs of closed surfaces shine too, where their materials say so and a camera at `eye` sees
    /// them. The backs of open surfaces shine in any case.
    void add_seen_backs(Vec3 eye);

  private:
    /// A closed surface that shines to both sides.
    struct ShiningBody {
        Mesh mesh;
        std::vector<Mat4> placements;
        int material = -1;
        bool has_tangents = false;
        std::string name;  ///< of its object
    };

    void add_primitive(const tinygltf::Node& node, const tinygltf::Primitive& primitive,
                       const std::vector<Mat4>& placements);
    [[nodiscard]] Mesh read_mesh(const tinygltf::Node& node, const tinygltf::Primitive& primitive,
                                 const PrimitiveData& data);
    /// Notes tangents that differ from those of the texture coordinates.
    void note_other_tangents(const PrimitiveData& data, const Mesh& mesh);
    void read_colors(const PrimitiveData& data, int material, Mesh& mesh);
    void move_joints(const tinygltf::Node& node, const PrimitiveData& data, Mesh& mesh);
    std::vector<uint> choose_materials(int material, const Mesh& mesh, bool has_tangents,
                                       const Mat4& to_world);
    [[nodiscard]] std::vector<Mat4> placements_of(const PlacedNode& placed, const tinygltf::Node& node);

    const GltfFile& file_;
    Scene& scene_;
    NoteSink& notes_;
    MaterialMaker& materials_;
    std::vector<ShiningBody> bodies_;
    std::optional<std::vector<Mat4>> world_;  ///< of all nodes, once a skin asks for it
};

}  // namespace nearlight::core::gltf
