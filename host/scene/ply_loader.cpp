// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_loader.h"

#include <array>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "host/scene/file_text.h"
#include "host/scene/ply_file.h"

namespace nearlight::core {
namespace {

// The slot of a property, in the order x y z nx ny nz u v r g b; −1 if it is skipped.
int vertex_slot(std::string_view name) {
    constexpr std::pair<std::string_view, int> kSlots[] = {
        {"x", 0}, {"y", 1}, {"z", 2},  {"nx", 3},  {"ny", 4},        {"nz", 5},
        {"u", 6}, {"v", 7}, {"s", 6},  {"t", 7},   {"texture_u", 6}, {"texture_v", 7},
        {"r", 8}, {"g", 9}, {"b", 10}, {"red", 8}, {"green", 9},     {"blue", 10}};
    for (const auto& [known, slot] : kSlots) {
        if (known == name) {
            return slot;
        }
    }
    return -1;
}

void read_vertices(PlyReader& reader, const PlyElement& element, Mesh& mesh) {
    std::vector<int> slots;
    std::array<bool, 11> present{};
    for (const PlyProperty& property : element.properties) {
        slots.push_back(property.is_list ? -1 : vertex_slot(property.name));
        if (slots.back() >= 0) {
            present[static_cast<std::size_t>(slots.back())] = true;
        }
    }
    if (!present[0] || !present[1] || !present[2]) {
        fail_ply(mesh.source, "PLY vertices need x, y and z");
    }
    const bool has_normals = present[3] && present[4] && present[5];
    const bool has_uvs = present[6] && present[7];
    const bool has_colors = present[8] && present[9] && present[10];
    mesh.positions.reserve(element.count);
    mesh.normals.reserve(has_normals ? element.count : 0);
    mesh.uvs.reserve(has_uvs ? element.count : 0);
    mesh.colors.reserve(has_colors ? element.count : 0);
    for (std::size_t i = 0; i < element.count; ++i) {
        std::array<float, 11> values{};
        for (std::size_t p = 0; p < slots.size(); ++p) {
            if (slots[p] < 0) {
                reader.skip(element.properties[p]);
            } else {
                values[static_cast<std::size_t>(slots[p])] =
                    static_cast<float>(reader.read(element.properties[p].type));
            }
        }
        mesh.positions.push_back({values[0], values[1], values[2]});
        if (has_normals) {
            mesh.normals.push_back({values[3], values[4], values[5]});
        }
        if (has_uvs) {
            mesh.uvs.push_back({values[6], values[7]});
        }
        if (has_colors) {
            mesh.colors.push_back({values[8], values[9], values[10]});
        }
    }
}

uint read_index(PlyReader& reader, PlyScalar type, const Mesh& mesh) {
    const double index = reader.read(type);
    if (!(index >= 0.0 && index < static_cast<double>(mesh.positions.size()))) {
        std::ostringstream text;  // any number may stand there
        text << "PLY face refers to vertex " << index << ", but there are only " << mesh.positions.size();
        fail_ply(mesh.source, text.str());
    }
    return static_cast<uint>(index);
}

void read_faces(PlyReader& reader, const PlyElement& element, Mesh& mesh) {
    mesh.triangles.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) {
            if (!property.is_list || (property.name != "vertex_indices" && property.name != "vertex_index")) {
                reader.skip(property);
                continue;
            }
            const double count = reader.read(property.count_type);
            std::array<uint, 3> fan{};
            for (int corner = 0; corner < count; ++corner) {
                const uint index = read_index(reader, property.type, mesh);
                if (corner < 2) {
                    fan[static_cast<std::size_t>(corner)] = index;
                    continue;
                }
                fan[2] = index;
                mesh.triangles.push_back(fan);
                fan[1] = index;
            }
        }
    }
}

}  // namespace

Mesh read_ply(const std::filesystem::path& file) {
    const std::string text = read_file_text(file);
    const PlyHeader header = parse_ply_header(file, text);
    PlyReader reader(file, std::string_view(text).substr(header.size), header.format);
    Mesh mesh;
    mesh.source = file;
    for (const PlyElement& element : header.elements) {
        reader.check_size_of(element);
        if (element.name == "vertex") {
            read_vertices(reader, element, mesh);
        } else if (element.name == "face") {
            read_faces(reader, element, mesh);
        } else {
            for (std::size_t i = 0; i < element.count; ++i) {
                for (const PlyProperty& property : element.properties) {
                    reader.skip(property);
                }
            }
        }
    }
    if (mesh.triangles.empty()) {
        fail_ply(file, "has no triangles");
    }
    return mesh;
}

}  // namespace nearlight::core
