// SPDX-License-Identifier: Apache-2.0
// Buffers in files, in data URIs and in the chunks of a .glb.
#include "host/scene/gltf/buffers.h"

#include <gmock/gmock.h>

#include "tests/scene/gltf_text.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using namespace test;

constexpr const char* kDataHead = "data:application/octet-stream;base64,";

std::string word(std::size_t value) {
    return GltfText::raw(std::vector{static_cast<std::uint32_t>(value)});
}

std::string chunk(const std::string& type, std::string bytes) {
    bytes.resize((bytes.size() + 3) / 4 * 4, type == "JSON" ? ' ' : '\0');
    return word(bytes.size()) + type + bytes;
}

class GltfBuffers : public GltfLoader {
  protected:
    /// The JSON with one buffer of the length that it needs.
    [[nodiscard]] std::string with_buffer(json buffer) const {
        json whole = gltf_.root;
        buffer["byteLength"] = gltf_.bytes.size();
        whole["buffers"] = {std::move(buffer)};
        return whole.dump();
    }
    Scene load_uri(const std::string& uri) const {
        return load_scene(files_.write("scene.gltf", with_buffer({{"uri", uri}})));
    }
    Scene load_chunks(const std::string& chunks) const {
        return load_scene(files_.write("scene.glb", "glTF" + word(2) + word(12 + chunks.size()) + chunks));
    }
    [[nodiscard]] std::string bin() const { return chunk(std::string("BIN\0", 4), gltf_.bytes); }
};

TEST_F(GltfBuffers, MayBeLongerThanTheyNeedToBe) {
    const std::string longer = gltf_.bytes + std::string(5, 'x');
    files_.write("longer.bin", longer);
    for (const Scene& scene : {load_uri("longer.bin"), load_uri(kDataHead + base64(longer))}) {
        EXPECT_EQ(scene.triangles.size(), 2u);
        expect_close(corner(scene, 1, 2), {0, 1, 0});
    }
}

TEST_F(GltfBuffers, OnlyTheirLengthCounts) {
    const std::string longer = gltf_.bytes + gltf_.bytes;
    gltf_.root["bufferViews"][0]["byteOffset"] = gltf_.bytes.size();
    EXPECT_THAT(file_error([&] { load_uri(kDataHead + base64(longer)); }),
                HasSubstr("buffer view 0 reaches beyond the end of its buffer"));
}

TEST_F(GltfBuffers, ThatAreTooShortAreRefused) {
    const std::string shorter = gltf_.bytes.substr(0, gltf_.bytes.size() - 1);
    files_.write("shorter.bin", shorter);
    const std::string needed = std::to_string(gltf_.bytes.size());
    const std::string has = " has only " + std::to_string(shorter.size()) + " bytes, but its byteLength is ";
    EXPECT_THAT(file_error([&] { load_uri("shorter.bin"); }),
                HasSubstr("buffer 0 in 'shorter.bin'" + has + needed));
    EXPECT_THAT(file_error([&] { load_uri(kDataHead + base64(shorter)); }),
                HasSubstr("buffer 0" + has + needed));
    EXPECT_THAT(file_error([&] { load_chunks(chunk("JSON", with_buffer(json::object()))); }),
                HasSubstr("buffer 0 has only 0 bytes, but its byteLength is " + needed));
}

TEST_F(GltfBuffers, ThatAreNotThereAreNamed) {
    EXPECT_THAT(file_error([&] { load_uri("no such.bin"); }), HasSubstr("buffer 0 cannot be read: "));
    EXPECT_THAT(file_error([&] { load_uri("no%20such.bin"); }), HasSubstr("no such.bin: no such file"));
    files_.write("pointer.bin", "version https://git-lfs.github.com/spec/v1\noid sha256:1f\nsize 1152\n");
    EXPECT_THAT(file_error([&] { load_uri("pointer.bin"); }), HasSubstr("'git lfs pull'"));
    EXPECT_THAT(file_error([&] { load_uri("data:text/plain,abc"); }), HasSubstr("not in base64"));
    EXPECT_THAT(file_error([&] { load_scene(files_.write("scene.gltf", with_buffer(json::object()))); }),
                HasSubstr("buffer 0 has no URI"));
}

TEST_F(GltfBuffers, NamesOfFilesMayHaveAPlusSign) {
    files_.write("a+b c.bin", gltf_.bytes);
    EXPECT_EQ(load_uri("a+b c.bin").triangles.size(), 2u);
    EXPECT_EQ(load_uri("a%2Bb%20c.bin").triangles.size(), 2u);
}

TEST_F(GltfBuffers, DataMayBeOfAnyKind) {
    EXPECT_EQ(load_uri("data:;base64," + base64(gltf_.bytes)).triangles.size(), 2u);
    EXPECT_EQ(load_uri("data:application/gltf-buffer;base64," + base64(gltf_.bytes)).triangles.size(), 2u);
}

TEST_F(GltfBuffers, ChunksOfUnknownTypesAreIgnored) {
    const std::string text = chunk("JSON", with_buffer(json::object()));
    const std::string unknown = chunk("THAT", "what is this?");
    EXPECT_EQ(load_chunks(text + bin() + unknown).triangles.size(), 2u);
    EXPECT_EQ(load_chunks(text + unknown + bin()).triangles.size(), 2u);
    const std::string embedded = chunk("JSON", with_buffer({{"uri", kDataHead + base64(gltf_.bytes)}}));
    EXPECT_EQ(load_chunks(embedded + unknown).triangles.size(), 2u);
}

TEST_F(GltfBuffers, ABinaryChunkMayBeEmpty) {
    const std::string text = chunk("JSON", with_buffer({{"uri", kDataHead + base64(gltf_.bytes)}}));
    EXPECT_EQ(load_chunks(text + chunk(std::string("BIN\0", 4), "")).triangles.size(), 2u);
}

TEST_F(GltfBuffers, ChunksThatReachBeyondTheFileAreRefused) {
    const std::string text = chunk("JSON", with_buffer(json::object()));
    std::string longer = bin();
    longer.replace(0, 4, word(longer.size()));  // eight bytes more than there are
    EXPECT_THAT(file_error([&] { load_chunks(text + longer); }),
                HasSubstr("not a valid glTF file: a chunk of " + std::to_string(longer.size()) +
                          " bytes ends after " + std::to_string(longer.size() - 8)));
}

/// The buffer views of images are kept from tinygltf, which looks them up without a check.
TEST_F(GltfBuffers, ImagesInBuffersAreFound) {
    const std::string pixels = "P6 2 1 255\n" + std::string("\xff\0\0\xff\0\0", 6);
    gltf_.root["images"] = {{{"bufferView", gltf_.view(pixels)}, {"mimeType", "image/png"}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    gltf_.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    for (const Scene& scene : {load(), load_chunks(chunk("JSON", with_buffer(json::object())) + bin())}) {
        ASSERT_EQ(scene.images.size(), 1u);
        EXPECT_EQ(scene.images[0].width, 2);
    }
    gltf_.root["images"][0]["bufferView"] = 99;
    EXPECT_THAT(error(), HasSubstr("image 0 refers to buffer view 99"));
    gltf_.root["images"][0]["bufferView"] = 1e30;
    EXPECT_THAT(error(), HasSubstr("not a valid glTF"));
}

}  // namespace
}  // namespace nearlight::core
