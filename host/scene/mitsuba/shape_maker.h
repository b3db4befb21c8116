// SPDX-License-Identifier: Apache-2.0
// Mitsuba's shapes.
#pragma once

#include <map>

#include "host/scene/mesh.h"
#include "host/scene/mitsuba/material_maker.h"

namespace nearlight::core::mitsuba {

class ShapeMaker {
  public:
    ShapeMaker(Scene& scene, NoteSink& notes, TextureMaker& textures, MaterialMaker& materials)
        : scene_(scene), notes_(notes), textures_(textures), materials_(materials) {}

    /// Adds the shape to the scene. A `shapegroup` alone adds nothing; each `instance` adds a copy of its
    /// shapes.
    void add(const Object& shape);

  private:
    void add_placed(const Object& shape, const Mesh& mesh, const Mat4& to_world);
    void add_instance(const Object& instance);
    Mesh load(const Object& shape);
    Mesh load_file(const Object& shape);
    Parameter emission(const Object& shape);

    Scene& scene_;
    NoteSink& notes_;
    TextureMaker& textures_;
    MaterialMaker& materials_;
    std::map<const Object*, Mesh> group_meshes_;
};

}  // namespace nearlight::core::mitsuba
