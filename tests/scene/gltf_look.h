// SPDX-License-Identifier: Apache-2.0
// What tests of glTF materials have in common.
#pragma once

#include <gmock/gmock.h>

#include "host/image/image_io.h"
#include "tests/scene/gltf_text.h"

namespace nearlight::core::test {

inline Material top_material(const Scene& scene) {
    return scene.materials.at(scene.triangles.at(0).material);
}

/// The material behind wrappers that have one child.
inline Material innermost(const Scene& scene) {
    Material material = top_material(scene);
    while (material.model >= NEARLIGHT_BSDF_MASK) {
        material = scene.materials.at(material.child[0]);
    }
    return material;
}

inline void expect_note(const Scene& scene, const std::string& text) {
    EXPECT_THAT(scene.notes, testing::Contains(testing::Field(&Note::text, testing::HasSubstr(text))));
}

class GltfLook : public GltfLoader {
  protected:
    /// Texture 0: one texel of these numbers.
    void add_texel(const std::vector<float>& rgba) {
        write_image(files_.path("texel.exr"), {1, 1, {"R", "G", "B", "A"}, rgba});
        gltf_.root["images"] = {{{"uri", "texel.exr"}}};
        gltf_.root["textures"] = {{{"source", 0}}};
    }
    /// Texture 0: two texels side by side, between which nothing is blended.
    void add_two_texels(const std::vector<float>& rgba) {
        write_image(files_.path("two.exr"), {2, 1, {"R", "G", "B", "A"}, rgba});
        gltf_.root["images"] = {{{"uri", "two.exr"}}};
        gltf_.root["samplers"] = {{{"magFilter", 9728}}};
        gltf_.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    }
    json& extension(const std::string& name) { return gltf_.material()["extensions"][name]; }
};

}  // namespace nearlight::core::test
