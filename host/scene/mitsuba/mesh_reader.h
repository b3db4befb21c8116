// SPDX-License-Identifier: Apache-2.0
// The files of meshes that shapes name.
#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <span>

#include "host/scene/mesh.h"
#include "host/scene/mitsuba/object.h"
#include "host/scene/obj/obj_file.h"

namespace nearlight::core::mitsuba {

/// A mesh as its file has it. Of files other than OBJ it has the mesh alone.
using MeshFile = ObjFile;

/// Reads mesh files. Those of a scene's own shapes, one after another, are read by other threads ahead of the
/// caller, because scenes of hundreds of files would else keep one core busy while the others wait.
/// ThreadLimit says how many threads.
class MeshReader {
  public:
    /// The shapes of the scene, in the order in which they will be asked for.
    explicit MeshReader(std::span<const Object* const> shapes) : coming_(shapes.begin(), shapes.end()) {}

    /// The shape's mesh; its type is obj, ply or serialized. Throws Error for a property that is wrong; get()
    /// throws what is wrong with the file.
    std::future<MeshFile> read(const Object& shape);

  private:
    struct Ahead {
        const Object* shape;
        std::future<MeshFile> file;
    };
    void read_ahead();

    std::deque<const Object*> coming_;  ///< shapes whose files nobody has begun to read
    std::deque<Ahead> ahead_;
};

}  // namespace nearlight::core::mitsuba
