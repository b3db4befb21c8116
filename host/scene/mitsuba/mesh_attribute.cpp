// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/mesh_attribute.h"

#include <set>

namespace nearlight::core::mitsuba {
namespace {

std::string name_of(const Object& texture) {
    const auto name = texture.properties.find("name");
    const bool has_name =
        name != texture.properties.end() && std::holds_alternative<std::string>(name->second.value);
    return has_name ? std::get<std::string>(name->second.value) : kVertexColor;
}

/// What has been seen on the way through the objects below a shape, which may contain each other.
struct Search {
    std::set<const Object*> seen;
    const Object* found = nullptr;
};

void search(const Object& object, Search& state) {
    if (!state.seen.insert(&object).second) {
        return;
    }
    if (object.tag == "texture" && is_mesh_attribute(object)) {
        if (state.found != nullptr && name_of(*state.found) != name_of(object)) {
            fail(object.where, "a mesh may have one attribute that textures look up, and this one has '" +
                                   name_of(*state.found) + "' and '" + name_of(object) + "'");
        }
        state.found = &object;
    }
    for (const Child& child : object.children) {
        search(*child.object, state);
    }
}

}  // namespace

bool is_mesh_attribute(const Object& texture) {
    return texture.type == "mesh_attribute" || texture.type == "vertexcolors";
}

std::string mesh_attribute_of(const Object& shape) {
    Search state;
    search(shape, state);
    return state.found == nullptr ? kVertexColor : name_of(*state.found);
}

}  // namespace nearlight::core::mitsuba
