// SPDX-License-Identifier: Apache-2.0
// What lies between a point of a mesh and its BSDF: shading normals, textures, normal and bump maps, and
// materials that stand for others.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/stages/mitsuba_bsdf_values.h"
#include "tests/support/bsdf_materials.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using namespace test;

class BsdfSurfaceTest : public DeviceTest {};

/// A triangle in the plane z = 0 with normals that lean away from it.
BsdfScene make_mesh() {
    BsdfScene scene;
    scene.curves = make_curves();
    scene.vertices = {{{0, 0, 0}, 0.1f, normalize({0.1f, 0, 1}), 0.2f},
                      {{1, 0, 0}, 0.8f, normalize({-0.2f, 0.1f, 1}), 0.35f},
                      {{0, 1, 0}, 0.25f, normalize({0, 0.3f, 1}), 0.9f}};
    return scene;
}

BsdfQuery mesh_query(Vec3 wo, Vec3 wi, uint mode = kRadiance) {
    BsdfQuery query = make_query(wo, wi, kBothParts, mode);
    query.weight1 = 0.3f;
    query.weight2 = 0.25f;
    query.choice = 0.5f;
    return query;
}

constexpr uint rgb_word(uint r, uint g, uint b) {
    return r | g << 8 | b << 16 | 0xff000000u;
}

/// Three by two texels, as they are or, of each, red alone.
Texture add_picture(BsdfScene& scene, bool red_only = false) {
    const uint picture[6][3] = {{100, 140, 200}, {200, 90, 220}, {30, 180, 190},
                                {128, 128, 255}, {60, 30, 230},  {160, 200, 210}};
    Texture texture{};
    texture.kind = NEARLIGHT_TEXTURE_BITMAP;
    texture.first_word = static_cast<uint>(scene.texels.size());
    texture.width = 3;
    texture.height = 2;
    texture.format = NEARLIGHT_TEXELS_LINEAR8;
    texture.u_scale = texture.v_scale = 1;
    for (const auto& [r, g, b] : picture) {
        scene.texels.push_back(red_only ? rgb_word(r, r, r) : rgb_word(r, g, b));
    }
    return texture;
}

Material make_map(uint model, float value) {
    Material material = make_wrapper(model, {{value, value, value}, 0}, 1, 1);
    material.flags = NEARLIGHT_MATERIAL_TANGENT;
    return material;
}

Material make_anisotropic_metal() {
    return make_metal(0.2f, 0.6f, NEARLIGHT_MATERIAL_TANGENT, {0, 0, 0}, {1, 1, 1});
}

/// Makes what stands at materials[1] the mesh's material, on both sides, and under the map.
void set_material(BsdfScene& scene, const std::string& surface) {
    const bool bumped = surface.starts_with("bump map");
    const bool mapped = bumped || surface.starts_with("normal map");
    Material model = make_diffuse(constant(kBase));
    if (surface == "anisotropic" || surface.ends_with("metal")) {
        model = make_anisotropic_metal();
    } else if (surface.ends_with("glass")) {
        model = make_glass(0.3f, 0.3f, 0);
    }
    scene.materials = {make_wrapper(NEARLIGHT_BSDF_TWO_SIDED, constant(1.0f), 1, 1), model};
    if (mapped) {
        scene.textures = {add_picture(scene, bumped)};
        scene.materials[0] =
            make_map(bumped ? NEARLIGHT_BSDF_BUMP_MAP : NEARLIGHT_BSDF_NORMAL_MAP, bumped ? 0.15f : 1.0f);
        if (!surface.ends_with("glass")) {
            const Material map = scene.materials[0];
            scene.materials.push_back(map);
            scene.materials[0] = make_wrapper(NEARLIGHT_BSDF_TWO_SIDED, constant(1.0f), 2, 2);
        }
    }
}

