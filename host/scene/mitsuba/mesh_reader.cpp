// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/mesh_reader.h"

#include <algorithm>
#include <string>
#include <utility>

#include "host/base/thread_limit.h"
#include "host/scene/mitsuba/mesh_attribute.h"
#include "host/scene/mitsuba/serialized_mesh.h"
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
    int index = 0;          ///< among the meshes of a serialized file
    std::string attribute;  ///< which textures look up
};

// Which of the meshes of a file the shape is.
int shape_index(const Object& shape) {
    const double index = shape.number("shape_index", 0.0);
    if (!(index >= 0.0 && index < 1e9)) {
        fail(shape.where, "'shape_index' should be 0 or greater");
    }
    return static_cast<int>(index);
}

MeshSource source_of(const Object& shape) {
    return {.file = shape.required_string("filename"),
            .type = shape.type,
            .index = shape.type == "serialized" ? shape_index(shape) : 0,
            .attribute = mesh_attribute_of(shape)};
}

MeshFile read_source(const MeshSource& source) {
    MeshFile file;
    if (source.type == "ply") {
        file.mesh = read_ply(source.file, source.attribute);
        return file;
    }
    if (source.type == "obj") {
        file = read_obj(source.file, ObjUse::mitsuba_shape);
    } else {
        file.mesh = read_serialized(source.file, source.index);
    }
    if (source.attribute != kVertexColor) {
        file.mesh.colors.clear();
    }
    return file;
}

/// Whether a file can be read ahead, and what is wrong with a shape can wait until it is its turn.
bool can_be_ahead(const Object& shape) {
    const Property* const file = shape.find("filename");
    return shape.type == "obj" && file != nullptr && std::holds_alternative<std::string>(file->value);
}

}  // namespace

void MeshReader::read_ahead() {
    const std::size_t most = files_ahead(kMaxAhead);
    while (!coming_.empty() && ahead_.size() < most) {
        const Object* const shape = coming_.front();
        coming_.pop_front();
        if (can_be_ahead(*shape)) {
            ahead_.push_back({shape, std::async(std::launch::async, read_source, source_of(*shape))});
        }
    }
}

std::future<MeshFile> MeshReader::read(const Object& shape) {
    read_ahead();
    if (ahead_.empty() || ahead_.front().shape != &shape) {
        return std::async(std::launch::deferred, read_source, source_of(shape));
    }
    std::future<MeshFile> file = std::move(ahead_.front().file);
    ahead_.pop_front();
    read_ahead();
    return file;
}

}  // namespace nearlight::core::mitsuba
