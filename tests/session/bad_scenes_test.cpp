// SPDX-License-Identifier: Apache-2.0
// Scenes with numbers and images that make no sense: each gets one warning that names file and line, and a
// picture without NaN.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/image/image_io.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_files.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class BadScenes : public test::DeviceTest {
  protected:
    BadScenes() {
        const float nan = std::numeric_limits<float>::quiet_NaN();
        write_image(files_.path("nan.exr"), {2, 1, {"R", "G", "B"}, {nan, 0.5f, 0.5f, 0.2f, 0.4f, 0.6f}});
        write_image(files_.path("black.exr"), {1, 1, {"R", "G", "B"}, {0, 0, 0}});
        write_image(files_.path("high.exr"), {2, 1, {"R", "G", "B"}, {7, 7, 7, 0, 0, 0}});
        // The normals are (0, 0, −0.8), which points below the surface, and about zero, which points nowhere.
        write_image(files_.path("below.exr"), {2, 1, {"R", "G", "B"}, {0.5f, 0.5f, 0.1f, 0.5f, 0.5f, 0.5f}});
    }

    /// A box under a lamp, seen from inside, with a thing in it.
    Scene load(const std::string& thing) const {
        return files_.load_xml(
            thing +
            "<sensor type='perspective'><film type='hdrfilm'><integer name='width' value='16'/>"
            "<integer name='height' value='16'/></film><transform name='to_world'>"
            "<lookat origin='0,0,0.95' target='0,0,0' up='0,1,0'/></transform></sensor>"
            "<shape type='cube'><bsdf type='twosided'><bsdf type='diffuse'/></bsdf></shape>"
            "<shape type='rectangle'><transform name='to_world'><scale value='0.3'/><rotate x='1' "
            "angle='90'/><translate y='0.95'/></transform><emitter type='area'><rgb name='radiance' "
            "value='9'/></emitter></shape>");
    }
    static std::string ball(const std::string& material) {
        return "<shape type='sphere'><float name='radius' value='0.5'/>" + material + "</shape>";
    }
    static std::string bsdf(const std::string& type, const std::string& body) {
        return "<bsdf type='" + type + "'>" + body + "</bsdf>";
    }
    static std::string bitmap(const std::string& name, const std::string& file) {
        return "<texture type='bitmap' name='" + name + "'><boolean name='raw' value='true'/>" +
               "<string name='filename' value='" + file + "'/></texture>";
    }

    /// Renders the scene, and expects the number of warnings about its second line, where the thing is.
    void expect_picture(Device& device, const std::string& thing, std::size_t warnings) const {
        SCOPED_TRACE(thing);
        const Scene scene = load(thing);
        std::size_t found = 0;
        for (const Note& note : scene.notes) {
            found += test::mentions(to_string(note), "scene.xml:2: ") ? 1 : 0;
        }
        EXPECT_EQ(found, warnings);
        RenderSettings settings = test::few_vpls();
        settings.view.max_depth = 6;
        double sum = 0;
        for (const float value : test::render_image(device, scene, settings).image.values) {
            ASSERT_TRUE(std::isfinite(value));
            sum += static_cast<double>(std::abs(value));
        }
        EXPECT_GT(sum, 0.0);
    }

    test::SceneFiles files_;
};

