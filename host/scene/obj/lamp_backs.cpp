// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/lamp_backs.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include "host/scene/places.h"
#include "host/scene/seen_side.h"
#include "host/scene/shining_backs.h"

namespace nearlight::core {
namespace {

uint group_of(const Mesh& mesh, uint triangle) {
    return mesh.groups.empty() ? 0 : mesh.groups[triangle];
}

/// Triangles, by the part of the surface that they hang together with.
std::vector<std::vector<uint>> connected_parts(const Mesh& mesh, const std::vector<uint>& triangles) {
    const std::vector<uint> places = places_of(mesh.positions);
    std::vector<uint> parents(places.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const auto root = [&](uint vertex) {
        uint place = places[vertex];
        while (parents[place] != place) {
            parents[place] = parents[parents[place]];
            place = parents[place];
        }
        return place;
    };
    for (const uint triangle : triangles) {
        const auto& [a, b, c] = mesh.triangles[triangle];
        parents[root(b)] = root(a);
        parents[root(c)] = root(a);
    }
    std::map<uint, std::vector<uint>> parts;
    for (const uint triangle : triangles) {
        parts[root(mesh.triangles[triangle][0])].push_back(triangle);
    }
    std::vector<std::vector<uint>> lists;
    for (auto& [place, list] : parts) {
        lists.push_back(std::move(list));
    }
    return lists;
}

/// A mesh of some triangles, which run as their normals say.
Mesh part_of(const Mesh& mesh, std::span<const uint> triangles) {
    Mesh part;
    part.source = mesh.source;
    std::unordered_map<uint, uint> numbers;
    const auto copy_vertex = [&](uint vertex) {
        const auto [entry, is_new] = numbers.try_emplace(vertex, static_cast<uint>(part.positions.size()));
        if (is_new) {
            const auto copy = [&](const auto& values, auto& copies) {
                if (!values.empty()) {
                    copies.push_back(values[vertex]);
                }
            };
            copy(mesh.positions, part.positions);
            copy(mesh.normals, part.normals);
            copy(mesh.uvs, part.uvs);
            copy(mesh.colors, part.colors);
        }
        return entry->second;
    };
    for (const uint triangle : triangles) {
        std::array<uint, 3> corners = mesh.triangles[triangle];
        if (!mesh.normals.empty() && winds_against(corners, mesh.positions, mesh.normals)) {
            std::swap(corners[1], corners[2]);
        }
        part.triangles.push_back({copy_vertex(corners[0]), copy_vertex(corners[1]), copy_vertex(corners[2])});
        part.groups.push_back(group_of(mesh, triangle));
    }
    return part;
}

/// Names the objects of a part as those of the mesh are.
void copy_objects(const Mesh& mesh, std::span<const uint> triangles, Mesh& part) {
    part.object_names = mesh.object_names;
    std::size_t next = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::size_t before = next;
        while (next < mesh.objects.size() && mesh.objects[next].first_triangle <= triangles[i]) {
            ++next;
        }
        if (next > before) {
            part.objects.push_back({static_cast<uint>(i), mesh.objects[next - 1].name});
        }
    }
}

}  // namespace

void add_lamp_backs(Scene& scene, const Mesh& mesh, const std::vector<uint>& materials, Vec3 eye,
                    NoteSink& notes) {
    std::vector<uint> shining;
    for (uint triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        if (!is_zero(scene.materials[materials[group_of(mesh, triangle)]].emission.value)) {
            shining.push_back(triangle);
        }
    }
    if (shining.empty()) {
        return;
    }
    std::vector<uint> turned;
    for (const std::vector<uint>& list : connected_parts(mesh, shining)) {
        const Mesh part = part_of(mesh, list);
        if (!is_closed(part) || shows_back(part, {}, eye)) {
            turned.insert(turned.end(), list.begin(), list.end());
        }
    }
    if (turned.empty()) {
        return;
    }
    std::ranges::sort(turned);
    Mesh back = part_of(mesh, turned);
    copy_objects(mesh, turned, back);
    const std::vector<Vec3> smooth = smooth_normals(back.positions, back.triangles);
    for (std::size_t i = 0; i < back.normals.size(); ++i) {
        back.normals[i] = is_zero(back.normals[i]) ? smooth[i] : back.normals[i];
    }
    std::vector<uint> backs = materials;
    std::vector<bool> is_used(materials.size(), false);
    for (const uint group : back.groups) {
        if (!is_used[group]) {
            is_used[group] = true;
            backs[group] = add_back_material(scene, materials[group]);
        }
    }
    add_shining_back(scene, std::move(back), {}, backs, notes);
}

}  // namespace nearlight::core
