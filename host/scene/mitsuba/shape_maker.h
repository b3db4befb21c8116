// SPDX-License-Identifier: Apache-2.0
// Mitsuba's shapes.
#pragma once

#include <map>
#include <optional>

#include "host/scene/mesh.h"
#include "host/scene/mitsuba/material_maker.h"
#include "host/scene/mitsuba/mesh_reader.h"
#include "host/scene/mitsuba/sphere_detail.h"

namespace nearlight::core::mitsuba {

class ShapeMaker {
  public:
    ShapeMaker(Scene& scene, NoteSink& notes, TextureMaker& textures, MaterialMaker& materials)
        : scene_(scene), notes_(notes), textures_(textures), materials_(materials) {}

    /// Adds the shapes to the scene. A `shapegroup` alone adds nothing; each `instance` adds a copy of its
    /// shapes. Call it once.
    void add_all(const std::vector<const Object*>& shapes);

  private:
    /// Adds a shape that lies in `depth` merges.
    void add(const Object& shape, uint depth);
    /// The index of a material that light passes as if it was not there.
    uint medium_boundary();
    /// A mesh, and the materials of its groups where they are several.
    struct LoadedMesh {
        Mesh mesh;
        std::vector<uint> materials;
    };

    /// Adds the shape, placed by its own transform and then by that of an instance, as an object of its name,
    /// after that of the instance.
    void add_placed(const Object& shape, const LoadedMesh& loaded, const Mat4& own, const Mat4& by_instance,
                    const std::string& instance = {});
    Mat4 own_placement(const Object& shape);
    [[nodiscard]] std::string name_of(const Object& shape, std::size_t number) const;
    void add_instance(const Object& instance);
    LoadedMesh load(const Object& shape);
    LoadedMesh load_file(const Object& shape);
    MeshFile read_file(const Object& shape);
    /// The material of the whole shape.
    uint material_of(const Object& shape, const Parameter& emitted);
    /// The materials of an OBJ file's groups in Mitsuba 0.5 and 0.6: BSDFs with the names of groups, and
    /// those of the file's libraries. Empty if the shape has one material.
    std::vector<uint> materials_by_name(const Object& shape, const ObjFile& file);
    Parameter emission(const Object& shape);

    Scene& scene_;
    NoteSink& notes_;
    TextureMaker& textures_;
    MaterialMaker& materials_;
    SphereDetail spheres_{{}};
    MeshReader reader_{{}};
    std::map<const Object*, LoadedMesh> group_meshes_;
    std::size_t shape_count_ = 0;  ///< shapes and instances so far
    std::optional<uint> medium_boundary_{};
};

}  // namespace nearlight::core::mitsuba
