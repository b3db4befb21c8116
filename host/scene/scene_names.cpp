// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_names.h"

#include <algorithm>
#include <utility>

#include "host/base/printable.h"

namespace nearlight::core {

void begin_object(Scene& scene, std::string name) {
    scene.objects.push_back(
        {static_cast<uint>(scene.triangles.size()), static_cast<uint>(scene.object_names.size())});
    scene.object_names.push_back(utf8_or_latin1(std::move(name)));
}

void name_material(Scene& scene, uint material, std::string name) {
    if (scene.material_names.size() <= material) {
        scene.material_names.resize(material + 1);
    }
    scene.material_names[material] = utf8_or_latin1(std::move(name));
}

std::string name_or_number(const std::string& name, std::string_view what, std::size_t number) {
    return name.empty() ? std::string(what) + " " + std::to_string(number) : name;
}

std::size_t TriangleNames::number_of(uint triangle) const {
    if (kind_ == NamedKind::material) {
        return std::min<std::size_t>(scene_.triangles[triangle].material, table().size());
    }
    const auto after =
        std::ranges::upper_bound(scene_.objects, triangle, std::less(), &ObjectRun::first_triangle);
    return after == scene_.objects.begin() ? table().size() : std::prev(after)->name;
}

std::string_view TriangleNames::name(std::size_t number) const {
    return number >= table().size() || table()[number].empty() ? kNoName : std::string_view(table()[number]);
}

std::vector<std::string_view> TriangleNames::used() const {
    std::vector<bool> is_used(count());
    if (kind_ == NamedKind::material) {
        for (uint i = 0; i < scene_.triangles.size(); ++i) {
            is_used[number_of(i)] = true;
        }
    } else {
        std::size_t end = scene_.triangles.size();
        for (std::size_t run = scene_.objects.size(); run-- > 0;) {
            const ObjectRun& object = scene_.objects[run];
            is_used[object.name] = is_used[object.name] || object.first_triangle < end;
            end = object.first_triangle;
        }
        is_used[table().size()] = end > 0;
    }
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < is_used.size(); ++i) {
        if (is_used[i]) {
            names.push_back(name(i));
        }
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

}  // namespace nearlight::core
