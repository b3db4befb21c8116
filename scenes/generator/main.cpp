// SPDX-License-Identifier: Apache-2.0
// nearlight-scenes: writes the geometry of the project's own scenes.
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "nearlight/error.h"
#include "scenes/generator/scenes.h"

namespace {

using namespace nearlight::core::scenes;
using nearlight::Error;
using nearlight::ErrorKind;

struct Options {
    std::filesystem::path out;
    float detail = 1.0f;
    std::vector<std::string> names;
};

constexpr const char* kUsage =
    "usage: nearlight-scenes --out DIR [--detail N] [SCENE...]\n"
    "Writes DIR/SCENE/geometry/*.ply for each scene (all of them where none is named).\n"
    "  --detail N   1 to 8: finer triangles of the figure in stone-and-tea; N gives about N*N times as many\n"
    "scenes: cornell-box desk stone-and-tea showcase\n";

float parse_detail(const std::string& text) {
    size_t used = 0;
    float detail = 0.0f;
    try {
        detail = std::stof(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used != text.size() || text.empty() || !(detail >= 1.0f && detail <= 8.0f)) {
        throw Error(ErrorKind::invalid_argument, "--detail " + text + ": expected a number from 1 to 8");
    }
    return detail;
}

Options parse(const std::vector<std::string>& arguments) {
    Options options;
    for (size_t i = 0; i < arguments.size(); ++i) {
        const std::string& argument = arguments[i];
        if (argument == "--out" || argument == "--detail") {
            if (++i == arguments.size()) {
                throw Error(ErrorKind::invalid_argument,
                            argument + " needs a value; see nearlight-scenes --help");
            }
            if (argument == "--out") {
                options.out = arguments[i];
            } else {
                options.detail = parse_detail(arguments[i]);
            }
        } else if (argument.starts_with("-")) {
            throw Error(ErrorKind::invalid_argument,
                        "unknown option " + argument + "; see nearlight-scenes --help");
        } else {
            options.names.push_back(argument);
        }
    }
    if (options.out.empty()) {
        throw Error(ErrorKind::invalid_argument, "--out DIR is missing; see nearlight-scenes --help");
    }
    return options;
}

void write(const std::filesystem::path& folder, const std::string& name, const SceneFiles& scene) {
    std::filesystem::create_directories(folder);
    size_t triangles = 0;
    for (const auto& [part, mesh] : scene.model.parts()) {
        write_ply(folder / (part + ".ply"), mesh);
        triangles += mesh.triangles.size();
    }
    for (const auto& [bitmap_name, bitmap] : scene.bitmaps) {
        write_ppm(folder / (bitmap_name + ".ppm"), bitmap);
    }
    std::printf("%s: %zu triangles in %zu parts\n", name.c_str(), triangles, scene.model.parts().size());
}

void run(const Options& options) {
    const std::map<std::string, std::function<SceneFiles()>> scenes{
        {"cornell-box", make_cornell_box},
        {"desk", make_desk},
        {"stone-and-tea", [&] { return make_stone_and_tea(options.detail); }},
        {"showcase", make_showcase}};
    for (const std::string& name : options.names) {
        if (!scenes.contains(name)) {
            throw Error(ErrorKind::invalid_argument,
                        "no scene is called " + name + "; see nearlight-scenes --help");
        }
    }
    for (const auto& [name, make] : scenes) {
        if (options.names.empty() || std::ranges::find(options.names, name) != options.names.end()) {
            write(options.out / name / "geometry", name, make());
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (std::ranges::find(arguments, "--help") != arguments.end()) {
        std::fputs(kUsage, stdout);
        return 0;
    }
    try {
        run(parse(arguments));
        return 0;
    } catch (const Error& error) {
        std::fprintf(stderr, "nearlight-scenes: %s\n", error.what());
        return error.kind() == ErrorKind::invalid_argument ? 2 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nearlight-scenes: %s\n", error.what());
        return 1;
    }
}
