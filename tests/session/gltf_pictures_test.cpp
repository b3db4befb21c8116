// SPDX-License-Identifier: Apache-2.0
// Pictures of glTF files: what its materials become must look as the file says, on the device.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/image/image_io.h"
#include "tests/scene/gltf_text.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using test::json;

constexpr int kPictureSize = 8;  // pixels

class GltfPictures : public test::DeviceTest {
  protected:
    GltfPictures() {
        gltf_.add_square();
        gltf_.root["cameras"] = {
            {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1}, {"znear", 0.1}}}}};
        gltf_.root["nodes"] = {{{"mesh", 0}}, {{"camera", 0}, {"translation", {0.5, 0.5, 1}}}};
        gltf_.root["scenes"][0]["nodes"] = {0, 1};
    }

    /// The red of a picture, a mean of 64 rays a pixel. Light may pass through a lamp and its back, which
    /// count as surfaces of its path.
    [[nodiscard]] std::vector<float> red(Device& device, const std::string& environment) const {
        LoadOptions options;
        options.overrides.environment = environment;
        const Scene scene = load_scene(files_.write("scene.gltf", gltf_.text()), options);
        RenderSettings settings = test::few_vpls();
        settings.view.width = settings.view.height = kPictureSize;
        settings.view.max_depth = 4;
        settings.gather.samples_per_pixel = 64;
        const Image image = test::render_image(device, scene, settings).image;
        std::vector<float> values;
        for (std::size_t i = 0; i < image.values.size(); i += image.channel_count()) {
            values.push_back(image.values[i]);
        }
        return values;
    }
    static float mean(const std::vector<float>& values) {
        double sum = 0;
        for (const float value : values) {
            sum += static_cast<double>(value);
        }
        return static_cast<float>(sum / static_cast<double>(values.size()));
    }

    test::SceneFiles files_;
    test::GltfText gltf_;
};

/// A black lamp of the opacity ¼ before a radiance of 2: ¼·8 + ¾·2. It is the same from behind.
TEST_F(GltfPictures, TransparentLampsLookAlikeFromBothSides) {
    gltf_.material() = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0, 0, 0, 0.25}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
        {"extensions",
         {{"KHR_materials_specular", {{"specularFactor", 0}}},
          {"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}},
        {"alphaMode", "BLEND"},
        {"emissiveFactor", {1, 1, 1}},
        {"doubleSided", true}};
    on_each_device([&](Device& device) {
        const float expected = 0.25f * 8 + 0.75f * 2;
        EXPECT_NEAR(mean(red(device, "2")), expected, 0.03f * expected);
        gltf_.root["nodes"][1] = {{"camera", 0}, {"translation", {0.5, 0.5, -1}}, {"rotation", {0, 1, 0, 0}}};
        EXPECT_NEAR(mean(red(device, "2")), expected, 0.03f * expected);
    });
}

/// Alphas of vertices fade a black square before a radiance of 1 from the left to the right.
TEST_F(GltfPictures, AlphasOfVerticesFade) {
    gltf_.material() = {{"pbrMetallicRoughness",
                         {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                        {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}},
                        {"alphaMode", "BLEND"}};
    gltf_.primitive()["attributes"]["COLOR_0"] =
        gltf_.accessor(std::vector<float>{1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0}, 5126, "VEC4", 4);
    on_each_device([&](Device& device) {
        const std::vector<float> values = red(device, "1");
        const float width = 2 * std::tan(0.35f);  // of the picture, at the distance of the square
        for (int column = 0; column < kPictureSize; ++column) {
            float sum = 0;
            for (int row = 0; row < kPictureSize; ++row) {
                sum += values[static_cast<std::size_t>(row * kPictureSize + column)] / kPictureSize;
            }
            const float alpha = 0.5f + width * ((static_cast<float>(column) + 0.5f) / kPictureSize - 0.5f);
            EXPECT_NEAR(sum, 1 - alpha, 0.08f) << column;
        }
    });
}

/// What facets of roughness 1 and index 1.5 reflect is 0.0127 of the light head-on, and 0.0141 at the corners
/// of the picture (transmission_curve_test.cpp); in the mean over the picture 0.0131.
TEST_F(GltfPictures, BlackClothIsNotQuiteBlack) {
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}}};
    on_each_device(
        [&](Device& device) { EXPECT_NEAR(mean(red(device, "2")), 2 * 0.0131f, 0.05f * 2 * 0.0131f); });
}