/// Gives the mesh a textured diffuse material, and all its points the texture coordinates.
void set_texture(BsdfScene& scene, const std::string& surface, float u, float v) {
    Texture texture = add_picture(scene);
    texture.format = surface == "bilinear mirror" ? NEARLIGHT_TEXELS_LINEAR8 : NEARLIGHT_TEXELS_SRGB8;
    texture.filter = surface == "nearest clamp" ? NEARLIGHT_FILTER_NEAREST : NEARLIGHT_FILTER_BILINEAR;
    texture.wrap_s = texture.wrap_t = surface == "nearest clamp"     ? NEARLIGHT_WRAP_CLAMP
                                      : surface == "bilinear mirror" ? NEARLIGHT_WRAP_MIRROR
                                                                     : NEARLIGHT_WRAP_REPEAT;
    scene.textures = {texture};
    scene.materials[1].reflectance = {{1, 1, 1}, 0};
    for (Vertex& vertex : scene.vertices) {
        vertex.u = u;
        vertex.v = 1 - v;
    }
}

TEST_F(BsdfSurfaceTest, ValuesAreMitsubas) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (const MitsubaSurfaceValue& row : kMitsubaSurfaceValues) {
            const std::string surface = row.surface;
            SCOPED_TRACE(surface);
            BsdfScene scene = make_mesh();
            set_material(scene, surface);
            if (surface.starts_with("bilinear") || surface.starts_with("nearest")) {
                set_texture(scene, surface, row.u, row.v);
            }
            const Vec3 value = probe.ask(scene, mesh_query(row.wo, row.wi)).value;
            EXPECT_NEAR(value.x, row.value.x, 1e-4f * row.value.x + 1e-7f);
            EXPECT_NEAR(value.y, row.value.y, 1e-4f * row.value.y + 1e-7f);
            EXPECT_NEAR(value.z, row.value.z, 1e-4f * row.value.z + 1e-7f);
        }
    });
}

/// Flux along wi, expected over the choice of a map's normal, of which one in eight is turned.
float expected_flux(BsdfProbe& probe, const BsdfScene& scene, Vec3 light, Vec3 viewer) {
    BsdfQuery query = mesh_query(light, viewer, kFlux);
    const float plain = probe.ask(scene, query).value.x;
    query.choice = 0.01f;
    return 0.875f * plain + 0.125f * probe.ask(scene, query).value.x;
}

/// radiance · |cosθ of the viewer| = flux · |cosθ of the light|, with cosines to the triangle itself.
TEST_F(BsdfSurfaceTest, BothEndsOfAPathAgreeOnTiltedNormals) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (const char* surface :
             {"shading normal", "anisotropic", "normal map", "bump map on metal", "normal map on glass"}) {
            SCOPED_TRACE(surface);
            BsdfScene scene = make_mesh();
            set_material(scene, surface);
            Pcg32 random(3);
            int lit = 0;
            for (int i = 0; i < 400; ++i) {
                const Vec3 viewer = random_direction(random);
                const Vec3 light = random_direction(random);
                const float a = probe.ask(scene, mesh_query(viewer, light)).value.x * std::abs(viewer.z);
                const float b = expected_flux(probe, scene, light, viewer) * std::abs(light.z);
                EXPECT_NEAR(a, b, 2e-3f * std::max(a, b) + 1e-5f) << i;
                lit += a > 0 ? 1 : 0;
            }
            EXPECT_GT(lit, 100);
        }
    });
}

TEST_F(BsdfSurfaceTest, SidesFollowTheShadingNormal) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene = make_mesh();
        for (Vertex& vertex : scene.vertices) {
            vertex.normal = {0, 0, -1};
        }
        scene.materials = {make_diffuse(constant(kBase))};
        const Vec3 up = direction_at(30);
        EXPECT_EQ(probe.ask(scene, make_query(up, up, kBothParts)).value.x, 0.0f);
        EXPECT_NEAR(probe.ask(scene, make_query(-up, -up, kBothParts)).value.x, kBase.x / kPi * up.z, 1e-6f);
        scene.materials = {make_wrapper(NEARLIGHT_BSDF_TWO_SIDED, constant(1.0f), 1, 2),
                           make_diffuse(constant(0.2f)), make_diffuse(constant(0.7f))};
        EXPECT_NEAR(probe.ask(scene, make_query(up, up, kBothParts)).value.x, 0.7f / kPi * up.z, 1e-6f);
        EXPECT_NEAR(probe.ask(scene, make_query(-up, -up, kBothParts)).value.x, 0.2f / kPi * up.z, 1e-6f);
    });
}

