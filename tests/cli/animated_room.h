// SPDX-License-Identifier: Apache-2.0
// A glTF file with animations for tests of the whole program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace nearlight::core {

/// A floor and a wall that a lamp lights, which the camera "eye" walks past within a second ("walk"), while
/// in the second half of the next one the lamp rises ("rise"). The buffer is the file `room.bin` beside it.
struct AnimatedRoom {
    std::string json;
    std::string buffer;
};

inline AnimatedRoom animated_room() {
    using nlohmann::json;
    json views = json::array();
    json accessors = json::array();
    std::string bytes;
    const auto add = [&](const std::vector<float>& values, const char* type, std::size_t width) {
        views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", 4 * values.size()}});
        bytes.append(reinterpret_cast<const char*>(values.data()), 4 * values.size());
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", 5126},
                             {"count", values.size() / width},
                             {"type", type}});
        return accessors.size() - 1;
    };
    const auto quad = add({-1, 0, -1, -1, 0, 1, 1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0, -1}, "VEC3", 3);
    const auto walk_times = add({0, 1}, "SCALAR", 1);
    const auto walk = add({-0.5f, 1, 3, 0.5f, 1, 3}, "VEC3", 3);
    const auto rise_times = add({1.5f, 2}, "SCALAR", 1);
    const auto rise = add({0, 1.5f, 0, 0, 1.9f, 0}, "VEC3", 3);
    const auto motion = [](const char* name, int node, std::size_t times, std::size_t values) {
        return json{{"name", name},
                    {"samplers", {{{"input", times}, {"output", values}}}},
                    {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}};
    };
    const json chalk = {{"KHR_materials_specular", {{"specularFactor", 0}}}};
    const double s = 0.70710678118654752;
    const json root{
        {"asset", {{"version", "2.0"}}},
        {"scenes", {{{"nodes", {0, 1, 2, 3}}}}},
        {"nodes",
         {{{"mesh", 0}},
          {{"mesh", 0}, {"translation", {0, 1, -1}}, {"rotation", {s, 0, 0, s}}},
          {{"mesh", 1}, {"translation", {0, 1.5, 0}}, {"scale", {0.2, -0.2, 0.2}}, {"name", "lamp"}},
          {{"camera", 0}, {"name", "eye"}, {"translation", {-0.5, 1, 3}}}}},
        {"cameras",
         {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1.5}, {"znear", 0.1}}}}}},
        {"meshes",
         {{{"primitives", {{{"attributes", {{"POSITION", quad}}}, {"material", 0}}}}},
          {{"primitives", {{{"attributes", {{"POSITION", quad}}}, {"material", 1}}}}}}},
        {"materials",
         {{{"doubleSided", true}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"extensions", chalk}},
          {{"emissiveFactor", {1, 1, 1}},
           {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
           {"extensions", chalk}}}},
        {"animations", {motion("walk", 3, walk_times, walk), motion("rise", 2, rise_times, rise)}},
        {"accessors", accessors},
        {"bufferViews", views},
        {"buffers", {{{"byteLength", bytes.size()}, {"uri", "room.bin"}}}}};
    return {root.dump(), bytes};
}

}  // namespace nearlight::core
