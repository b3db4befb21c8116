// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_scene.h"

#include <charconv>
#include <string_view>

#include "host/reference/synthetic_scene.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr std::string_view kSpheres = "spheres:";

}  // namespace

void add_bench_scene_options(CLI::App& command, SceneOptions& options) {
    add_scene_options(command, options);
    command.get_option("SCENE")->required(false)->description(
        "Mitsuba XML (.xml), glTF (.gltf, .glb), OBJ (.obj), PLY (.ply), or spheres:N for a generated room "
        "of N triangles");
}

Scene make_bench_scene(const SceneOptions& options) {
    const std::string name = options.file.string();
    if (name.empty()) {
        throw Error(ErrorKind::invalid_argument, "give a SCENE or spheres:N");
    }
    if (!name.starts_with(kSpheres)) {
        return load_scene(options);
    }
    std::size_t triangles = 0;
    const char* const end = name.data() + name.size();
    const auto [rest, error] = std::from_chars(name.data() + kSpheres.size(), end, triangles);
    if (error != std::errc() || rest != end || triangles == 0 || triangles > 50'000'000) {
        throw Error(
            ErrorKind::invalid_argument,
            "'" + name +
                "' is not a scene; give a number of triangles from 1 to 50000000, as in spheres:400000");
    }
    return make_sphere_room(triangles);
}

}  // namespace nearlight::core
