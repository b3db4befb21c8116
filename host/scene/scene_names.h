// SPDX-License-Identifier: Apache-2.0
// The names of a scene's objects and materials.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// What surfaces are called whose file has no name for their object or material.
inline constexpr std::string_view kNoName = "default";

/// Triangles that are added to the scene from now on belong to an object of this name. A name that is not
/// UTF-8 is taken for Latin-1, because mattes list names in JSON.
void begin_object(Scene& scene, std::string name);

/// Names a material of the scene. A name that is not UTF-8 is taken for Latin-1.
void name_material(Scene& scene, uint material, std::string name);

/// The name of something that the file may have a name for, or else what it is and its number, counted
/// from 1: "material 3".
std::string name_or_number(const std::string& name, std::string_view what, std::size_t number);

/// What a name stands for.
enum class NamedKind { object, material };

/// Finds the names of triangles. Keeps a reference to the scene, which must not change.
class TriangleNames {
  public:
    TriangleNames(const Scene& scene, NamedKind kind) : scene_(scene), kind_(kind) {}

    /// The number of the name of a triangle, below count().
    [[nodiscard]] std::size_t number_of(uint triangle) const;
    /// The number of names, one of which is kNoName.
    [[nodiscard]] std::size_t count() const { return table().size() + 1; }
    [[nodiscard]] std::string_view name(std::size_t number) const;
    /// The names that surfaces of the scene have, sorted, each once.
    [[nodiscard]] std::vector<std::string_view> used() const;

  private:
    [[nodiscard]] const std::vector<std::string>& table() const {
        return kind_ == NamedKind::object ? scene_.object_names : scene_.material_names;
    }

    const Scene& scene_;
    NamedKind kind_;
};

}  // namespace nearlight::core
