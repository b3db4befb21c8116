// SPDX-License-Identifier: Apache-2.0
#include "host/cli/scene_options.h"

#include "host/cli/log.h"
#include "host/cli/override_options.h"

namespace nearlight::core {
namespace {

void set_filter(const SceneOptions& options, SceneCamera& camera) {
    if (options.filter) {
        camera.filter = default_filter(*options.filter);
    }
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
    command
        .add_option("SCENE", options.file,
                    "Mitsuba XML (.xml), glTF 2.0 (.gltf, .glb), OBJ with its MTL (.obj) or PLY (.ply)")
        ->required();
    add_shared_scene_options(command, options);
}

void add_shared_scene_options(CLI::App& command, SceneOptions& options) {
    command
        .add_option("-D,--define", options.definitions,
                    "Value of $NAME in a Mitsuba scene; may be given several times")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
    add_override_options(command, options);
    command.add_flag("--strict", options.strict, "Fail if the scene would have to be approximated");
}

void add_filter_option(CLI::App& command, std::optional<FilterKind>& filter) {
    const auto choose = [&filter](const std::string& name) {
        filter = filter_kind(name);
        if (!filter) {
            throw unknown_choice("--filter", name, filter_names());
        }
    };
    command
        .add_option_function<std::string>("--filter", choose,
                                          "Reconstruction filter, where a pixel has several samples: " +
                                              filter_names() + " (default: the scene's)")
        ->type_name("NAME");
}

void add_glass_option(CLI::App& command, bool& clear_glass) {
    add_words(
        command, "--glass", {"refract", "clear"},
        [&clear_glass](const std::string& word) { clear_glass = word == "clear"; },
        "refract: as in Mitsuba, solid glass casts shadows and caustics, and hides point lights, spots and "
        "directional lights, which in Mitsuba's scenes panes and masks do, too; clear: shadow rays of all "
        "lights go straight through glass, panes and masks, with their transmittance")
        ->default_str("refract");
}

std::string glass_name(bool clear_glass) {
    return clear_glass ? "clear" : "refract";
}

void add_bvh_option(CLI::App& command, BvhQuality& quality) {
    add_words(
        command, "--bvh", {"fast", "quality"},
        [&quality](const std::string& word) {
            quality = word == "fast" ? BvhQuality::fast : BvhQuality::quality;
        },
        "Tree for rays: fast (takes half the time to build) or quality (up to a quarter fewer steps per "
        "ray)")
        ->default_str(to_string(quality));
}

LoadOptions load_options(const SceneOptions& options) {
    LoadOptions result;
    result.strict = options.strict;
    result.camera = options.camera;
    result.overrides = options.overrides;
    result.moment = options.moment;
    result.lists_animations = options.lists_animations;
    for (const std::string& definition : options.definitions) {
        const std::size_t equals = definition.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw Error(ErrorKind::invalid_argument,
                        "'-D " + definition + "' defines nothing; give NAME=VALUE");
        }
        result.parameters[definition.substr(0, equals)] = definition.substr(equals + 1);
    }
    return result;
}

Scene load_scene(const SceneOptions& options) {
    Scene scene = load_scene(options.file, load_options(options));
    set_filter(options, scene.camera);
    scene.clear_glass = options.clear_glass;
    return scene;
}

std::optional<SceneCamera> camera_at(const Scene& scene, const SceneOptions& options) {
    std::optional<SceneCamera> camera = camera_at(scene, load_options(options));
    if (camera) {
        set_filter(options, *camera);
    }
    return camera;
}

}  // namespace nearlight::core
