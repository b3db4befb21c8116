// SPDX-License-Identifier: Apache-2.0
// Meshes: PLY and Mitsuba's serialized files.
#include <zlib.h>

#include <string>

#include "tests/fuzz/scene_check.h"
#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {
namespace {

/// A file with one mesh, whose compressed contents are given. Mutations of a compressed stream seldom get
/// beyond its checksum.
std::string serialized_file(int version, Bytes contents) {
    uLongf size = compressBound(contents.size());
    std::string stream(size, '\0');
    compress(reinterpret_cast<Bytef*>(stream.data()), &size, contents.data(), contents.size());
    stream.resize(size);
    const std::string head{'\x1c', '\x04', static_cast<char>(version), '\0'};
    const std::string dictionary(version == 3 ? 4 : 8, '\0');
    return head + stream + dictionary + std::string{'\x01', '\0', '\0', '\0'};
}

}  // namespace

/// As a shape, and as a scene, which may have textures.
void fuzz_ply(Bytes bytes) {
    [[maybe_unused]] static const auto kImage = put("t.ppm", "P6\n2 1\n255\nabcdef");
    const auto mesh = put("mesh.ply", bytes);
    static const auto kScene = put("ply.xml",
                                   "<scene version='3.0.0'><shape type='ply'><string name='filename' "
                                   "value='mesh.ply'/></shape></scene>");
    load_and_check(kScene);
    load_and_check(mesh);
}

void fuzz_serialized(Bytes bytes) {
    if (bytes.empty()) {
        return;
    }
    const Bytes rest = bytes.subspan(1);
    const int kind = bytes[0] % 5;
    const bool is_raw = kind < 2;
    put("mesh.serialized", is_raw ? std::string(rest.begin(), rest.end()) : serialized_file(kind + 1, rest));
    const char* const index = kind == 1 ? "1" : "0";
    load_and_check(
        put("serialized.xml", std::string("<scene version='3.0.0'><shape type='serialized'><string "
                                          "name='filename' value='mesh.serialized'/><integer "
                                          "name='shape_index' value='") +
                                  index + "'/></shape></scene>"));
}

}  // namespace nearlight::core::fuzz