/// A texel (½, ½, ½) stands for a normal without a direction, which changes nothing.
TEST_F(BsdfSurfaceTest, NormalsWithoutADirectionChangeNothing) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene;
        scene.textures = {add_picture(scene)};
        scene.materials = {make_map(NEARLIGHT_BSDF_NORMAL_MAP, 1), make_diffuse(constant(0.6f))};
        scene.materials[0].reflectance = constant(0.5f);
        const BsdfAnswer answer =
            probe.ask(scene, make_query(direction_at(20), direction_at(60), kBothParts));
        EXPECT_NEAR(answer.value.x, 0.6f / kPi * 0.5f, 1e-5f);
    });
}

TEST_F(BsdfSurfaceTest, NestingThatIsTooDeepIsBlack) {
    on_each_device([](Device& device) {
        BsdfScene scene;
        scene.materials = {make_wrapper(NEARLIGHT_BSDF_TWO_SIDED, constant(1.0f), 0, 0)};
        const BsdfAnswer answer =
            BsdfProbe(device).ask(scene, make_query(direction_at(20), direction_at(0), kBothParts));
        EXPECT_EQ(answer.value.x, 0.0f);
        EXPECT_EQ(answer.weight.x, 0.0f);
    });
}

float reflectance_at(BsdfProbe& probe, BsdfScene& scene, float u, float v) {
    for (Vertex& vertex : scene.vertices) {
        vertex.u = u;
        vertex.v = v;
    }
    return probe.ask(scene, make_query({0, 0, 1}, {0, 0, 1}, kBothParts)).value.x * kPi;
}

TEST_F(BsdfSurfaceTest, HalfFloatsKeepTheirRange) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene;
        Texture texture = add_picture(scene);
        texture.format = NEARLIGHT_TEXELS_HALF;
        texture.width = 2;
        texture.height = 1;
        texture.first_word = 6;
        scene.texels.insert(scene.texels.end(),
                            {0x40003400u, 0x3c003c00u, 0x00005620u, 0u});  // R 0.25, G 2; R 98
        scene.textures = {texture};
        scene.materials = {make_diffuse({{1, 1, 1}, 0})};
        EXPECT_NEAR(reflectance_at(probe, scene, 0.25f, 0.5f), 0.25f, 1e-5f);
        EXPECT_NEAR(reflectance_at(probe, scene, 0.75f, 0.5f), 98.0f, 1e-3f);
        EXPECT_NEAR(reflectance_at(probe, scene, 0.5f, 0.5f), 49.125f, 1e-3f);
        const float nan = std::numeric_limits<float>::quiet_NaN();
        EXPECT_NEAR(reflectance_at(probe, scene, nan, 0.5f), reflectance_at(probe, scene, 0, 0.5f), 1e-5f);
        EXPECT_TRUE(std::isfinite(reflectance_at(probe, scene, 1e30f, -1e30f)));
    });
}

TEST_F(BsdfSurfaceTest, CheckerboardsOfTexturesAndVertexColors) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene;
        scene.vertex_colors = {{0.1f, 0, 0}, {0.5f, 0, 0}, {0.9f, 0, 0}};
        Texture board{};
        board.kind = NEARLIGHT_TEXTURE_CHECKERBOARD;
        board.u_scale = board.v_scale = 2;
        board.color0 = {{0.5f, 0, 0}, 1};
        board.color1 = constant(0.25f);
        Texture colors{};
        colors.kind = NEARLIGHT_TEXTURE_VERTEX_COLOR;
        scene.textures = {board, colors};
        scene.materials = {make_diffuse({{1, 1, 1}, 0})};
        const float mean = 0.5f * 0.1f + 0.25f * 0.5f + 0.25f * 0.9f;
        EXPECT_NEAR(reflectance_at(probe, scene, 0.1f, 0.6f), 0.5f * mean, 1e-6f);
        EXPECT_NEAR(reflectance_at(probe, scene, 0.3f, 0.9f), 0.5f * mean, 1e-6f);
        EXPECT_NEAR(reflectance_at(probe, scene, 0.3f, 0.6f), 0.25f, 1e-6f);
        scene.textures.push_back(board);  // which the first one has in it
        scene.textures[0].color0.texture = 2;
        EXPECT_NEAR(reflectance_at(probe, scene, 0.1f, 0.6f), 0.5f * 0.5f * mean, 1e-6f);
        EXPECT_NEAR(reflectance_at(probe, scene, 0.3f, 0.6f), 0.25f, 1e-6f);
    });
}