TEST_F(BadScenes, MaterialsGiveAPictureWithoutNan) {
    on_each_device([&](Device& device) {
        const std::string grey = bsdf("diffuse", "");
        const auto number = [](const std::string& name, const std::string& value) {
            return "<float name='" + name + "' value='" + value + "'/>";
        };
        const auto rgb = [](const std::string& name, const std::string& value) {
            return "<rgb name='" + name + "' value='" + value + "'/>";
        };
        const std::pair<std::string, std::size_t> cases[] = {
            {bsdf("roughconductor", number("alpha", "0")), 1},
            {bsdf("roughdielectric", number("alpha", "0")), 1},
            {bsdf("principled", number("roughness", "7")), 1},
            {bsdf("principled", number("roughness", "0") + number("metallic", "1")), 0},
            {bsdf("dielectric", number("int_ior", "1") + number("ext_ior", "1")), 1},
            {bsdf("roughdielectric", number("int_ior", "1.000277")), 1},
            {bsdf("plastic", number("int_ior", "0.7")), 1},
            {bsdf("dielectric", number("int_ior", "0.7")), 1},
            {bsdf("plastic", rgb("diffuse_reflectance", "0")), 0},
            {bsdf("plastic", rgb("diffuse_reflectance", "3")), 1},
            {bsdf("roughplastic", rgb("diffuse_reflectance", "1") + number("alpha", "1")), 0},
            {bsdf("diffuse", rgb("reflectance", "1.2")), 1},
            {bsdf("mask", number("opacity", "1.4") + grey), 1},
            {bsdf("mask", number("opacity", "-0.4") + grey), 1},
            {bsdf("mask", bitmap("opacity", "high.exr") + grey), 0},
            {bsdf("normalmap", bitmap("normalmap", "below.exr") + grey), 1},
            {bsdf("normalmap", bitmap("normalmap", "below.exr") + bsdf("plastic", "")), 1},
            {bsdf("diffuse", bitmap("reflectance", "nan.exr")), 1},
            {bsdf("principled", bitmap("base_color", "nan.exr")), 1},
            {bsdf("principled", bitmap("roughness", "high.exr") + bitmap("metallic", "high.exr")), 0},
            {bsdf("roughconductor", bitmap("alpha", "high.exr")), 0},
        };
        for (const auto& [material, warnings] : cases) {
            expect_picture(device, ball(material), warnings);
        }
    });
}

TEST_F(BadScenes, LightsGiveAPictureWithoutNan) {
    on_each_device([&](Device& device) {
        const std::string glass = ball(bsdf("dielectric", ""));
        const std::string bulb =
            "<shape type='sphere'><float name='radius' value='0.2'/><emitter type='area'><rgb "
            "name='radiance' value='3'/>"
            "</emitter></shape>";
        const std::string point = "<emitter type='point'/>";
        expect_picture(device, glass + bulb, 0);
        expect_picture(device, glass + point, 0);
        expect_picture(device, "<emitter type='envmap'><string name='filename' value='black.exr'/></emitter>",
                       1);
        expect_picture(device, "<emitter type='envmap'><string name='filename' value='nan.exr'/></emitter>",
                       1);
        expect_picture(device,
                       "<emitter type='sunsky'><vector name='sun_direction' value='0,0,-1'/></emitter>", 1);
    });
}

/// A square whose emissive texture asks for second texture coordinates, of which its mesh has none. All of it
/// shines as the lower left texel does.
TEST_F(BadScenes, MeshesWithoutTheCoordinatesOfATextureShowOneTexel) {
    write_image(files_.path("four.exr"), {2, 2, {"R", "G", "B"}, {1, 1, 1, 2, 2, 2, 3, 4, 5, 6, 6, 6}});
    test::GltfText gltf;
    gltf.add_square();
    gltf.material() = {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}};
    gltf.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {1e-4, 1e-4, 1e-4, 1}},
                                               {"baseColorTexture", {{"index", 0}}},
                                               {"metallicFactor", 0}};
    gltf.root["images"] = {{{"uri", "four.exr"}}};
    gltf.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf.root["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33071}}};
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    gltf.root["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"camera", 0}, {"translation", {0.5, 0.5, 1}}}};
    const Scene scene = load_scene(files_.write("scene.gltf", gltf.text()));
    ASSERT_TRUE(std::ranges::any_of(scene.textures, [](const SceneTexture& texture) {
        return texture.parameters.flags == NEARLIGHT_TEXTURE_SECOND_UV;
    }));
    on_each_device([&](Device& device) {
        RenderSettings settings = test::few_vpls();
        settings.view.width = settings.view.height = 4;
        const Image image = test::render_image(device, scene, settings).image;
        for (std::size_t pixel = 0; pixel < 16; ++pixel) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                EXPECT_NEAR(image.values[pixel * image.channel_count() + channel],
                            static_cast<float>(3 + channel), 0.01f);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
