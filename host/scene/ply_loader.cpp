// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "host/scene/corner_uvs.h"
#include "host/scene/file_text.h"
#include "host/scene/ply_file.h"
#include "host/scene/polygon.h"

namespace nearlight::core {
namespace {

/// What is looked for in a file.
struct PlyTask {
    std::string_view vertex_attribute;  ///< without "vertex_"; empty if the attribute is none of vertices
    std::string_view face_attribute;    ///< without "face_"; empty if it is none of faces
    PlyCode code = PlyCode::as_it_stands;
    std::size_t texture_count = 0;  ///< those that the file names, if anybody wants them
    bool has_corner_uvs = false;    ///< faces have texture coordinates for these textures
};

void read_vertices(PlyReader& reader, const PlyElement& element, const PlyTask& task, Mesh& mesh) {
    const PlyColumns columns = vertex_columns(element, task.vertex_attribute);
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
        const PlyRow values = read_row(reader, element, columns, task.code);
        reader.end_row();
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

uint checked_index(const PlyReader& reader, double index, const Mesh& mesh) {
    if (!(index >= 0.0 && index < static_cast<double>(mesh.positions.size()))) {
        std::ostringstream text;  // any number may stand there
        text << "PLY face refers to vertex " << index << ", but there are only " << mesh.positions.size();
        reader.fail(text.str());
    }
    return static_cast<uint>(index);
}

/// What a property of a face is.
enum class FaceColumn { skipped, corners, uvs, texture, channel };

FaceColumn face_column(const PlyProperty& property, int slot) {
    if (property.is_list) {
        return property.name == "vertex_indices" || property.name == "vertex_index" ? FaceColumn::corners
               : property.name == "texcoord"                                        ? FaceColumn::uvs
                                                                                    : FaceColumn::skipped;
    }
    return slot >= 0                      ? FaceColumn::channel
           : property.name == "texnumber" ? FaceColumn::texture
                                          : FaceColumn::skipped;
}

bool has_face_column(const PlyHeader& header, FaceColumn wanted) {
    return std::ranges::any_of(header.elements, [&](const PlyElement& element) {
        return element.name == "face" && std::ranges::any_of(element.properties, [&](const auto& property) {
                   return face_column(property, -1) == wanted;
               });
    });
}

constexpr std::string_view kStrips = "tristrips";

bool is_surface(const PlyElement& element) {
    return element.name == "face" || element.name == kStrips;
}

/// Reads faces and strips of triangles, and adds them to a mesh that has its vertices.
class PlyFaceReader {
  public:
    PlyFaceReader(const PlyTask& task, Mesh& mesh) : task_(task), mesh_(mesh) {}

    void read(PlyReader& reader, const PlyElement& element) {
        const PlyColumns columns = attribute_columns(element, task_.face_attribute);
        const bool has_colors = columns.channels > 0 || !mesh_.face_colors.empty();
        mesh_.triangles.reserve(mesh_.triangles.size() + element.count);
        if (has_colors) {
            mesh_.face_colors.resize(mesh_.triangles.size(), kNoColor);
            mesh_.face_colors.reserve(mesh_.triangles.capacity());
        }
        for (std::size_t i = 0; i < element.count; ++i) {
            read_face(reader, element, columns);
            reader.end_row();
            if (element.name == kStrips) {
                add_strips(reader);
            } else {
                add_face(reader);
            }
            if (has_colors) {
                mesh_.face_colors.resize(mesh_.triangles.size(), columns.channels > 0
                                                                     ? attribute_value(row_, columns.channels)
                                                                     : kNoColor);
            }
        }
    }

    /// Three for each triangle, if the task has texture coordinates of corners.
    [[nodiscard]] const std::vector<std::array<float, 2>>& corner_uvs() const { return corner_uvs_; }

  private:
    void read_face(PlyReader& reader, const PlyElement& element, const PlyColumns& columns) {
        numbers_.clear();
        uvs_.clear();
        texture_ = 0.0;
        row_ = {};
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            switch (face_column(property, columns.slots[i])) {
                case FaceColumn::corners:
                    read_corners(reader, property);
                    break;
                case FaceColumn::uvs:
                    read_uvs(reader, property);
                    break;
                case FaceColumn::texture:
                    texture_ = reader.read(property.type);
                    break;
                case FaceColumn::channel:
                    read_slot(reader, property.type, columns.slots[i], task_.code, row_);
                    break;
                case FaceColumn::skipped:
                    reader.skip(property);
                    break;
            }
        }
    }

    void read_corners(PlyReader& reader, const PlyProperty& property) {
        const double count = reader.read(property.count_type);
        for (double corner = 0; corner < count; ++corner) {
            numbers_.push_back(reader.read(property.type));
        }
    }

    void read_uvs(PlyReader& reader, const PlyProperty& property) {
        if (!task_.has_corner_uvs) {
            reader.skip(property);
            return;
        }
        const double count = reader.read(property.count_type);
        for (double i = 0; i < count; ++i) {
            const auto value = static_cast<float>(reader.read(property.type));
            uvs_.push_back(std::isfinite(value) ? value : 0.0f);
        }
    }

    [[nodiscard]] bool has_uvs() const {
        return task_.has_corner_uvs ? !uvs_.empty() && uvs_.size() == 2 * face_.size() : !mesh_.uvs.empty();
    }

    /// That of the face's triangles among Mesh::groups.
    [[nodiscard]] uint group() const {
        const bool is_known = texture_ >= 0.0 && texture_ < static_cast<double>(task_.texture_count);
        return has_uvs() && is_known ? static_cast<uint>(texture_) + 1 : 0;
    }

    void add_face(const PlyReader& reader) {
        face_.clear();
        corners_.clear();
        for (const double number : numbers_) {
            face_.push_back(checked_index(reader, number, mesh_));
            corners_.push_back(mesh_.positions[face_.back()]);
        }
        if (face_.size() < 3) {
            return;
        }
        for (const auto& triangle : triangulate(corners_)) {
            mesh_.triangles.push_back({face_[triangle[0]], face_[triangle[1]], face_[triangle[2]]});
            for (const uint corner : triangle) {
                add_corner_uv(corner);
            }
        }
        add_groups();
    }

    /// Strips whose ends −1 marks. Every other triangle of a strip runs the other way round, and those with a
    /// corner twice only lead from one place to another.
    void add_strips(const PlyReader& reader) {
        face_.clear();
        for (const double number : numbers_) {
            if (number == -1.0) {
                face_.clear();
                continue;
            }
            face_.push_back(checked_index(reader, number, mesh_));
            if (face_.size() < 3) {
                continue;
            }
            std::array<uint, 3> triangle;
            std::copy(face_.end() - 3, face_.end(), triangle.begin());
            if (face_.size() % 2 == 0) {
                std::swap(triangle[1], triangle[2]);
            }
            if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) {
                mesh_.triangles.push_back(triangle);
            }
        }
        if (task_.has_corner_uvs) {
            corner_uvs_.resize(3 * mesh_.triangles.size());
        }
        add_groups();
    }

