// SPDX-License-Identifier: Apache-2.0
// Scenes: Mitsuba XML, OBJ with its materials, glTF.
#include <algorithm>
#include <string>

#include "tests/fuzz/scene_check.h"
#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {
namespace {

/// Files that scenes may name: a mesh, an image, materials and a list of numbers.
void put_neighbours() {
    static const bool once = [] {
        put("t.obj",
            "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1\n");
        put("t.mtl", "newmtl a\nKd 1 0 0\n");
        put("t.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 "
            "2\n");
        put("t.ppm", "P6\n2 1\n255\nabcdef");
        put("t.spd", "400 0.5\n700 1\n");
        return true;
    }();
    static_cast<void>(once);
}

void load(const std::filesystem::path& file, const LoadOptions& options = {}) {
    put_neighbours();
    load_and_check(file, options);
}

}  // namespace

void fuzz_mitsuba(Bytes bytes) {
    load(put("scene.xml", bytes));
}

/// As a scene, and of a shape of Mitsuba 0.6 the second mesh.
void fuzz_obj(Bytes bytes) {
    load(put("scene.obj", bytes));
    static const std::filesystem::path kShape =
        put("obj.xml",
            "<scene version='0.6.0'><shape type='obj'><string name='filename' value='scene.obj'/><integer "
            "name='shapeIndex' value='1'/></shape></scene>");
    load(kShape);
}

void fuzz_mtl(Bytes bytes) {
    put("materials.mtl", bytes);
    static const std::filesystem::path kScene = put(
        "materials.obj",
        "mtllib materials.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n"
        "usemtl b\nf 1/1 3/3 2/2\nusemtl\nf 2/1 3/3 1/2\n");
    load(kScene);
}

void fuzz_gltf(Bytes bytes) {
    const std::string magic = "glTF";
    const bool is_binary =
        bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
    const std::filesystem::path file = put(is_binary ? "scene.glb" : "scene.gltf", bytes);
    load(file);
    load(file, {.moment = SceneMoment{.seconds = 0.75}});
}

}  // namespace nearlight::core::fuzz
