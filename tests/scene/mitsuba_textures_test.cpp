// SPDX-License-Identifier: Apache-2.0
// Bitmaps and checkerboards of Mitsuba's files as parameters of materials.
#include "host/image/image_io.h"
#include "host/scene/texture.h"
#include "tests/scene/mitsuba_material.h"

namespace nearlight::core {
namespace {

using namespace test;

using MitsubaTextures = MitsubaMaterial;

TEST_F(MitsubaTextures, NumbersAreTheLuminanceOfColours) {
    write_image(files_.path("green.png"), {1, 1, {"R", "G", "B"}, {0, 1, 0}});
    const Material metal = load("roughconductor", bitmap("alpha", "green.png"));
    expect_near(value(metal.roughness), Vec3{1, 1, 1} * 0.71516f, 1e-3f);
}

TEST_F(MitsubaTextures, WrapModesFiltersAndGamma) {
    write_pair("half.png", srgb_decode_table()[128], 1.0f);
    const Material material =
        load("diffuse", bitmap("reflectance", "half.png",
                               text("wrap_mode", "mirror") + text("wrapModeV", "clamp") +
                                   text("filterType", "nearest") + number("gamma", "2")));
    const Texture& texture = scene_.textures.at(0).parameters;
    EXPECT_EQ(texture.wrap_s, NEARLIGHT_WRAP_MIRROR);
    EXPECT_EQ(texture.wrap_t, NEARLIGHT_WRAP_CLAMP);
    EXPECT_EQ(texture.filter, NEARLIGHT_FILTER_NEAREST);
    EXPECT_NEAR(value(material.reflectance).x, 0.25196f, 2e-4f);
    EXPECT_EQ(notes_on_line_2(""), 0u);
}

TEST_F(MitsubaTextures, OneChannelOfABitmap) {
    write_image(files_.path("blue.png"), {1, 1, {"R", "G", "B"}, {0, 0, srgb_decode_table()[128]}});
    const auto reflectance = [&](const char* channel) {
        return value(
            load("diffuse", bitmap("reflectance", "blue.png", text("channel", channel))).reflectance);
    };
    expect_near(reflectance("b"), Vec3{1, 1, 1} * srgb_decode_table()[128]);
    expect_near(reflectance("R"), Vec3{0, 0, 0});
    expect_near(reflectance("a"), Vec3{1, 1, 1});
    EXPECT_NE(file_error([&] { reflectance("q"); }).find("channel 'q' is not supported"), std::string::npos);
}

TEST_F(MitsubaTextures, CheckerboardsOfTexturesAndOfNumbers) {
    write_pair("ramp.png", 0.0f, 1.0f);
    const std::string board = "<texture type='checkerboard' name='NAME'>" +
                              bitmap("color0", "ramp.png", "<boolean name='raw' value='true'/>") +
                              rgb("color1", "0.3") + "</texture>";
    const auto named = [&](const std::string& name) {
        return std::string(board).replace(board.find("NAME"), 4, name);
    };
    const Material diffuse = load("diffuse", named("reflectance"));
    EXPECT_FLOAT_EQ(value(diffuse.reflectance, 0.75f, 0.25f).x, 1.0f);
    EXPECT_FLOAT_EQ(value(diffuse.reflectance, 0.75f, 0.75f).x, 0.3f);
    // Mitsuba 3.9.1 exchanges the fields where a checkerboard stands for a number.
    const Material mask = load("mask", named("opacity") + "<bsdf type='diffuse'/>");
    EXPECT_FLOAT_EQ(value(mask.reflectance, 0.75f, 0.25f).x, 0.3f);
    EXPECT_FLOAT_EQ(value(mask.reflectance, 0.75f, 0.75f).x, 1.0f);
}

}  // namespace
}  // namespace nearlight::core
