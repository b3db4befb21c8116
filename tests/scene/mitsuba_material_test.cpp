// SPDX-License-Identifier: Apache-2.0
// Mitsuba's BSDFs and textures. Expected numbers come from Mitsuba 3.9.1 (traverse, eval).
#include "tests/scene/mitsuba_material.h"

#include "host/scene/reflectance.h"

namespace nearlight::core {
namespace {

using namespace test;

TEST_F(MitsubaMaterial, EachPluginBecomesItsModel) {
    const std::pair<const char*, uint> cases[] = {
        {"diffuse", NEARLIGHT_BSDF_DIFFUSE},
        {"plastic", NEARLIGHT_BSDF_PLASTIC},
        {"roughplastic", NEARLIGHT_BSDF_PLASTIC},
        {"conductor", NEARLIGHT_BSDF_CONDUCTOR},
        {"roughconductor", NEARLIGHT_BSDF_CONDUCTOR},
        {"dielectric", NEARLIGHT_BSDF_DIELECTRIC},
        {"roughdielectric", NEARLIGHT_BSDF_DIELECTRIC},
        {"thindielectric", NEARLIGHT_BSDF_THIN_DIELECTRIC},
        {"principled", NEARLIGHT_BSDF_PRINCIPLED},
        {"principledthin", NEARLIGHT_BSDF_PRINCIPLED},
        {"null", NEARLIGHT_BSDF_NULL},
        {"phong", NEARLIGHT_BSDF_PHONG},
        {"ward", NEARLIGHT_BSDF_WARD},
    };
    for (const auto& [type, model] : cases) {
        EXPECT_EQ(load(type, "").model, model) << type;
        EXPECT_EQ(notes_on_line_2(""), 0u) << type;
    }
}

TEST_F(MitsubaMaterial, DefaultsAreMitsubas) {
    EXPECT_FLOAT_EQ(load("diffuse", "").reflectance.value.x, 0.5f);
    const Material plastic = load("plastic", "");
    EXPECT_NEAR(plastic.eta.x, 1.4895874f, 1e-6f);
    EXPECT_NEAR(plastic.internal_reflectance, 0.590479f, 1e-5f);
    EXPECT_FLOAT_EQ(plastic.reflectance.value.x, 0.5f);
    EXPECT_FLOAT_EQ(plastic.specular.value.x, 1.0f);
    EXPECT_NEAR(load("dielectric", "").eta.x, 1.5041833f, 1e-6f);
    const Material metal = load("roughconductor", "");
    EXPECT_FLOAT_EQ(metal.roughness.value.x, 0.1f);
    EXPECT_EQ(metal.flags, NEARLIGHT_MATERIAL_BECKMANN);
    expect_near(metal.eta, {0, 0, 0});
    expect_near(metal.k, {1, 1, 1});
    const Material principled = load("principled", "");
    EXPECT_FLOAT_EQ(principled.roughness.value.x, 0.5f);
    EXPECT_FLOAT_EQ(principled.eta.x, 1.5f);
    EXPECT_NE(principled.curve, 0u);
    // A shape without a BSDF is grey, and black where it is a lamp.
    EXPECT_FLOAT_EQ(load("").reflectance.value.x, 0.5f);
    const Material lamp = load("<emitter type='area'>" + rgb("radiance", "1 2 3") + "</emitter>");
    EXPECT_FLOAT_EQ(lamp.reflectance.value.x, 0.0f);
    expect_near(lamp.emission.value, {1, 2, 3});
}

TEST_F(MitsubaMaterial, PlasticsAndTheirOldNames) {
    const std::string nonlinear = "<boolean name='nonlinear' value='true'/>";
    const Material rough =
        load("roughplastic", text("distribution", "ggx") + number("alpha", "0.5") + nonlinear +
                                 text("intIOR", "diamond") + number("extIOR", "1.2") +
                                 rgb("diffuseReflectance", "0.3") + rgb("specularReflectance", "0.7"));
    EXPECT_EQ(rough.flags, NEARLIGHT_MATERIAL_NONLINEAR);
    EXPECT_FLOAT_EQ(rough.roughness.value.x, 0.5f);
    EXPECT_FLOAT_EQ(rough.eta.x, 2.419f / 1.2f);
    EXPECT_FLOAT_EQ(rough.reflectance.value.y, 0.3f);
    EXPECT_FLOAT_EQ(rough.specular.value.z, 0.7f);
    EXPECT_EQ(notes_on_line_2(""), 0u);
    load("blendbsdf", number("weight", "0.5") + "<bsdf type='roughplastic'/><bsdf type='roughplastic'/>");
    EXPECT_EQ(scene_.transmission_curves.size(), 2u * NEARLIGHT_CURVE_SIZE);
}

TEST_F(MitsubaMaterial, NamesMayHaveCapitals) {
    EXPECT_EQ(load("roughconductor", text("distribution", "GGX")).flags & NEARLIGHT_MATERIAL_BECKMANN, 0u);
    EXPECT_FLOAT_EQ(load("dielectric", text("int_ior", "BK7")).eta.x,
                    load("dielectric", text("int_ior", "bk7")).eta.x);
}

TEST_F(MitsubaMaterial, Metals) {
    const Material gold =
        load("roughconductor", text("material", "Au") + number("alpha_u", "0.3") + number("alpha_v", "0.1") +
                                   rgb("specular_reflectance", "1 0.5 0.25"));
    expect_near(gold.eta, {0.1430f, 0.3753f, 1.4421f}, 2e-4f);
    expect_near(gold.k, {3.9830f, 2.3856f, 1.6034f}, 2e-4f);
    EXPECT_FLOAT_EQ(gold.roughness.value.x, 0.3f);
    EXPECT_FLOAT_EQ(gold.roughness.value.y, 0.1f);
    EXPECT_NE(gold.flags & NEARLIGHT_MATERIAL_TANGENT, 0u);
    expect_near(gold.specular.value, {1, 0.5f, 0.25f});
    expect_near(load("conductor", text("material", "Cu_palik")).eta, {0.2132f, 0.9197f, 1.1024f}, 2e-4f);
    expect_near(load("conductor", text("material", "TiN_palik")).k, {3.3683f, 1.9435f, 1.1021f}, 2e-4f);
    expect_near(load("conductor", text("material", "TiO2-e")).eta, {3.1066f, 2.5132f, 2.5824f}, 2e-4f);
    const Material own =
        load("conductor", rgb("eta", "0.2 0.4 0.6") + rgb("k", "3") + number("ext_eta", "2"));
    expect_near(own.eta, {0.1f, 0.2f, 0.3f});
    expect_near(own.k, {1.5f, 1.5f, 1.5f});
}

TEST_F(MitsubaMaterial, GlassAndItsTints) {
    const Material water = load("dielectric", text("int_ior", "water") + text("ext_ior", "vacuum") +
                                                  rgb("specular_transmittance", "0.5 0.6 0.7"));
    EXPECT_FLOAT_EQ(water.eta.x, 1.333f);
    expect_near(water.transmission.value, {0.5f, 0.6f, 0.7f});
    EXPECT_EQ(notes_on_line_2(""), 0u);
    const Material bubble = load("dielectric", text("int_ior", "air") + text("ext_ior", "water"));
    EXPECT_NEAR(bubble.eta.x, 1.000277f / 1.333f, 1e-6f);
    EXPECT_EQ(notes_on_line_2(""), 0u);
}

TEST_F(MitsubaMaterial, PrincipledKeepsAllItsParameters) {
    std::string body = rgb("base_color", "0.1 0.2 0.3") + number("specular", "0.8");
    const std::pair<const char*, Parameter Material::*> numbers[] = {
        {"roughness", &Material::roughness},     {"metallic", &Material::metallic},
        {"anisotropic", &Material::anisotropic}, {"spec_trans", &Material::spec_trans},
        {"spec_tint", &Material::spec_tint},     {"sheen", &Material::sheen},
        {"sheen_tint", &Material::sheen_tint},   {"flatness", &Material::flatness},
        {"clearcoat", &Material::clearcoat},     {"clearcoat_gloss", &Material::clearcoat_gloss}};
    for (std::size_t i = 0; i < std::size(numbers); ++i) {
        body += number(numbers[i].first, "0." + std::to_string(10 + i));
    }
    const Material material = load("principled", body);
    for (std::size_t i = 0; i < std::size(numbers); ++i) {
        EXPECT_NEAR((material.*numbers[i].second).value.x, 0.1f + 0.01f * static_cast<float>(i), 1e-6f)
            << numbers[i].first;
    }
    EXPECT_NEAR(material.eta.x, 1.67731f, 1e-4f);
    EXPECT_EQ(material.flags, NEARLIGHT_MATERIAL_TANGENT);
    EXPECT_EQ(notes_on_line_2(""), 0u);
    const Material thin = load("principledthin", number("diff_trans", "1.5") + number("eta", "1.3"));
    EXPECT_EQ(thin.flags, NEARLIGHT_MATERIAL_THIN);
    EXPECT_FLOAT_EQ(thin.transmission.value.x, 0.75f) << "a share, where Mitsuba counts to 2";
    EXPECT_FLOAT_EQ(thin.eta.x, 1.3f);
}

TEST_F(MitsubaMaterial, TexturesOfThePrincipledIndexBecomeTheirMeans) {
    write_pair("pair.exr", 0.25f, 0.75f);
    EXPECT_FLOAT_EQ(load("principled", bitmap("specular", "pair.exr")).eta.x, 1.5f);
    EXPECT_EQ(notes_on_line_2("a texture for 'specular'"), 1u);
    write_pair("pair.exr", 1.0f, 1.5f);
    EXPECT_FLOAT_EQ(load("principled", bitmap("eta", "pair.exr")).eta.x, 1.25f);
    EXPECT_EQ(notes_on_line_2("a texture for 'eta'"), 1u);
    write_pair("pair.exr", 1.0f, 1.0f);
    EXPECT_FLOAT_EQ(load("principled", bitmap("eta", "pair.exr") + number("spec_trans", "1")).eta.x, 1.001f)
        << "light needs a half-vector to be refracted";
    write_pair("pair.exr", 0.0f, 0.0f);
    EXPECT_FLOAT_EQ(load("principled", bitmap("eta", "pair.exr")).eta.x, 1.5f);
    EXPECT_EQ(notes_on_line_2("'eta' is not greater than 0"), 1u);
}

TEST_F(MitsubaMaterial, SpecularIsIgnoredBesideEta) {
    EXPECT_FLOAT_EQ(load("principled", number("eta", "1.3") + number("specular", "0.8")).eta.x, 1.3f);
    EXPECT_EQ(notes_on_line_2("'specular' is ignored beside 'eta'"), 1u);
    EXPECT_EQ(notes_on_line_2(""), 1u);
    EXPECT_FLOAT_EQ(load("principledthin", number("specular", "0.8")).eta.x, 1.5f);
    EXPECT_EQ(notes_on_line_2("unknown property 'specular'"), 1u);
}

TEST_F(MitsubaMaterial, WrappersNameTheirChildren) {
    const std::string red = "<bsdf type='diffuse'>" + rgb("reflectance", "1 0 0") + "</bsdf>";
    const std::string metal = "<bsdf type='conductor'/>";
    const Material one = load("twosided", red);
    EXPECT_EQ(one.model, NEARLIGHT_BSDF_TWO_SIDED);
    EXPECT_EQ(one.child[0], one.child[1]);
    const Material two = load("twosided", red + metal);
    EXPECT_EQ(child(two, 0).model, NEARLIGHT_BSDF_DIFFUSE);
    EXPECT_EQ(child(two, 1).model, NEARLIGHT_BSDF_CONDUCTOR);
    const Material colored = load("mask", rgb("opacity", "0.8 0.5 0.2") + red);
    EXPECT_NEAR(colored.reflectance.value.x, 0.5f, 1e-6f) << "Mitsuba takes the mean of a colour";
    const Material mask = load("mask", number("opacity", "0.3") + red);
    EXPECT_EQ(mask.model, NEARLIGHT_BSDF_MASK);
    EXPECT_FLOAT_EQ(mask.reflectance.value.x, 0.3f);
    EXPECT_EQ(child(mask).model, NEARLIGHT_BSDF_DIFFUSE);
    const Material blend = load("blendbsdf", number("weight", "0.25") + red + metal);
    EXPECT_EQ(blend.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(blend.reflectance.value.x, 0.25f);
    EXPECT_EQ(child(blend, 1).model, NEARLIGHT_BSDF_CONDUCTOR);
    const Material lamp = load(red + "<emitter type='area'>" + rgb("radiance", "5") + "</emitter>");
    EXPECT_FLOAT_EQ(lamp.emission.value.x, 5.0f);
    EXPECT_FLOAT_EQ(lamp.reflectance.value.x, 1.0f);
    EXPECT_EQ(notes_on_line_2(""), 0u);
}

/// Mitsuba 0.5's mixtures are sums: each BSDF counts by its weight, and what the weights lack of 1 is black.
TEST_F(MitsubaMaterial, MixturesBlendByTheirWeights) {
    const auto grey = [](const std::string& value) {
        return "<bsdf type='diffuse'>" + rgb("reflectance", value) + "</bsdf>";
    };
    const auto albedo = [&](const std::string& weights, const std::string& bsdfs) {
        const Material mixture = load("mixturebsdf", text("weights", weights) + bsdfs);
        return diffuse_albedo(scene_, mixture, 0.5f, 0.5f).x;
    };
    EXPECT_NEAR(albedo("0.5, 0.3, 0.2", grey("0.2") + grey("0.4") + grey("0.8")), 0.38f, 1e-6f);
    EXPECT_NEAR(albedo("0.25 0.5", grey("0.4") + grey("0.8")), 0.5f, 1e-6f);
    EXPECT_NEAR(albedo("1, 0", grey("0.2") + grey("0.8")), 0.2f, 1e-6f);
    EXPECT_NEAR(albedo("0, 1", grey("0.2") + grey("0.8")), 0.8f, 1e-6f);
    EXPECT_NEAR(albedo("0.7", grey("0.5")), 0.35f, 1e-6f);
    EXPECT_EQ(notes_on_line_2(""), 0u);
    EXPECT_NEAR(albedo("1, 3", grey("0.2") + grey("0.8")), 0.65f, 1e-6f);
    EXPECT_EQ(notes_on_line_2("the sum of 'weights' is above 1"), 1u);
    EXPECT_EQ(notes_on_line_2(""), 1u);
}

/// Kernels follow at most so many BSDFs within each other, however the file names them.
TEST_F(MitsubaMaterial, NestingByReferencesIsLimited) {
    const auto masks = [&](int count) {
        std::string body = "<bsdf type='diffuse' id='0'/>";
        for (int i = 1; i <= count; ++i) {
            const std::string id = std::to_string(i);
            body += "<bsdf type='mask' id='" + id + "'><ref id='" + std::to_string(i - 1) + "'/></bsdf>" +
                    shape("rectangle", "<ref id='" + id + "'/>");
        }
        return body;
    };
    EXPECT_EQ(files_.load_xml(masks(NEARLIGHT_MAX_BSDF_NESTING)).triangles.size(),
              2u * NEARLIGHT_MAX_BSDF_NESTING);
    const std::string message =
        file_error([&] { static_cast<void>(files_.load_xml(masks(NEARLIGHT_MAX_BSDF_NESTING + 1))); });
    EXPECT_TRUE(mentions(message, "more than 8 bsdfs lie within each other")) << message;
}

TEST_F(MitsubaMaterial, BumpAndNormalMaps) {
    write_pair("map.png", 0.0f, 1.0f);
    const Material bump =
        load("bumpmap", bitmap("arbitrary", "map.png", "<boolean name='raw' value='true'/>") +
                            number("scale", "3") + "<bsdf type='plastic'/>");
    EXPECT_EQ(bump.model, NEARLIGHT_BSDF_BUMP_MAP);
    EXPECT_EQ(bump.flags, NEARLIGHT_MATERIAL_TANGENT);
    EXPECT_FLOAT_EQ(value(bump.reflectance, 0.75f).x, 3.0f);
    EXPECT_EQ(child(bump).model, NEARLIGHT_BSDF_PLASTIC);
    // Mitsuba 0.6 scales the texture.
    const Material old = load("bumpmap", "<texture type='scale'>" + number("scale", "3") +
                                             bitmap("", "map.png") + "</texture><bsdf type='plastic'/>");
    EXPECT_FLOAT_EQ(value(old.reflectance, 0.75f).x, 3.0f);
    const auto& linear = srgb_decode_table();  // writing encodes
    write_image(files_.path("normal.png"), {1, 1, {"R", "G", "B"}, {1, linear[102], linear[204]}});
    const Material map =
        load("normalmap", bitmap("normalmap", "normal.png", "<boolean name='raw' value='true'/>") +
                              "<bsdf type='plastic'/>");
    EXPECT_EQ(map.model, NEARLIGHT_BSDF_NORMAL_MAP);
    expect_near(value(map.reflectance), {1, 0.4f, 0.8f});
    const Material tilted =
        load("normalmap",
             "<texture name='normalmap' type='rawconstant'><vector name='value' value='0.3, 0.5, 0.9'/>"
             "</texture><bsdf type='plastic'/>");
    EXPECT_EQ(tilted.model, NEARLIGHT_BSDF_NORMAL_MAP);
    expect_near(value(tilted.reflectance), {0.3f, 0.5f, 0.9f});
    EXPECT_EQ(notes_on_line_2(""), 0u);
}

TEST_F(MitsubaMaterial, RoughnessOfTwoTextures) {
    write_pair("u.exr", 0.25f, 0.5f);
    write_pair("v.exr", 0.75f, 0.125f);
    const Material metal = load("roughconductor", bitmap("alpha_u", "u.exr") + bitmap("alpha_v", "v.exr"));
    EXPECT_NE(metal.flags & NEARLIGHT_MATERIAL_TANGENT, 0u);
    expect_near(value(metal.roughness, 0.25f), {0.25f, 0.75f, 0});
    expect_near(value(metal.roughness, 0.75f), {0.5f, 0.125f, 0});
    EXPECT_EQ(notes_on_line_2(""), 0u);
    write_image(files_.path("one.exr"), {1, 1, {"R", "G", "B"}, {0.5f, 0.5f, 0.5f}});
    const Material means = load("roughconductor", bitmap("alpha_u", "u.exr") + bitmap("alpha_v", "one.exr"));
    expect_near(means.roughness.value, {0.375f, 0.5f, 0});
    EXPECT_EQ(notes_on_line_2("are replaced by their means"), 1u);
}

/// Only constants have a range; a board's fields are as free as texels are. The share of light that diffuses
/// through is half of diff_trans.
TEST_F(MitsubaMaterial, NumbersOfCheckerboardsMayBeAboveOne) {
    const Material thin =
        load("principledthin", "<texture type='checkerboard' name='diff_trans'>" + number("color0", "0.4") +
                                   number("color1", "1.4") + "</texture>");
    EXPECT_EQ(notes_on_line_2(""), 0u);
    const float one = parameter_number(scene_, thin.transmission, 0.25f, 0.25f);
    const float other = parameter_number(scene_, thin.transmission, 0.75f, 0.25f);
    EXPECT_NEAR(std::min(one, other), 0.2f, 1e-6f);
    EXPECT_NEAR(std::max(one, other), 0.7f, 1e-6f);
}

TEST_F(MitsubaMaterial, TexturesOnEveryParameter) {
    write_pair("ramp.png", 0.0f, 1.0f);
    const auto ramp = [](const std::string& name) {
        return bitmap(name, "ramp.png", "<boolean name='raw' value='true'/>");
    };
    const auto is_ramp = [&](const Parameter& parameter) {
        return parameter.texture >= 0 && value(parameter, 0.25f).x == 0.0f &&
               value(parameter, 0.75f).x == 1.0f;
    };
    const Material metal = load("roughconductor", ramp("alpha") + ramp("specular_reflectance"));
    EXPECT_TRUE(is_ramp(metal.roughness) && is_ramp(metal.specular));
    const Material glass = load("dielectric", ramp("specular_transmittance") + ramp("specular_reflectance"));
    EXPECT_TRUE(is_ramp(glass.transmission) && is_ramp(glass.specular));
    EXPECT_TRUE(is_ramp(load("plastic", ramp("diffuse_reflectance")).reflectance));
    EXPECT_TRUE(is_ramp(load("mask", ramp("opacity") + "<bsdf type='diffuse'/>").reflectance));
    EXPECT_TRUE(is_ramp(
        load("blendbsdf", ramp("weight") + "<bsdf type='diffuse'/><bsdf type='plastic'/>").reflectance));
    const Material principled = load("principled", ramp("roughness") + ramp("metallic") + ramp("clearcoat"));
    EXPECT_TRUE(is_ramp(principled.roughness) && is_ramp(principled.metallic) &&
                is_ramp(principled.clearcoat));
    EXPECT_EQ(notes_on_line_2(""), 0u);
    EXPECT_EQ(scene_.images.size(), 1u);  // read once
}

TEST_F(MitsubaMaterial, ReflectanceAboveOneInAnExrIsKept) {
    write_image(files_.path("bright.exr"), {1, 1, {"R", "G", "B"}, {1.75f, 0.5f, 0}});
    const Material material = load("diffuse", bitmap("reflectance", "bright.exr"));
    expect_near(value(material.reflectance), {1.75f, 0.5f, 0});
    EXPECT_EQ(notes_on_line_2(""), 0u);
}

TEST_F(MitsubaMaterial, WhatIsNotSupportedIsNamed) {
    const std::string plastic = "<bsdf type='plastic'/>";
    const std::pair<std::string, const char*> refused[] = {
        {"<bsdf type='pplastic'/>", "unknown bsdf 'pplastic'"},
        {"<bsdf type='hair'/>", "unknown bsdf 'hair'"},
        {"<bsdf type='twosided'/>", "needs one or two nested bsdfs"},
        {"<bsdf type='mixturebsdf'>" + text("weights", "0.5, 0.5") + plastic + "</bsdf>", "a weight in"},
        {"<bsdf type='mixturebsdf'>" + text("weights", "-1, 2") + plastic + plastic + "</bsdf>",
         "none below 0"},
        {"<bsdf type='mask'>" + plastic + plastic + "</bsdf>", "needs one nested bsdf"},
        {"<bsdf type='conductor'>" + text("material", "Unobtainium") + "</bsdf>", "unknown metal"},
        {"<bsdf type='conductor'>" + text("material", "Au") + number("eta", "1.5") + "</bsdf>",
         "give either 'material' or 'eta' and 'k'"},
        {"<bsdf type='dielectric'>" + text("int_ior", "soup") + "</bsdf>", "no index of refraction"},
        {"<bsdf type='coating'>" + plastic + "</bsdf>", "only supported over diffuse bsdfs and metals"},
        {"<bsdf type='ward'>" + text("variant", "gold") + "</bsdf>", "unknown variant 'gold'"},
        {"<bsdf type='roughplastic'>" + text("distribution", "as-you-like") + "</bsdf>", "distribution"},
        {"<bsdf type='diffuse'>" + bitmap("reflectance", "x.png", text("wrap_mode", "zero")) + "</bsdf>",
         "wrap mode 'zero'"},
        {"<bsdf type='diffuse'>" + bitmap("reflectance", "x.png", text("filter_type", "cubic")) + "</bsdf>",
         "filter 'cubic'"},
        {"<bsdf type='diffuse'><texture type='wood' name='reflectance'/></bsdf>", "unknown texture 'wood'"},
        {"<bsdf type='diffuse'><texture type='mesh_attribute' name='reflectance'>" + text("name", "color") +
             "</texture></bsdf>",
         "begins with 'vertex_' or 'face_', not as 'color'"},
        {"<bsdf type='bumpmap'><texture type='mesh_attribute'>" + text("name", "face_height") + "</texture>" +
             plastic + "</bsdf>",
         "mesh attribute 'face_height' is only supported as a colour or a number"},
    };
    for (const auto& [bsdf, part] : refused) {
        const std::string message = file_error([&, &b = bsdf] { load(b); });
        EXPECT_TRUE(mentions(message, part) && mentions(message, "scene.xml:2: ")) << message;
    }
    load("roughdiffuse", number("alpha", "0.5"));
    EXPECT_EQ(notes_on_line_2("'roughdiffuse' is replaced by 'diffuse'"), 1u);
    load("twosided", "<bsdf type='dielectric'/>");
    EXPECT_EQ(notes_on_line_2("'twosided' has no effect"), 1u);
    load("bumpmap",
         "<texture type='checkerboard'/><boolean name='use_shadowing_function' value='false'/>" + plastic);
    EXPECT_EQ(notes_on_line_2("'use_shadowing_function' is always true"), 1u);
    EXPECT_EQ(notes_on_line_2("another map within this 'bumpmap'"), 0u);
    load("bumpmap",
         "<texture type='checkerboard'/><bsdf type='twosided'><bsdf type='bumpmap'>"
         "<texture type='checkerboard'/>" +
             plastic + "</bsdf></bsdf>");
    EXPECT_EQ(notes_on_line_2("another map within this 'bumpmap': both tilt the normal"), 1u);
    std::string deep = plastic;
    for (int i = 0; i < 9; ++i) {
        deep = "<bsdf type='mask'>" + deep + "</bsdf>";
    }
    EXPECT_TRUE(mentions(file_error([&] { load(deep); }), "more than 8 bsdfs"));
    std::string boards;
    for (int i = 0; i < 9; ++i) {
        const std::string name = i == 8 ? "reflectance" : "color0";
        boards = "<texture type='checkerboard' name='" + name + "'>" + boards + "</texture>";
    }
    EXPECT_TRUE(mentions(file_error([&] { load("diffuse", boards); }), "more than 8 checkerboards"));
}

}  // namespace
}  // namespace nearlight::core
