// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_loader.h"

#include <array>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "host/scene/file_text.h"
#include "host/scene/ply_file.h"
#include "host/scene/polygon.h"

namespace nearlight::core {
namespace {

// The slot of a property, in the order x y z nx ny nz u v; −1 if it is none of them.
int vertex_slot(std::string_view name) {
    constexpr std::pair<std::string_view, int> kSlots[] = {
        {"x", 0}, {"y", 1}, {"z", 2}, {"nx", 3}, {"ny", 4},        {"nz", 5},
        {"u", 6}, {"v", 7}, {"s", 6}, {"t", 7},  {"texture_u", 6}, {"texture_v", 7}};
    for (const auto& [known, slot] : kSlots) {
        if (known == name) {
            return slot;
        }
    }
    return -1;
}

/// The slots of an attribute's channels.
constexpr int kFirstChannel = 8;
constexpr std::size_t kSlotCount = 11;
/// A number for each slot, in the order of vertex_slot() and then the attribute's channels.
using Row = std::array<float, kSlotCount>;

/// Where the rows of a table keep what is asked for.
struct Columns {
    std::vector<int> slots;                  ///< of each property; −1 if it is skipped
    std::array<bool, kSlotCount> present{};  ///< whether a property of a vertex has the slot
    int channels = 0;                        ///< of the attribute: 0, 1 or 3
};

/// The place of a name among red, green and blue; −1 if it is none of them.
int color_channel(std::string_view name) {
    return name == "r" || name == "red"     ? 0
           : name == "g" || name == "green" ? 1
           : name == "b" || name == "blue"  ? 2
                                            : -1;
}

bool is_channel(std::string_view name, std::string_view attribute) {
    return name.size() == attribute.size() + 2 && name.starts_with(attribute) &&
           name[attribute.size()] == '_' &&
           std::string_view("xyzwrgba01234").find(name.back()) != std::string_view::npos;
}

/// The slots of a colour that is called r, g and b.
Columns color_columns(const PlyElement& element) {
    Columns columns{.slots = std::vector<int>(element.properties.size(), -1)};
    std::array<bool, 3> found{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        const int channel = property.is_list ? -1 : color_channel(property.name);
        if (channel >= 0) {
            columns.slots[i] = kFirstChannel + channel;
            found[static_cast<std::size_t>(channel)] = true;
        }
    }
    columns.channels = found[0] && found[1] && found[2] ? 3 : 0;
    return columns;
}

/// The slots of an attribute; its channels have the order of the file.
Columns attribute_columns(const PlyElement& element, std::string_view attribute) {
    if (attribute == "color") {
        if (Columns columns = color_columns(element); columns.channels == 3) {
            return columns;
        }
    }
    Columns columns{.slots = std::vector<int>(element.properties.size(), -1)};
    for (std::size_t i = 0; i < element.properties.size() && columns.channels < 3; ++i) {
        const PlyProperty& property = element.properties[i];
        if (!property.is_list && is_channel(property.name, attribute)) {
            columns.slots[i] = kFirstChannel + columns.channels++;
        }
    }
    columns.channels = columns.channels == 2 ? 0 : columns.channels;
    return columns;
}

/// The slots of all that a vertex may have.
Columns vertex_columns(const PlyElement& element, std::string_view attribute) {
    Columns columns = attribute_columns(element, attribute);
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        int& slot = columns.slots[i];
        slot = slot < 0 && !property.is_list ? vertex_slot(property.name) : slot;
        if (slot >= 0) {
            columns.present[static_cast<std::size_t>(slot)] = true;
        }
    }
    return columns;
}

Row read_row(PlyReader& reader, const PlyElement& element, const Columns& columns) {
    Row row{};
    for (std::size_t i = 0; i < columns.slots.size(); ++i) {
        if (columns.slots[i] < 0) {
            reader.skip(element.properties[i]);
        } else {
            row[static_cast<std::size_t>(columns.slots[i])] =
                static_cast<float>(reader.read(element.properties[i].type));
        }
    }
    return row;
}

Vec3 attribute_value(const Row& row, int channels) {
    const float first = row[kFirstChannel];
    return channels == 1 ? Vec3{first, first, first}
                         : Vec3{first, row[kFirstChannel + 1], row[kFirstChannel + 2]};
}

void read_vertices(PlyReader& reader, const PlyElement& element, std::string_view attribute, Mesh& mesh) {
    const Columns columns = vertex_columns(element, attribute);
    const auto& present = columns.present;
    if (!present[0] || !present[1] || !present[2]) {
        fail_ply(mesh.source, "PLY vertices need x, y and z");
    }
    const bool has_normals = present[3] && present[4] && present[5];
    const bool has_uvs = present[6] && present[7];
    const bool has_colors = columns.channels > 0;
    mesh.positions.reserve(element.count);
    mesh.normals.reserve(has_normals ? element.count : 0);
    mesh.uvs.reserve(has_uvs ? element.count : 0);
    mesh.colors.reserve(has_colors ? element.count : 0);
    for (std::size_t i = 0; i < element.count; ++i) {
        const Row values = read_row(reader, element, columns);
        mesh.positions.push_back({values[0], values[1], values[2]});
        if (has_normals) {
            mesh.normals.push_back({values[3], values[4], values[5]});
        }
        if (has_uvs) {
            mesh.uvs.push_back({values[6], values[7]});
        }
        if (has_colors) {
            mesh.colors.push_back(attribute_value(values, columns.channels));
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

/// Reads the list of a face's vertices and adds the face's triangles.
void read_face(PlyReader& reader, const PlyProperty& property, Mesh& mesh) {
    const double count = reader.read(property.count_type);
    std::vector<uint> face;
    std::vector<Vec3> corners;
    for (int corner = 0; corner < count; ++corner) {
        face.push_back(read_index(reader, property.type, mesh));
        corners.push_back(mesh.positions[face.back()]);
    }
    if (face.size() < 3) {
        return;
    }
    for (const auto& [a, b, c] : triangulate(corners)) {
        mesh.triangles.push_back({face[a], face[b], face[c]});
    }
}

void read_faces(PlyReader& reader, const PlyElement& element, std::string_view attribute, Mesh& mesh) {
    const Columns columns = attribute_columns(element, attribute);
    mesh.triangles.reserve(element.count);
    mesh.face_colors.reserve(columns.channels == 0 ? 0 : element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
        Row row{};
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index")) {
                read_face(reader, property, mesh);
            } else if (columns.slots[p] >= 0) {
                row[static_cast<std::size_t>(columns.slots[p])] =
                    static_cast<float>(reader.read(property.type));
            } else {
                reader.skip(property);
            }
        }
        if (columns.channels > 0) {
            mesh.face_colors.resize(mesh.triangles.size(), attribute_value(row, columns.channels));
        }
    }
}

}  // namespace

Mesh read_ply(const std::filesystem::path& file, std::string_view attribute) {
    const auto name_after = [attribute](std::string_view kind) {
        return attribute.starts_with(kind) ? attribute.substr(kind.size()) : std::string_view();
    };
    const std::string_view of_vertices = name_after("vertex_");
    const std::string_view of_faces = name_after("face_");
    const std::string text = read_file_text(file);
    const PlyHeader header = parse_ply_header(file, text);
    PlyReader reader(file, std::string_view(text).substr(header.size), header.format);
    Mesh mesh;
    mesh.source = file;
    for (const PlyElement& element : header.elements) {
        reader.check_size_of(element);
        if (element.name == "vertex") {
            read_vertices(reader, element, of_vertices, mesh);
        } else if (element.name == "face") {
            read_faces(reader, element, of_faces, mesh);
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
