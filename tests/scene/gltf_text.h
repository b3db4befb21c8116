// SPDX-License-Identifier: Apache-2.0
// glTF files that tests put together, and a fixture that loads them.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/scene/scene_files.h"

namespace nearlight::core::test {

using nlohmann::json;

inline std::string base64(const std::string& bytes) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        uint word = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            word = word << 8u | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63u];
        }
    }
    return text;
}

inline std::string from_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    uint word = 0;
    uint bits = 0;
    for (const char c : text.substr(0, text.find('='))) {
        word = word << 6u | static_cast<uint>(digits.find(c));
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes += static_cast<char>(word >> bits & 255u);
        }
    }
    return bytes;
}

/// A file to be built, with all numbers in one buffer.
struct GltfText {
    json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},  {"nodes", {{{"mesh", 0}, {"name", "thing"}}}},
                 {"bufferViews", json::array()},  {"accessors", json::array()}};
    std::string bytes;

    int view(const std::string& data) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
        bytes += data;
        return static_cast<int>(root["bufferViews"].size() - 1);
    }
    template <typename T>
    static std::string raw(const std::vector<T>& values) {
        return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
    }
    template <typename T>
    int accessor(const std::vector<T>& values, int component_type, const char* type, std::size_t components,
                 bool normalized = false) {
        root["accessors"].push_back({{"bufferView", view(raw(values))},
                                     {"componentType", component_type},
                                     {"count", values.size() / components},
                                     {"type", type},
                                     {"normalized", normalized}});
        return static_cast<int>(root["accessors"].size() - 1);
    }
    int points(const std::vector<float>& values) { return accessor(values, 5126, "VEC3", 3); }

    /// A unit square in the plane z = 0, seen from +z, of material 0.
    void add_square() {
        const int positions = points({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        const int uvs = accessor(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2", 2);
        const int indices = accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
        root["meshes"] = {{{"primitives",
                            {{{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                              {"indices", indices},
                              {"material", 0}}}}}};
        root["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
    }
    [[nodiscard]] json& primitive() { return root["meshes"][0]["primitives"][0]; }
    [[nodiscard]] json& material() { return root["materials"][0]; }

    [[nodiscard]] std::string text() const {
        json whole = root;
        whole["buffers"] = {
            {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        return whole.dump();
    }
    [[nodiscard]] std::string binary() const {
        json whole = root;
        whole["buffers"] = {{{"byteLength", bytes.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string data = bytes;
        data.resize((data.size() + 3) / 4 * 4);
        const auto word = [](std::size_t value) {
            return raw(std::vector{static_cast<std::uint32_t>(value)});
        };
        return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" + text +
               word(data.size()) + std::string("BIN\0", 4) + data;
    }
};

class GltfLoader : public testing::Test {
  protected:
    GltfLoader() { gltf_.add_square(); }
    Scene load(const LoadOptions& options = {}) const {
        return load_scene(files_.write("scene.gltf", gltf_.text()), options);
    }
    [[nodiscard]] std::string error() const {
        return file_error([&] { load(); });
    }

    SceneFiles files_;
    GltfText gltf_;
};

/// The position of a corner of a triangle, k from 0 to 2.
inline Vec3 corner(const Scene& scene, std::size_t triangle, int k) {
    const Triangle& t = scene.triangles.at(triangle);
    return scene.vertices.at(k == 0 ? t.v0 : k == 1 ? t.v1 : t.v2).position;
}

inline void expect_close(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
    EXPECT_LT(length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

}  // namespace nearlight::core::test
