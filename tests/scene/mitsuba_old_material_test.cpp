// SPDX-License-Identifier: Apache-2.0
// Materials that Mitsuba 0.5 and 0.6 have and Mitsuba 3 lacks, and what files of these versions leave out.
// Expected numbers follow from the plugins' documentation.
#include <algorithm>
#include <cmath>

#include "host/scene/reflectance.h"
#include "tests/scene/mitsuba_material.h"

namespace nearlight::core {
namespace {

using namespace test;

class MitsubaOldMaterial : public MitsubaMaterial {};

TEST_F(MitsubaOldMaterial, LobesOfMitsuba06StandBesideTheirBase) {
    const Material phong = load("phong", "");
    EXPECT_FLOAT_EQ(phong.reflectance.value.x, 0.5f);
    EXPECT_FLOAT_EQ(phong.specular.value.x, 0.2f);
    EXPECT_FLOAT_EQ(phong.roughness.value.x, 0.25f);  // √(2/32)
    const Material given = load("phong", rgb("diffuseReflectance", "0.4") +
                                             rgb("specularReflectance", "0.3") + number("exponent", "0"));
    EXPECT_FLOAT_EQ(given.reflectance.value.x, 0.4f);
    EXPECT_FLOAT_EQ(given.specular.value.x, 0.3f);
    EXPECT_FLOAT_EQ(given.roughness.value.x, 1.0f);
    EXPECT_TRUE(has_diffuse(scene_, given));
    EXPECT_TRUE(has_rough_gloss(scene_, given));
    const Material ward = load("ward", number("alphaU", "0.05") + number("alphaV", "0.2"));
    EXPECT_FLOAT_EQ(ward.roughness.value.x, 0.05f);
    EXPECT_FLOAT_EQ(ward.roughness.value.y, 0.2f);
    EXPECT_NE(ward.flags & NEARLIGHT_MATERIAL_TANGENT, 0u);
    EXPECT_EQ(notes_on_line_2(""), 0u);
}

/// A conductor without a material is copper in files of Mitsuba 0.6, and a perfect mirror in those of
/// Mitsuba 3.
TEST_F(MitsubaOldMaterial, PartsWithoutAVersionHaveThatOfTheFileThatIncludesThem) {
    const std::string part = shape("rectangle", "<bsdf type='conductor'/>");
    const auto is_copper = [&](const std::string& version, const std::string& included) {
        files_.write("part.xml", included);
        files_.write("between.xml", "<scene><include filename='part.xml'/></scene>");
        bool both[2];
        for (const int k : {0, 1}) {
            const std::string name = k == 0 ? "part.xml" : "between.xml";
            const Scene scene = load_scene(
                files_.write("old.xml", "<scene" + version + "><include filename='" + name + "'/></scene>"));
            both[k] = scene.materials.at(scene.triangles.at(0).material).eta.x > 0.0f;
        }
        EXPECT_EQ(both[0], both[1]) << "a part of a part, too";
        return both[0];
    };
    EXPECT_TRUE(is_copper(" version='0.6.0'", part));
    EXPECT_TRUE(is_copper(" version='0.6.0'", "<scene>" + part + "</scene>"));
    EXPECT_FALSE(is_copper(" version='0.6.0'", "<scene version='3.0.0'>" + part + "</scene>"));
    EXPECT_FALSE(is_copper(" version='3.0.0'", part));
    EXPECT_FALSE(is_copper("", part));
    EXPECT_TRUE(is_copper("", "<scene version='0.5.0'>" + part + "</scene>"));
}

TEST_F(MitsubaOldMaterial, LobesReflectNoMoreThanArrives) {
    const Material phong =
        load("phong", rgb("diffuseReflectance", "0.5 0.9 0.1") + rgb("specularReflectance", "0.6"));
    EXPECT_FLOAT_EQ(phong.reflectance.value.x, 0.5f / 1.5f);
    EXPECT_FLOAT_EQ(phong.specular.value.x, 0.6f / 1.5f);
    const std::string checks = "<texture name='diffuseReflectance' type='checkerboard'>" +
                               rgb("color0", "0.2") + rgb("color1", "1") + "</texture>";
    EXPECT_FLOAT_EQ(load("ward", checks).specular.value.x, 0.2f / 1.2f);
}

TEST_F(MitsubaOldMaterial, CoatsOfMitsuba06LieOverDiffuseSurfacesAndMetals) {
    const std::string red = "<bsdf type='diffuse'>" + rgb("reflectance", "0.8 0.4 0.2") + "</bsdf>";
    const Material wood = load("coating", number("intIOR", "1.5") + number("extIOR", "1") + red);
    EXPECT_EQ(wood.model, NEARLIGHT_BSDF_PLASTIC);
    EXPECT_FLOAT_EQ(wood.eta.x, 1.5f);
    EXPECT_EQ(wood.internal_reflectance, 0.0f);
    expect_near(wood.reflectance.value, {0.8f, 0.4f, 0.2f});
    EXPECT_EQ(notes_on_line_2(""), 0u);
    const Material amber = load(
        "roughcoating", number("alpha", "0.2") + number("thickness", "0.5") + rgb("sigmaA", "0 1 2") + red);
    EXPECT_FLOAT_EQ(amber.roughness.value.x, 0.2f);
    expect_near(amber.reflectance.value, {0.8f, 0.4f * std::exp(-1.0f), 0.2f * std::exp(-2.0f)});
    EXPECT_EQ(notes_on_line_2("absorbs"), 1u);
    const Material car =
        load("coating", number("intIOR", "1.5") + number("extIOR", "1") + "<bsdf type='roughconductor'/>");
    EXPECT_EQ(car.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_EQ(child(car, 0).model, NEARLIGHT_BSDF_PLASTIC);
    EXPECT_FLOAT_EQ(child(car, 0).specular.value.x, 2.0f);
    EXPECT_EQ(child(car, 1).model, NEARLIGHT_BSDF_CONDUCTOR);
    EXPECT_FLOAT_EQ(child(car, 1).specular.value.x, 2.0f * 0.96f * 0.96f);
    EXPECT_EQ(notes_on_line_2("the metal under 'coating'"), 1u);
}

TEST_F(MitsubaOldMaterial, VarnishesLeaveOtherCoatsAsTheyAre) {
    const std::string index = number("intIOR", "1.5") + number("extIOR", "1");
    const std::string nonlinear = "<boolean name='nonlinear' value='true'/>";
    const float alone = load("plastic", index + nonlinear).internal_reflectance;
    EXPECT_GT(alone, 0.5f);
    const Material both = load("blendbsdf", number("weight", "0.5") + "<bsdf type='coating'>" + index +
                                                "<bsdf type='diffuse'/></bsdf><bsdf type='plastic'>" + index +
                                                nonlinear + "</bsdf>");
    EXPECT_EQ(child(both, 0).internal_reflectance, 0.0f);
    EXPECT_FLOAT_EQ(child(both, 1).internal_reflectance, alone);
}

TEST_F(MitsubaOldMaterial, NoCoatMakesLight) {
    const Material coat =
        load("coating", number("thickness", "-3") + rgb("sigmaA", "1 0 2") + "<bsdf type='diffuse'/>");
    expect_near(coat.reflectance.value, {0.5f, 0.5f, 0.5f});
    EXPECT_EQ(notes_on_line_2("absorbs less than nothing"), 1u);
}

TEST_F(MitsubaOldMaterial, OtherVariantsOfWardAreNoted) {
    load("ward", text("variant", "ward-duer"));
    EXPECT_EQ(notes_on_line_2("replaced by 'balanced'"), 1u);
}

TEST_F(MitsubaOldMaterial, TheLastOfTwoPropertiesCountsInOldFiles) {
    const auto write = [&](const std::string& version) {
        files_.write("twice.xml", "<scene version='" + version + "'>\n" +
                                      shape("rectangle", "<bsdf type='diffuse'>" + rgb("reflectance", "0.1") +
                                                             rgb("reflectance", "0.3") + "</bsdf>") +
                                      "</scene>\n");
    };
    write("0.6.0");
    const Scene old = load_scene(files_.path("twice.xml"));
    expect_near(old.materials.at(old.triangles.at(0).material).reflectance.value, {0.3f, 0.3f, 0.3f});
    EXPECT_EQ(std::ranges::count_if(old.notes,
                                    [](const Note& note) {
                                        return mentions(to_string(note),
                                                        "twice.xml:2: property 'reflectance' is given twice");
                                    }),
              1);
    write("3.0.0");
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files_.path("twice.xml")); }), "is given twice"));
}

