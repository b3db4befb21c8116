// SPDX-License-Identifier: Apache-2.0
#include "host/scene/reflectance.h"

#include <gtest/gtest.h>

#include "host/scene/material_model.h"

namespace nearlight::core {
namespace {

void expect_share(Vec3 a, Vec3 b, float tolerance = 1e-6f) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

uint add(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return static_cast<uint>(scene.materials.size() - 1);
}

TEST(Reflectance, DiffuseIsTexturedAndTinted) {
    Scene scene;
    scene.images.push_back({"", 2, 1, NEARLIGHT_TEXELS_SRGB8, {0xff0000ffu, 0xffffffffu}});
    SceneTexture texture;
    texture.parameters.u_scale = texture.parameters.v_scale = 1.0f;
    texture.image = 0;
    scene.textures.push_back(texture);
    Material material = diffuse_material({0.5f, 0.25f, 0.125f});
    material.reflectance.texture = 0;
    expect_share(diffuse_albedo(scene, material, 0.25f, 0.5f), {0.5f, 0, 0});
    expect_share(diffuse_albedo(scene, material, 0.75f, 0.5f), {0.5f, 0.25f, 0.125f});
    expect_share(mean_reflectance(scene, material, 0.75f, 0.5f), {0.5f, 0.25f, 0.125f});
}

// A white base under a smooth coat that absorbs nothing reflects all light.
TEST(Reflectance, PlasticConservesEnergy) {
    for (const bool nonlinear : {false, true}) {
        Scene scene;
        const Material material = plastic_material(scene, {.eta = 1.5, .nonlinear = nonlinear});
        const float diffuse = diffuse_albedo(scene, material, 0, 0).x;
        EXPECT_NEAR(diffuse, 1.0 - mean_dielectric_reflectance(1.5), 0.01);
        EXPECT_NEAR(mean_reflectance(scene, material, 0, 0).x, 1.0f, 0.01f);
    }
}

TEST(Reflectance, MetalsAndGlassHaveNoDiffusePart) {
    Scene scene;
    const Material metal = conductor_material({0, 0, 0}, {1, 1, 1}, {0.9f, 0.5f, 0.1f});
    expect_share(diffuse_albedo(scene, metal, 0, 0), {0, 0, 0});
    expect_share(mean_reflectance(scene, metal, 0, 0), {0.9f, 0.5f, 0.1f}, 1e-4f);
    for (const Material& glass : {dielectric_material(1.5), thin_dielectric_material(1.5)}) {
        expect_share(diffuse_albedo(scene, glass, 0, 0), {0, 0, 0});
        expect_share(mean_reflectance(scene, glass, 0, 0), {1, 1, 1}, 1e-4f);
    }
}

TEST(Reflectance, WrappersCountByTheirWeights) {
    Scene scene;
    const uint red = add(scene, diffuse_material({0.8f, 0, 0}));
    const uint green = add(scene, diffuse_material({0, 0.4f, 0}));
    const Material blend = blend_material(parameter_of(0.25f), red, green);
    expect_share(diffuse_albedo(scene, blend, 0, 0), {0.6f, 0.1f, 0});
    const Material mask = mask_material(parameter_of(0.25f), red);
    expect_share(diffuse_albedo(scene, mask, 0, 0), {0.2f, 0, 0});
    expect_share(mean_reflectance(scene, mask, 0, 0), {0.95f, 0.75f, 0.75f});
    expect_share(diffuse_albedo(scene, two_sided_material(green, red), 0, 0), {0, 0.4f, 0});
    expect_share(diffuse_albedo(scene, bump_map_material(parameter_of(1.0f), red), 0, 0), {0.8f, 0, 0});
}

TEST(Reflectance, WhatAMaterialMayDo) {
    Scene scene;
    const uint diffuse = add(scene, diffuse_material({1, 1, 1}));
    const uint metal = add(scene, conductor_material({0, 0, 0}, {1, 1, 1}));
    const uint glass = add(scene, dielectric_material(1.5));
    const uint pane = add(scene, thin_dielectric_material(1.5));
    const uint nothing = add(scene, plain_material(NEARLIGHT_BSDF_NULL));
    const uint coated = add(scene, principled_material(scene, 1.5));
    const uint two_sided = add(scene, two_sided_material(diffuse, metal));
    const uint mask = add(scene, mask_material(parameter_of(0.5f), diffuse));
    const uint bumped_mask = add(scene, bump_map_material(parameter_of(1.0f), mask));
    const uint blend = add(scene, blend_material(parameter_of(0.5f), diffuse, glass));
    const struct {
        uint material;
        bool diffuse, specular, back, straight, through;
    } rows[] = {
        {diffuse, true, false, false, false, false}, {metal, false, true, false, false, false},
        {glass, false, true, true, false, true},     {pane, false, true, true, true, true},
        {nothing, false, true, true, true, true},    {coated, true, true, false, false, false},
        {two_sided, true, true, true, false, false}, {mask, true, true, true, true, true},
        {bumped_mask, true, true, true, true, true}, {blend, true, true, true, false, true},
    };
    for (const auto& row : rows) {
        SCOPED_TRACE(row.material);
        const Material& material = scene.materials[row.material];
        EXPECT_EQ(has_diffuse(scene, material), row.diffuse);
        EXPECT_EQ(has_specular(scene, material), row.specular);
        EXPECT_EQ(reflects_back(scene, material), row.back);
        EXPECT_EQ(passes_straight(scene, material), row.straight);
        EXPECT_EQ(lets_through(scene, material), row.through);
    }
    scene.materials[coated].spec_trans = parameter_of(0.1f);
    EXPECT_TRUE(lets_through(scene, scene.materials[coated]));
}

}  // namespace
}  // namespace nearlight::core