    void add_groups() {
        if (task_.has_corner_uvs || (task_.texture_count > 0 && !mesh_.uvs.empty())) {
            mesh_.groups.resize(mesh_.triangles.size(), group());
        }
    }

    void add_corner_uv(std::size_t corner) {
        if (task_.has_corner_uvs) {
            corner_uvs_.push_back(has_uvs() ? std::array{uvs_[2 * corner], uvs_[2 * corner + 1]}
                                            : std::array{0.0f, 0.0f});
        }
    }

    const PlyTask& task_;
    Mesh& mesh_;
    std::vector<std::array<float, 2>> corner_uvs_;
    // Of the present face:
    std::vector<double> numbers_;  ///< its list of vertices, as the file has it
    std::vector<uint> face_;       ///< its vertices
    std::vector<Vec3> corners_;    ///< their positions
    std::vector<float> uvs_;       ///< u and v of each corner
    double texture_ = 0.0;
    PlyRow row_{};
};

bool has_color_columns(const PlyHeader& header, std::string_view name) {
    return std::ranges::any_of(header.elements, [&](const PlyElement& element) {
        return element.name == name && attribute_columns(element, "color").channels > 0;
    });
}

/// The names behind "TextureFile" in comments.
std::vector<std::string> texture_comments(const PlyHeader& header) {
    constexpr std::string_view kWord = "TextureFile";
    std::vector<std::string> names;
    for (const std::string& comment : header.comments) {
        const std::size_t begin = comment.find_first_not_of(" \t", kWord.size());
        if (comment.starts_with(kWord) && begin > kWord.size() && begin != std::string::npos) {
            names.push_back(comment.substr(begin));
        }
    }
    return names;
}

void skip_element(PlyReader& reader, const PlyElement& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) {
            reader.skip(property);
        }
        reader.end_row();
    }
}

Mesh read_ply_mesh(const std::filesystem::path& file, std::string_view text, const PlyHeader& header,
                   const PlyTask& task) {
    PlyReader reader(file, text, header);
    Mesh mesh;
    mesh.source = file;
    PlyFaceReader faces(task, mesh);
    std::vector<std::pair<PlyReader, const PlyElement*>> waiting;  // for the vertices, which come later
    bool has_vertices = false;
    for (const PlyElement& element : header.elements) {
        reader.check_size_of(element);
        if (element.name == "vertex") {
            read_vertices(reader, element, task, mesh);
            has_vertices = true;
        } else if (is_surface(element) && has_vertices) {
            faces.read(reader, element);
        } else {
            if (is_surface(element)) {
                waiting.emplace_back(reader, &element);
            }
            skip_element(reader, element);
        }
    }
    reader.check_end();
    for (auto& [place, element] : waiting) {
        faces.read(place, *element);
    }
    if (mesh.triangles.empty()) {
        fail_ply(file, "has no triangles");
    }
    if (task.has_corner_uvs) {
        check_mesh(mesh);
        set_corner_uvs(mesh, faces.corner_uvs());
    }
    return mesh;
}

}  // namespace

Mesh read_ply(const std::filesystem::path& file, const PlyAttribute& attribute) {
    const auto name_after = [&](std::string_view kind) {
        return attribute.name.starts_with(kind) ? attribute.name.substr(kind.size()) : std::string_view();
    };
    const std::string text = read_file_text(file);
    const PlyHeader header = parse_ply_header(file, text);
    return read_ply_mesh(file, text, header,
                         {.vertex_attribute = name_after("vertex_"),
                          .face_attribute = name_after("face_"),
                          .code = attribute.code});
}

PlyModel read_ply_model(const std::filesystem::path& file) {
    const std::string text = read_file_text(file);
    const PlyHeader header = parse_ply_header(file, text);
    PlyModel model;
    model.textures = texture_comments(header);
    model.are_textures_numbered = has_face_column(header, FaceColumn::texture);
    const bool has_vertex_colors = has_color_columns(header, "vertex");
    model.has_colors_of_both = has_vertex_colors && has_color_columns(header, "face");
    model.mesh = read_ply_mesh(
        file, text, header,
        {.vertex_attribute = "color",
         .face_attribute = has_vertex_colors ? "" : "color",
         .code = PlyCode::display,
         .texture_count = model.textures.size(),
         .has_corner_uvs = !model.textures.empty() && has_face_column(header, FaceColumn::uvs)});
    return model;
}

}  // namespace nearlight::core