TEST_F(MitsubaOldMaterial, AMediumAloneHasNoSurfaceInOldFiles) {
    const auto model = [&](const std::string& version) {
        const Scene scene = load_scene(files_.write(
            "m.xml", "<scene version='" + version + "'>" +
                         shape("rectangle", "<medium type='homogeneous' name='interior'/>") + "</scene>\n"));
        return scene.materials.at(scene.triangles.at(0).material).model;
    };
    EXPECT_EQ(model("0.6.0"), NEARLIGHT_BSDF_NULL);
    EXPECT_NE(model("3.0.0"), NEARLIGHT_BSDF_NULL);
}

TEST_F(MitsubaOldMaterial, ConductorsOfOldFilesAreCopper) {
    const std::string text =
        "<scene version='0.6.0'>" + shape("rectangle", "<bsdf type='conductor'/>") + "</scene>\n";
    const Scene scene = load_scene(files_.write("scene.xml", text));
    const Material metal = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(metal.eta, load("conductor", "<string name='material' value='Cu'/>").eta);
    EXPECT_FLOAT_EQ(load("conductor", "").k.x, 1.0f) << "a perfect mirror, as in Mitsuba 3";
    // Each of eta and k replaces that of copper by itself.
    const std::string partly =
        "<scene version='0.6.0'>" +
        shape("rectangle", "<bsdf type='conductor'><spectrum name='eta' value='1.5'/></bsdf>") + "</scene>\n";
    const Scene other = load_scene(files_.write("scene.xml", partly));
    const Material mixed = other.materials.at(other.triangles.at(0).material);
    EXPECT_FLOAT_EQ(mixed.eta.x, 1.5f);
    EXPECT_EQ(mixed.k, metal.k);
}

}  // namespace
}  // namespace nearlight::core
