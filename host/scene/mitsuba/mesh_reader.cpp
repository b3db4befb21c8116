// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/mesh_reader.h"

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "host/base/thread_limit.h"
#include "host/scene/crease_normals.h"
#include "host/scene/mitsuba/mesh_attribute.h"
#include "host/scene/mitsuba/serialized_mesh.h"
#include "host/scene/places.h"
#include "host/scene/ply_loader.h"

namespace nearlight::core::mitsuba {
namespace {

/// More files at once would take memory without being read faster.
constexpr int kMaxAhead = 8;

/// What it takes to read a file. Objects note which of their properties are asked for, so that only one
/// thread may look at them.
struct MeshSource {
    std::filesystem::path file;
    std::string type;
    /// Among the meshes of the file. Empty: the first one of a serialized file, or all of an OBJ file.
    std::optional<int> index{};
    std::string attribute;                       ///< which textures look up
    PlyCode color_code = PlyCode::as_it_stands;  ///< of a PLY file
    /// Normals are made anew, with creases where faces meet at a greater angle; empty if those of the file
    /// count.
    std::optional<float> max_smooth_degrees{};
};

/// Which of the meshes of a file the shape is. Only Mitsuba 0.5 and 0.6 choose among those of OBJ files,
/// where negative numbers stand for all of them. An index stands for one mesh, as their manual says, although
/// those versions take the last two meshes of a file for one.
std::optional<int> shape_index(const Object& shape) {
    const bool is_obj = shape.type == "obj";
    if ((!is_obj || !shape.is_old) && shape.type != "serialized") {
        return std::nullopt;
    }
    const double index = shape.number("shape_index", is_obj ? -1.0 : 0.0);
    if (is_obj && index < 0.0) {
        return std::nullopt;
    }
    if (!(index >= 0.0 && index < 1e9)) {
        fail(shape.where, "'shape_index' should be 0 or greater");
    }
    if (is_obj && shape.boolean("collapse", false)) {
        if (index > 0.0) {
            fail(shape.where, "'collapse' makes one mesh of the file, so that 'shape_index' should be 0");
        }
        return std::nullopt;
    }
    return static_cast<int>(index);
}

// Mitsuba 0.5 and 0.6 make the normals of a shape that has this property.
std::optional<float> max_smooth_degrees(const Object& shape) {
    if (!shape.has("max_smooth_angle")) {
        return std::nullopt;
    }
    if (shape.boolean("face_normals", false)) {
        fail(shape.where, "'max_smooth_angle' and 'face_normals' exclude each other");
    }
    const double degrees = shape.number("max_smooth_angle", 0.0);
    if (!(degrees >= 0.0 && degrees <= 180.0)) {
        fail(shape.where, "'max_smooth_angle' should be between 0 and 180 degrees");
    }
    return static_cast<float>(degrees);
}

// Mitsuba 0.5 and 0.6 take all colours of PLY files for sRGB, also floats, unless the shape says otherwise.
PlyCode ply_color_code(const Object& shape) {
    if (shape.type != "ply" || !shape.is_old) {
        return PlyCode::as_it_stands;
    }
    return shape.boolean("srgb", true) ? PlyCode::srgb : PlyCode::linear;
}

MeshSource source_of(const Object& shape) {
    return {.file = shape.required_file(),
            .type = shape.type,
            .index = shape_index(shape),
            .attribute = mesh_attribute_of(shape),
            .color_code = ply_color_code(shape),
            .max_smooth_degrees = max_smooth_degrees(shape)};
}

MeshFile read_file(const MeshSource& source) {
    MeshFile file;
    if (source.type == "ply") {
        file.mesh = read_ply(source.file, {.name = source.attribute, .code = source.color_code});
        return file;
    }
    if (source.type == "obj") {
        file = read_obj(source.file, ObjUse::mitsuba_shape, source.index);
    } else {
        file.mesh = read_serialized(source.file, source.index.value_or(0));
    }
    if (source.attribute != kVertexColor) {
        file.mesh.colors.clear();
    }
    return file;
}

MeshFile read_source(const MeshSource& source) {
    MeshFile file = read_file(source);
    if (source.max_smooth_degrees) {
        check_mesh(file.mesh);
        const std::vector<uint> groups(file.mesh.triangles.size(), kSmoothByAngle);
        add_crease_normals(file.mesh, places_of(file.mesh.positions), groups, *source.max_smooth_degrees);
        file.mesh.face_normals = false;
    }
    return file;
}

/// Whether a file can be read ahead, and what is wrong with a shape can wait until it is its turn.
bool can_be_ahead(const Object& shape) {
    const Property* const file = shape.find("filename");
    const auto* const name = file == nullptr ? nullptr : std::get_if<std::string>(&file->value);
    return shape.type == "obj" && name != nullptr && !name->empty() && !shape.has("max_smooth_angle") &&
           !shape.has("shape_index");
}

}  // namespace

void MeshReader::read_ahead() {
    const std::size_t most = files_ahead(kMaxAhead);
    while (!coming_.empty() && ahead_.size() < most) {
        const Object* const shape = coming_.front();
        if (can_be_ahead(*shape)) {
            MeshSource source = source_of(*shape);
            try {
                ahead_.push_back({shape, std::async(std::launch::async, read_source, std::move(source))});
            } catch (const std::system_error&) {
                return;  // the system gives no more threads
            }
        }
        coming_.pop_front();
    }
}

std::future<MeshFile> MeshReader::read(const Object& shape) {
    read_ahead();
    if (ahead_.empty() || ahead_.front().shape != &shape) {
        if (!coming_.empty() && coming_.front() == &shape) {
            coming_.pop_front();  // it is read now, because no other thread has begun to
        }
        return std::async(std::launch::deferred, read_source, source_of(shape));
    }
    std::future<MeshFile> file = std::move(ahead_.front().file);
    ahead_.pop_front();
    read_ahead();
    return file;
}

}  // namespace nearlight::core::mitsuba
