// SPDX-License-Identifier: Apache-2.0
// Numbers and images that make no sense: each gets one warning that names file and line, and no NaN.
#include <cmath>
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

TEST(MitsubaEmitter, LightsThatNothingFindsAreLeftOut) {
    const SceneFiles files;
    const Scene scene = files.load_xml(
        "<emitter type='point'><float name='sampling_weight' value='0'/></emitter><emitter type='point'/>");
    EXPECT_EQ(scene.delta_emitters.size(), 1u);
    EXPECT_TRUE(has_note(scene, "sampling_weight is 0"));
}

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

TEST_F(MitsubaBadInput, EmptyNamesOfFilesAreErrors) {
    const std::string empty = text("filename", "");
    for (const std::string type : {"obj", "ply", "serialized"}) {
        EXPECT_TRUE(mentions(file_error([&] { files_.load_xml(shape(type, empty)); }),
                             "scene.xml:2: the 'filename' of shape '" + type + "' is empty"));
    }
    EXPECT_TRUE(mentions(file_error([&] { load("diffuse", bitmap("reflectance", "")); }),
                         "scene.xml:2: the 'filename' of texture 'bitmap' is empty"));
    EXPECT_TRUE(
        mentions(file_error([&] { files_.load_xml("<emitter type='envmap'>" + empty + "</emitter>"); }),
                 "scene.xml:2: the 'filename' of emitter 'envmap' is empty"));
    EXPECT_TRUE(mentions(file_error([&] { load("diffuse", "<spectrum name='reflectance' filename=''/>"); }),
                         "scene.xml:2: the 'filename' of this spectrum is empty"));
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

TEST_F(MitsubaBadInput, EnvironmentsAreTurnedAndNotSheared) {
    const auto turn_by = [&](const std::string& matrix) {
        scene_ = files_.load_xml("<emitter type='constant'><transform name='to_world'><matrix value='" +
                                 matrix + "'/></transform></emitter>");
        return scene_.environment.to_world;
    };
    const Mat4 turn = turn_by("1 0.5 0.2 9  0 1 0.7 9  0 0 -2 9  0 0 0 1");
    EXPECT_EQ(notes_on_line_2("the to_world of an environment shears"), 1u);
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
            const double product =
                turn(0, a) * turn(0, b) + turn(1, a) * turn(1, b) + turn(2, a) * turn(2, b);
            EXPECT_NEAR(product, a == b ? 1 : 0, 1e-12);
        }
    }
    EXPECT_LT(turn(2, 2), 0) << "what mirrors goes on to mirror";
    turn_by("0 0 3 9  0 3 0 9  3 0 0 9  0 0 0 1");
    EXPECT_EQ(notes_on_line_2("shears"), 0u);
    EXPECT_EQ(notes_on_line_2("the to_world of an environment scales"), 1u);
    turn_by("0 0 1 9  0 1 0 9  -1 0 0 9  0 0 0 1");
    EXPECT_EQ(notes_on_line_2("scales"), 0u);
}

TEST_F(MitsubaBadInput, WhatContainsItselfIsToldAndNeitherFollowedForEverNorOffTheStack) {
    const auto message_of = [&](const std::string& body) {
        return file_error([&] { scene_ = files_.load_xml(body); });
    };
    EXPECT_TRUE(mentions(message_of("<integrator type='aov' id='a'><ref id='a'/></integrator>"),
                         "more than 8 integrators lie within each other"));
    EXPECT_TRUE(mentions(message_of("<shape type='merge' id='m'><ref id='m'/><ref id='m'/></shape>"),
                         "merges lie too deep in one another"));
    std::string scales;
    for (int i = 0; i < 40000; ++i) {
        scales += "<texture type='scale' id='t" + std::to_string(i) + "'><ref id='t" + std::to_string(i + 1) +
                  "'/></texture>";
    }
    scales += "<texture type='checkerboard' id='t40000'/>";
    const std::string shape =
        "<shape type='rectangle'><bsdf type='diffuse'><ref name='reflectance' id='t0'/></bsdf></shape>";
    EXPECT_TRUE(mentions(message_of(scales + shape), "more than 64 textures lie within each other"));
}

TEST_F(MitsubaBadInput, DeepMaterialsOfMeshesAreTold) {
    std::string deep = "<bsdf type='diffuse' id='b40000'/>";
    for (int i = 0; i < 40000; ++i) {
        deep += "<bsdf type='twosided' id='b" + std::to_string(i) + "'><ref id='b" + std::to_string(i + 1) +
                "'/></bsdf>";
    }
    files_.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string message = file_error([&] {
        scene_ = files_.load_xml(deep + "<shape type='obj'>" + text("filename", "one.obj") +
                                 "<ref id='b0'/></shape>");
    });
    EXPECT_TRUE(mentions(message, "more than 8 bsdfs lie within each other")) << message;
}

TEST_F(MitsubaBadInput, EnvironmentsHaveTheirGamma) {
    write_image(files_.path("grey.png"), {1, 1, {"R", "G", "B"}, {0.25f, 0.25f, 0.25f}});
    const auto radiance = [&](const std::string& gamma) {
        scene_ =
            files_.load_xml("<emitter type='envmap'>" + text("filename", "grey.png") + gamma + "</emitter>");
        return scene_.environment.radiance.at(0).x;
    };
    EXPECT_NEAR(radiance(""), 0.25f, 0.002f);
    EXPECT_NEAR(radiance(number("gamma", "-1")), 0.25f, 0.002f);
    EXPECT_NEAR(radiance(number("gamma", "1")), 137 / 255.0f, 1e-5f);
    EXPECT_NEAR(radiance(number("gamma", "2")), std::pow(137 / 255.0f, 2.0f), 1e-5f);
}

}  // namespace
}  // namespace nearlight::core
