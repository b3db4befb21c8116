// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/mesh_attribute.h"

namespace nearlight::core::mitsuba {
namespace {

std::string name_of(const Object& texture) {
    const auto name = texture.properties.find("name");
    const bool has_name =
        name != texture.properties.end() && std::holds_alternative<std::string>(name->second.value);
    return has_name ? std::get<std::string>(name->second.value) : kVertexColor;
}

}  // namespace

bool is_mesh_attribute(const Object& texture) {
    return texture.type == "mesh_attribute" || texture.type == "vertexcolors";
}

std::string mesh_attribute_of(const Object& shape) {
    const Object* found = nullptr;
    visit_all({&shape}, [&](const Object& object) {
        if (object.tag != "texture" || !is_mesh_attribute(object)) {
            return;
        }
        if (found != nullptr && name_of(*found) != name_of(object)) {
            fail(object.where, "a mesh may have one attribute that textures look up, and this one has '" +
                                   name_of(*found) + "' and '" + name_of(object) + "'");
        }
        found = &object;
    });
    return found == nullptr ? kVertexColor : name_of(*found);
}

}  // namespace nearlight::core::mitsuba