TEST_F(BsdfSurfaceTest, BitmapsAtSecondCoordinatesTimesVertexColorsAndCutOff) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene;
        Texture texture = add_picture(scene);
        scene.textures = {texture};
        scene.materials = {make_diffuse({{1, 1, 1}, 0})};
        const float here = reflectance_at(probe, scene, 0.2f, 0.3f);
        const float there = reflectance_at(probe, scene, 0.8f, 0.6f);
        ASSERT_NE(here, there);
        scene.second_uvs = {{0.8f, 0.6f}, {0.8f, 0.6f}, {0.8f, 0.6f}};
        scene.textures[0].flags = NEARLIGHT_TEXTURE_SECOND_UV;
        EXPECT_NEAR(reflectance_at(probe, scene, 0.2f, 0.3f), there, 1e-6f);
        scene.vertex_colors = {{0.5f, 0, 0}, {0.5f, 0, 0}, {0.5f, 0, 0}};
        scene.textures[0].flags = NEARLIGHT_TEXTURE_TIMES_COLOR;
        EXPECT_NEAR(reflectance_at(probe, scene, 0.2f, 0.3f), 0.5f * here, 1e-6f);
        scene.textures[0].flags = 0;
        scene.textures[0].cutoff = 0.5f * (here + there);
        EXPECT_EQ(reflectance_at(probe, scene, 0.2f, 0.3f) > 0.5f, here > there);
        EXPECT_EQ(reflectance_at(probe, scene, 0.8f, 0.6f) > 0.5f, there > here);
    });
}

/// A number takes the luminance of a colour, unless red and green are two numbers.
TEST_F(BsdfSurfaceTest, RoughnessTakesTheLuminanceOfATexture) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene = scene_of(make_metal(0.5f, 0.5f, 0, {0, 0, 0}, {1, 1, 1}));
        const BsdfQuery query = make_query(direction_at(30), direction_at(35, 3.5f), kPartS);
        Texture texture = add_picture(scene);
        scene.texels.assign(6, rgb_word(51, 153, 255));
        scene.textures = {texture};
        scene.materials[0].roughness.texture = 0;
        const float expected = 0.5f * (0.2126f * 0.2f + 0.7152f * 0.6f + 0.0722f);
        const BsdfScene plain = scene_of(make_metal(expected, expected, 0, {0, 0, 0}, {1, 1, 1}));
        EXPECT_NEAR(probe.ask(scene, query).value.x, probe.ask(plain, query).value.x, 1e-5f);
        scene.textures[0].flags = NEARLIGHT_TEXTURE_TWO_NUMBERS;
        const BsdfScene two = scene_of(make_metal(0.5f * 0.2f, 0.5f * 0.6f, 0, {0, 0, 0}, {1, 1, 1}));
        EXPECT_NEAR(probe.ask(scene, query).value.x, probe.ask(two, query).value.x, 1e-5f);
        EXPECT_GT(std::abs(probe.ask(two, query).value.x - probe.ask(plain, query).value.x), 1e-2f);
    });
}

/// Textures of half floats may hold any numbers; models get them between 0 and 1.
TEST_F(BsdfSurfaceTest, NumbersOfTexturesAreLimited) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        const BsdfQuery query = make_query(direction_at(30), direction_at(35, 3.5f), kBothParts);
        for (Parameter Material::*member :
             {&Material::roughness, &Material::metallic, &Material::clearcoat, &Material::spec_trans}) {
            BsdfScene limited = scene_of(make_principled(0));
            limited.curves = make_curves();
            BsdfScene textured = limited;
            limited.materials[0].*member = constant(1.0f);
            textured.textures = {add_picture(textured)};
            textured.texels.assign(6, rgb_word(255, 255, 255));
            textured.materials[0].*member = {{7, 7, 7}, 0};
            const BsdfAnswer expected = probe.ask(limited, query);
            const BsdfAnswer found = probe.ask(textured, query);
            EXPECT_NEAR(found.value.x, expected.value.x, 1e-5f * expected.value.x);
            EXPECT_NEAR(found.value.z, expected.value.z, 1e-5f * expected.value.z);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
