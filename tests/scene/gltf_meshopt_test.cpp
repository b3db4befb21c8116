// SPDX-License-Identifier: Apache-2.0
// Buffer views that meshoptimizer compressed. The bytes here are those of its encoder, version 0.18.
#include "host/scene/gltf/meshopt.h"

#include <gmock/gmock.h>

#include "tests/scene/gltf_text.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using namespace test;

/// The corners of a rectangle of 4 by 2, with the filter EXPONENTIAL.
constexpr const char* kPositions =
    "oAABMwAAAEA/AAExAAAABgABDwAAACAgAAExAAAABgAAAAExAAAABgAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA8gAAAPIAAADy";
/// (0, 0, 1), (0.6, 0, 0.8), (0, −0.6, 0.8) and (0, 0, −1), with the filter OCTAHEDRAL.
constexpr const char* kNormals = "oAE/AAAAbGv+AQ8AAABrlQAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAfwA=";
/// No rotation, and 90 degrees about z, with the filter QUATERNION.
constexpr const char* kRotations = "oAEQAAAAATAAAAAOAAAAAAEQAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAP8H";
/// 0 1 2, 0 2 3 as triangles, and as a sequence.
constexpr const char* kTriangles = "4fAAAHaHVmd4qYZliWiYAWkAAA==";
constexpr const char* kSequence = "0QAEBAYIBAAAAAA=";

class GltfMeshopt : public GltfLoader {
  protected:
    GltfMeshopt() {
        gltf_.root["extensionsUsed"] = {extension_, "KHR_mesh_quantization"};
        gltf_.root["extensionsRequired"] = {extension_};
        gltf_.primitive()["attributes"] = {
            {"POSITION", compressed(kPositions, 4, 12, "ATTRIBUTES", "EXPONENTIAL", 5126, "VEC3")},
            {"NORMAL", compressed(kNormals, 4, 4, "ATTRIBUTES", "OCTAHEDRAL", 5120, "VEC3")}};
        gltf_.root["accessors"].back()["normalized"] = true;
        gltf_.primitive()["indices"] = compressed(kTriangles, 6, 4, "TRIANGLES", "NONE", 5125, "SCALAR");
    }

    void SetUp() override {
        if (!gltf::can_decode_meshopt()) {
            GTEST_SKIP() << "this build has no meshoptimizer";
        }
    }

    /// An accessor of a view that refers to a second buffer, which is not there.
    std::size_t compressed(const char* bytes, int count, int stride, const char* mode, const char* filter,
                           int component_type, const char* type) {
        json& view = gltf_.root["bufferViews"][static_cast<std::size_t>(gltf_.view(from_base64(bytes)))];
        view["extensions"][extension_] = {{"buffer", 0},
                                          {"byteOffset", view["byteOffset"]},
                                          {"byteLength", view["byteLength"]},
                                          {"byteStride", stride},
                                          {"count", count},
                                          {"mode", mode},
                                          {"filter", filter}};
        view["buffer"] = 1;
        view["byteOffset"] = 0;
        view["byteLength"] = count * stride;
        if (std::string_view(mode) == "ATTRIBUTES") {
            view["byteStride"] = stride;
        }
        gltf_.root["accessors"].push_back({{"bufferView", gltf_.root["bufferViews"].size() - 1},
                                           {"componentType", component_type},
                                           {"count", count},
                                           {"type", type}});
        return gltf_.root["accessors"].size() - 1;
    }

    [[nodiscard]] json& compression_of_positions() {
        const json& accessor =
            gltf_.root["accessors"][std::size_t{gltf_.primitive()["attributes"]["POSITION"]}];
        return gltf_.root["bufferViews"][std::size_t{accessor["bufferView"]}]["extensions"][extension_];
    }

    [[nodiscard]] json with_stand_in(const std::string& text) const {
        json whole = json::parse(text);
        whole["buffers"].push_back(stand_in_);
        return whole;
    }
    Scene load_compressed() const {
        return load_scene(files_.write("scene.gltf", with_stand_in(gltf_.text()).dump()));
    }
    [[nodiscard]] std::string compressed_error() const {
        return file_error([&] { load_compressed(); });
    }

    const char* extension_ = "EXT_meshopt_compression";
    json stand_in_ = {{"byteLength", 4096}};
};

void expect_rectangle(const Scene& scene) {
    ASSERT_EQ(scene.triangles.size(), 2u);
    expect_close(corner(scene, 0, 1), {4, 0, 0}, 1e-3f);
    expect_close(corner(scene, 0, 2), {4, 2, 0}, 1e-3f);
    expect_close(corner(scene, 1, 2), {0, 2, 0}, 1e-3f);
}

