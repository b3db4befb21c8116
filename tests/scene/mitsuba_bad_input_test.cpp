// SPDX-License-Identifier: Apache-2.0
// Numbers and images that make no sense: each gets one warning that names file and line, and no NaN.
#include <limits>

#include "host/scene/material_model.h"
#include "tests/scene/mitsuba_material.h"

namespace nearlight::core {
namespace {

using namespace test;

using MitsubaBadInput = MitsubaMaterial;

/// A BSDF with numbers that make no sense, and the warning that it gets.
struct BadInput {
    const char* type;
    std::string body;
    const char* warning;
};

TEST_F(MitsubaBadInput, BadNumbersGetOneWarningAndAUsableMaterial) {
    const std::string diffuse = "<bsdf type='diffuse'/>";
    const BadInput cases[] = {
        {"roughconductor", number("alpha", "0"), "roughness of 0 makes a smooth surface"},
        {"roughconductor", number("alpha", "1.5"), "'alpha' lies outside 0 to 1"},
        {"roughplastic", number("alpha", "-1"), "'alpha' lies outside 0 to 1"},
        {"principled", number("roughness", "7"), "'roughness' lies outside 0 to 1"},
        {"dielectric", number("int_ior", "1") + number("ext_ior", "1"), "inside and outside are the same"},
        {"roughdielectric", number("int_ior", "1.000277"), "inside and outside are the same"},
        {"plastic", number("int_ior", "0.7"), "index of refraction is below 1"},
        {"plastic", number("int_ior", "0"), "'int_ior' is not greater than 0"},
        {"dielectric", number("ext_ior", "-2"), "'ext_ior' is not greater than 0"},
        {"diffuse", rgb("reflectance", "1.2 1 1"), "'reflectance' lies outside 0 to 1"},
        {"diffuse", rgb("reflectance", "-0.1"), "'reflectance' lies outside 0 to 1"},
        {"plastic", rgb("diffuse_reflectance", "3"), "'diffuse_reflectance' lies outside 0 to 1"},
        {"mask", number("opacity", "1.4") + diffuse, "'opacity' lies outside 0 to 1"},
        {"mask", number("opacity", "-0.4") + diffuse, "'opacity' lies outside 0 to 1"},
        {"blendbsdf", number("weight", "2") + diffuse + diffuse, "'weight' lies outside 0 to 1"},
        {"conductor", rgb("eta", "0") + rgb("k", "0"), "no metal has this 'eta' and 'k'"},
        {"conductor", rgb("eta", "-1") + rgb("k", "2"), "no metal has this 'eta' and 'k'"},
    };
    for (const BadInput& bad : cases) {
        SCOPED_TRACE(bad.type + bad.body);
        const Material material = load(bad.type, bad.body);
        EXPECT_EQ(notes_on_line_2(bad.warning), 1u);
        EXPECT_EQ(notes_on_line_2(""),
                  material.model == NEARLIGHT_BSDF_PLASTIC && bad.body == number("alpha", "-1") ? 2u : 1u);
        for (const Parameter Material::*member : kMaterialParameters) {
            const Vec3 v = (material.*member).value;
            EXPECT_TRUE(is_finite(v) && std::min({v.x, v.y, v.z}) >= 0.0f && max_component(v) <= 1.0f);
        }
        EXPECT_TRUE(is_finite(material.eta) && is_finite(material.k));
        EXPECT_GE(material.internal_reflectance, 0.0f);
        EXPECT_LT(material.internal_reflectance, 1.0f);
        for (const float t : scene_.transmission_curves) {
            EXPECT_TRUE(t >= 0.0f && t <= 1.0f) << t;
        }
    }
}

TEST_F(MitsubaBadInput, BlackIsNoBadAlbedo) {
    expect_near(load("plastic", rgb("diffuse_reflectance", "0")).reflectance.value, {0, 0, 0});
    EXPECT_EQ(notes_on_line_2(""), 0u);
}

TEST_F(MitsubaBadInput, BadTexelsGetOneWarning) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    write_image(files_.path("nan.exr"), {2, 1, {"R", "G", "B"}, {nan, 0.5f, 0.5f, -1, 1e30f, 2}});
    const Material material = load("diffuse", bitmap("reflectance", "nan.exr"));
    expect_near(value(material.reflectance, 0.25f), {0, 0.5f, 0.5f});
    expect_near(value(material.reflectance, 0.75f), {0, 65504, 2});
    EXPECT_EQ(notes_on_line_2("2 texels of 'nan.exr'"), 1u);
    write_image(files_.path("below.png"), {2, 1, {"R", "G", "B"}, {0.5f, 0.5f, 1, 0.5f, 0.5f, 0.1f}});
    load("normalmap",
         bitmap("normalmap", "below.png", "<boolean name='raw' value='true'/>") + "<bsdf type='diffuse'/>");
    EXPECT_EQ(notes_on_line_2("1 texels of the normal map 'below.png' point below"), 1u);
    load("normalmap", rgb("normalmap", "0.5, 0.5, 0.1") + "<bsdf type='diffuse'/>");
    EXPECT_EQ(notes_on_line_2("the normal of the normal map points below"), 1u);
}

TEST_F(MitsubaBadInput, BadEnvironmentsGetOneWarning) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    write_image(files_.path("nan.exr"), {2, 1, {"R", "G", "B"}, {nan, 0.5f, -0.5f, 1, 2, 3}});
    write_image(files_.path("black.exr"), {1, 1, {"R", "G", "B"}, {0, 0, 0}});
    const auto load_environment = [&](const std::string& file) {
        scene_ = files_.load_xml("<emitter type='envmap'>" + text("filename", file) + "</emitter>");
    };
    load_environment("nan.exr");
    EXPECT_EQ(notes_on_line_2("1 pixels of the environment are negative or not finite"), 1u);
    expect_near(scene_.environment.radiance.at(0), {0, 0.5f, 0});
    load_environment("black.exr");
    EXPECT_EQ(notes_on_line_2("the environment is black"), 1u);
}

}  // namespace
}  // namespace nearlight::core