/// A curtain that reflects 0.4 of a quarter of the light, and lets 0.8 of the rest through.
TEST_F(GltfPictures, LightDiffusesThroughCurtains) {
    gltf_.material() = {
        {"pbrMetallicRoughness", {{"baseColorFactor", {0.4, 1, 1, 1}}, {"metallicFactor", 0}}}};
    gltf_.material()["extensions"] = {
        {"KHR_materials_specular", {{"specularFactor", 0}}},
        {"KHR_materials_diffuse_transmission",
         {{"diffuseTransmissionFactor", 0.75}, {"diffuseTransmissionColorFactor", {0.8, 0, 0}}}}};
    on_each_device([&](Device& device) {
        const float expected = 2 * (0.25f * 0.4f + 0.75f * 0.8f);
        EXPECT_NEAR(mean(red(device, "2")), expected, 0.03f * expected);
    });
    // A point light of 1 W/sr, 1 m behind the middle of the curtain.
    gltf_.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}}};
    gltf_.root["nodes"].push_back(
        {{"translation", {0.5, 0.5, -1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf_.root["scenes"][0]["nodes"] = {0, 1, 2};
    on_each_device([&](Device& device) {
        const float step = 2 * std::tan(0.35f) / kPictureSize;
        float expected = 0;
        for (int pixel = 0; pixel < kPictureSize * kPictureSize; ++pixel) {
            const float x = step * (static_cast<float>(pixel % kPictureSize) + 0.5f - kPictureSize / 2);
            const float y = step * (static_cast<float>(pixel / kPictureSize) + 0.5f - kPictureSize / 2);
            const float passed = 0.75f * 0.8f / std::numbers::pi_v<float>;
            expected += passed * std::pow(1 + x * x + y * y, -1.5f) / (kPictureSize * kPictureSize);
        }
        EXPECT_NEAR(mean(red(device, "0")), expected, 0.05f * expected);
    });
}

/// A square with a normal map, its lamp and its camera, and all of them mirrored.
TEST_F(GltfPictures, ThingsThatAreMirroredMakeAMirroredPicture) {
    write_image(files_.path("tilted.exr"), {1, 1, {"R", "G", "B"}, {0.8f, 0.65f, 0.9f}});
    gltf_.root["images"] = {{{"uri", "tilted.exr"}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    gltf_.material() = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                        {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}},
                        {"normalTexture", {{"index", 0}}}};
    gltf_.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1, 2};
    const auto picture = [&](Device& device, double side) {
        gltf_.root["nodes"] = {{{"mesh", 0}, {"scale", {side, 1, 1}}},
                               {{"camera", 0}, {"translation", {0.5 * side, 0.5, 1}}},
                               {{"translation", {1.5 * side, 0.9, 1}},
                                {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
        return red(device, "0");
    };
    on_each_device([&](Device& device) {
        const std::vector<float> straight = picture(device, 1);
        const std::vector<float> mirrored = picture(device, -1);
        EXPECT_GT(mean(straight), 0.05f);
        for (std::size_t i = 0; i < straight.size(); ++i) {
            const std::size_t row = i / kPictureSize;
            const std::size_t other = row * kPictureSize + (kPictureSize - 1 - i % kPictureSize);
            EXPECT_NEAR(straight[i], mirrored[other], 0.03f * straight[i]) << i;
        }
    });
}

}  // namespace
}  // namespace nearlight::core