TEST_F(GltfMeshopt, MeshesAreDecoded) {
    const Scene scene = load_compressed();
    expect_rectangle(scene);
    expect_close(scene.vertices.at(scene.triangles[0].v1).normal, {0.6f, 0, 0.8f}, 0.01f);
    expect_close(scene.vertices.at(scene.triangles[0].v2).normal, {0, -0.6f, 0.8f}, 0.01f);
}

TEST_F(GltfMeshopt, IndicesMayBeASequence) {
    gltf_.primitive()["indices"] = compressed(kSequence, 6, 2, "INDICES", "NONE", 5123, "SCALAR");
    expect_rectangle(load_compressed());
}

TEST_F(GltfMeshopt, InstancesMayBeCompressed) {
    gltf_.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"ROTATION", compressed(kRotations, 2, 8, "ATTRIBUTES", "QUATERNION", 5122, "VEC4")}};
    gltf_.root["accessors"].back()["normalized"] = true;
    const Scene scene = load_compressed();
    ASSERT_EQ(scene.triangles.size(), 4u);
    expect_close(corner(scene, 2, 1), {0, 4, 0}, 0.01f);
}

TEST_F(GltfMeshopt, TheBufferThatStandsInIsNotRead) {
    stand_in_["uri"] = "no-such-file.bin";
    stand_in_["extensions"][extension_]["fallback"] = true;
    gltf_.root.erase("extensionsRequired");
    expect_rectangle(load_compressed());
}

TEST_F(GltfMeshopt, BinaryFilesKeepTheirOwnBuffer) {
    GltfText binary = gltf_;
    std::string file = binary.binary();
    // The container's own JSON names one buffer; another is put behind it.
    const std::string one = R"("buffers":[{"byteLength":)";
    const std::size_t end = file.find('}', file.find(one));
    const std::string two = R"(,{"byteLength":4096})";
    file.insert(end + 1, two);
    const auto grow = [&](std::size_t at) {
        std::uint32_t length = 0;
        std::memcpy(&length, file.data() + at, sizeof length);
        length += static_cast<std::uint32_t>(two.size());
        std::memcpy(file.data() + at, &length, sizeof length);
    };
    grow(8);
    grow(12);
    expect_rectangle(load_scene(files_.write("scene.glb", file)));
}

TEST_F(GltfMeshopt, TheLaterNameMeansTheSame) {
    std::string text = with_stand_in(gltf_.text()).dump();
    for (std::size_t at = text.find("EXT_meshopt"); at != std::string::npos; at = text.find("EXT_meshopt")) {
        text.replace(at, 3, "KHR");
    }
    expect_rectangle(load_scene(files_.write("scene.gltf", text)));
}

/// A file of a few kilobytes must not fill the memory by naming the same bytes many times.
TEST_F(GltfMeshopt, ManyViewsOfTheSameBytesAreAnError) {
    const json view = gltf_.root["bufferViews"].back();
    for (int i = 0; i < 100; ++i) {
        gltf_.root["bufferViews"].push_back(view);
    }
    load_compressed();
    for (int i = 0; i < 40000; ++i) {
        gltf_.root["bufferViews"].push_back(view);
    }
    EXPECT_THAT(compressed_error(), HasSubstr("of the same compressed bytes"));
}

TEST_F(GltfMeshopt, BrokenViewsAreErrors) {
    const json whole = compression_of_positions();
    const auto error_with = [&](const char* key, const json& value) {
        compression_of_positions() = whole;
        compression_of_positions()[key] = value;
        return compressed_error();
    };
    EXPECT_THAT(error_with("byteLength", 40), HasSubstr("cannot be decoded"));
    EXPECT_THAT(error_with("byteLength", 1 << 30), HasSubstr("beyond the end of its compressed buffer"));
    EXPECT_THAT(error_with("byteOffset", -1), HasSubstr("byteOffset is not a whole number"));
    EXPECT_THAT(error_with("buffer", 7), HasSubstr("refers to buffer 7"));
    EXPECT_THAT(error_with("byteStride", 0), HasSubstr("which is impossible"));
    EXPECT_THAT(error_with("byteStride", 10), HasSubstr("cannot have"));
    EXPECT_THAT(error_with("count", 2000000000), HasSubstr("which is impossible"));
    EXPECT_THAT(error_with("mode", "TRIANGLES"), HasSubstr("cannot have"));
    EXPECT_THAT(error_with("mode", "POINTS"), HasSubstr("mode 'POINTS'"));
    EXPECT_THAT(error_with("filter", "COLOR"), HasSubstr("filter 'COLOR'"));
    EXPECT_THAT(error_with("filter", "QUATERNION"), HasSubstr("cannot have"));
}

}  // namespace
}  // namespace nearlight::core
