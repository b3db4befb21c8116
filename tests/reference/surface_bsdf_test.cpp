// SPDX-License-Identifier: Apache-2.0
// Materials that stand for others: masks, blends, sides, normal and bump maps; and textures.
#include <gtest/gtest.h>

#include "tests/reference/bsdf_cases.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr Vec3 kRed{0.8f, 0.3f, 0.1f};

BsdfCase wrapped(const std::function<uint(Scene&)>& make) {
    return {"wrapped", square_of(make)};
}

void expect_color(Vec3d a, Vec3d b, double tolerance = 1e-6) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

/// Adds a bitmap of linear 8-bit texels, all channels alike, that is looked up at (u, v) itself.
int add_bitmap(Scene& scene, int width, int height, const std::vector<Vec3>& texels,
               uint filter = NEARLIGHT_FILTER_BILINEAR) {
    TextureImage image{
        .name = "test", .width = width, .height = height, .format = NEARLIGHT_TEXELS_LINEAR8, .words = {}};
    for (const Vec3 texel : texels) {
        const auto code = [](float x) { return static_cast<std::uint32_t>(std::lround(255 * x)); };
        image.words.push_back(code(texel.x) | code(texel.y) << 8u | code(texel.z) << 16u | 255u << 24u);
    }
    SceneTexture texture;
    texture.parameters.kind = NEARLIGHT_TEXTURE_BITMAP;
    texture.parameters.u_scale = texture.parameters.v_scale = 1.0f;
    texture.parameters.filter = filter;
    texture.parameters.wrap_s = texture.parameters.wrap_t = NEARLIGHT_WRAP_CLAMP;
    texture.parameters.format = NEARLIGHT_TEXELS_LINEAR8;
    texture.image = static_cast<int>(scene.images.size());
    scene.images.push_back(image);
    scene.textures.push_back(texture);
    return static_cast<int>(scene.textures.size()) - 1;
}

TEST(SurfaceBsdf, MasksLetLightThroughWithTheirOpacity) {
    for (const float opacity : {0.0f, 0.3f, 1.0f}) {
        const BsdfCase mask = wrapped([&](Scene& scene) {
            const uint child = add_material(scene, lambertian(kRed));
            return add_material(scene, mask_material(parameter_of(opacity), child));
        });
        int solid = 0;
        constexpr int kChoices = 1000;
        for (int i = 0; i < kChoices; ++i) {
            const SurfaceBsdf bsdf = mask.seen_from(towards(0.5), Transport::radiance, (i + 0.5) / kChoices);
            solid += bsdf.has_diffuse() ? 1 : 0;
            if (!bsdf.has_diffuse()) {
                const SurfaceDraw draw = bsdf.sample(0.5, {0.1, 0.2, 0.3});
                EXPECT_TRUE(draw.is_delta);
                expect_color(draw.wi, -towards(0.5));
                expect_color(draw.weight, {1, 1, 1});
            }
        }
        EXPECT_NEAR(solid, opacity * kChoices, 1);
    }
}

/// A number takes the luminance of a texture's colour.
TEST(SurfaceBsdf, BlendsMixByTheirTexture) {
    const BsdfCase blend = wrapped([](Scene& scene) {
        const uint first = add_material(scene, lambertian({1, 0, 0}));
        const uint second = add_material(scene, lambertian({0, 0, 1}));
        const int texture = add_bitmap(scene, 1, 1, {Vec3{0.2f, 0.6f, 1.0f}});
        return add_material(scene, blend_material(textured(texture), first, second));
    });
    Vec3d sum;
    constexpr int kChoices = 1000;
    for (int i = 0; i < kChoices; ++i) {
        sum += blend.seen_from(towards(0.5), Transport::radiance, (i + 0.5) / kChoices).diffuse_reflectance();
    }
    const double luminance = 0.2126 * 0.2 + 0.7152 * 0.6 + 0.0722;
    expect_color(sum / kChoices, {1 - luminance, 0, luminance}, 2e-3);
}

/// What is left of the random number decides about the blend within either half, and about the mask in that.
TEST(SurfaceBsdf, NestedBlendsShareTheirRandomNumber) {
    const BsdfCase blend = wrapped([](Scene& scene) {
        const auto masked = [&](Vec3 color) {
            return add_material(scene,
                                mask_material(parameter_of(0.5f), add_material(scene, lambertian(color))));
        };
        const auto blended = [&](uint first, uint second) {
            return add_material(scene, blend_material(parameter_of(0.25f), first, second));
        };
        const uint red_or_green = blended(masked({1, 0, 0}), masked({0, 1, 0}));
        return blended(red_or_green, blended(masked({0, 1, 0}), masked({0, 0, 1})));
    });
    Vec3d sum;
    constexpr int kChoices = 4096;
    for (int i = 0; i < kChoices; ++i) {
        sum += blend.seen_from(towards(0.5), Transport::radiance, (i + 0.5) / kChoices).diffuse_reflectance();
    }
    expect_color(sum / kChoices, {0.5 * 0.75 * 0.75, 0.5 * (0.75 * 0.25 + 0.25 * 0.75), 0.5 * 0.25 * 0.25},
                 2e-3);
}

TEST(SurfaceBsdf, SidesHaveTheirOwnMaterials) {
    const BsdfCase sides = wrapped([](Scene& scene) {
        const uint front = add_material(scene, lambertian({1, 0, 0}));
        const uint back = add_material(scene, rough(gold(), 0.3f, 0.3f));
        return add_material(scene, two_sided_material(front, back));
    });
    expect_color(sides.seen_from(towards(0.5)).diffuse_reflectance(), {1, 0, 0});
    const SurfaceBsdf back = sides.seen_from(towards(-0.5));
    EXPECT_FALSE(back.has_diffuse());
    EXPECT_TRUE(back.parameters().front);
    EXPECT_GT(back.eval(towards(-0.5, 3.5)).specular.x, 0.1);
    EXPECT_EQ(back.eval(towards(0.5, 3.5)).specular.x, 0);
}

TEST(SurfaceBsdf, OneSidedModelsAreBlackBehind) {
    for (const BsdfCase& test : opaque_cases()) {
        const SurfaceBsdf bsdf = test.seen_from(towards(-0.5));
        EXPECT_FALSE(bsdf.has_diffuse() || bsdf.has_specular()) << test.name;
        EXPECT_TRUE(is_zero(bsdf.eval(towards(-0.7)).sum())) << test.name;
        EXPECT_TRUE(is_zero(bsdf.sample(0.5, {0.5, 0.5, 0.5}).weight)) << test.name;
    }
}

/// A diffuse square with a normal map that holds one normal.
BsdfCase normal_mapped(Vec3 normal, bool two_sided) {
    return wrapped([&](Scene& scene) {
        const uint child = add_material(scene, lambertian(kRed));
        const Vec3 value = (normal + Vec3{1, 1, 1}) * 0.5f;
        const uint map = add_material(scene, normal_map_material(parameter_of(value), child));
        return two_sided ? add_material(scene, two_sided_material(map, map)) : map;
    });
}

TEST(SurfaceBsdf, AFlatNormalMapChangesNothing) {
    const BsdfCase flat = normal_mapped({0, 0, 1}, false);
    const SurfaceBsdf bsdf = flat.seen_from(towards(0.5));
    expect_color(bsdf.normal(), {0, 0, 1});
    expect_color(bsdf.eval(towards(0.3)).diffuse, as_double(kRed) * (0.3 / std::numbers::pi));
    const SurfaceBsdf without = normal_mapped({0, 0, 0}, false).seen_from(towards(0.5));
    expect_color(without.normal(), {0, 0, 1});
}

TEST(SurfaceBsdf, ANormalMapTurnsTheNormal) {
    const Vec3 tilted = normalize(Vec3{0.6f, 0, 0.8f});
    const BsdfCase mapped = normal_mapped(tilted, true);
    const SurfaceBsdf bsdf = mapped.seen_from(towards(0.9));
    expect_color(bsdf.normal(), {0.6, 0, 0.8}, 1e-6);
    // Light along the old normal: cosine 0.8, and no shadowing [Estevez et al. 2019] at θ = 0.
    expect_color(bsdf.eval({0, 0, 1}).diffuse, as_double(kRed) * (0.8 / std::numbers::pi), 1e-6);
    // At 45° the shadowing is 2/(1 + √(1 + α²)), α² = tan²/8 of the map's angle.
    const Vec3d light = normalize(Vec3d{1, 0, 1});
    const double shadowing = 2 / (1 + std::sqrt(1 + 0.75 * 0.75 / 8));
    expect_color(bsdf.eval(light).diffuse,
                 as_double(kRed) * (dot(light, {0.6, 0, 0.8}) * shadowing / std::numbers::pi), 1e-6);
    EXPECT_TRUE(is_zero(bsdf.eval(normalize(Vec3d{-1, 0, 0.2})).sum())) << "below the turned surface";
    EXPECT_TRUE(is_zero(bsdf.eval(normalize(Vec3d{1, 0, -0.2})).sum())) << "below the surface itself";
    // The back has the mirrored map, and a normal that faces away is turned about the surface's.
    expect_color(mapped.seen_from(towards(-0.9)).normal(), {0.6, 0, -0.8}, 1e-6);
    expect_color(mapped.seen_from(normalize(Vec3d{-0.9, 0, 0.2})).normal(), {-0.6, 0, 0.8}, 1e-6);
}

/// As in Mitsuba, the second axis of a map is at a right angle to u, whichever way v goes.
TEST(SurfaceBsdf, ANormalMapOnMirroredTextureCoordinatesIsRightHanded) {
    BsdfCase mapped = normal_mapped({0, 0.6f, 0.8f}, false);
    expect_color(mapped.seen_from(towards(0.9)).normal(), {0, 0.6, 0.8}, 1e-6);
    for (Vertex& vertex : mapped.scene.vertices) {
        vertex.u = 1 - vertex.u;
    }
    expect_color(mapped.seen_from(towards(0.9)).normal(), {0, -0.6, 0.8}, 1e-6);
    for (Vertex& vertex : mapped.scene.vertices) {
        vertex.u = 1 - vertex.u;
        vertex.v = 1 - vertex.v;
    }
    expect_color(mapped.seen_from(towards(0.9)).normal(), {0, 0.6, 0.8}, 1e-6);
}

/// As in Mitsuba, what passes a hole of a mask under a map is shadowed by the map like all else.
TEST(SurfaceBsdf, AMapShadowsTheHolesOfAMask) {
    constexpr Vec3 kTilted{0.6f, 0, 0.8f};
    const BsdfCase mapped = wrapped([&](Scene& scene) {
        const uint child = add_material(scene, lambertian(kRed));
        const uint mask = add_material(scene, mask_material(parameter_of(0.0f), child));
        return add_material(scene,
                            normal_map_material(parameter_of(kTilted * 0.5f + Vec3{1, 1, 1} * 0.5f), mask));
    });
    const Vec3d wo = towards(std::sqrt(0.5));
    const SurfaceDraw draw = mapped.seen_from(wo).sample(0.5, {0.1, 0.2, 0.3});
    EXPECT_TRUE(draw.is_delta);
    EXPECT_FALSE(draw.is_straight);
    expect_color(draw.wi, -wo);
    // At 45° the shadowing is 2/(1 + √(1 + α²)), α² = tan²/8 of the map's angle.
    const double shadowing = 2 / (1 + std::sqrt(1 + 0.125 * 0.36 / 0.64));
    expect_color(draw.weight, {shadowing, shadowing, shadowing}, 1e-6);
}

TEST(SurfaceBsdf, ABumpMapTiltsByItsSlope) {
    // Between the centres of its two texels, 0.5 apart, the height rises by 51/255 · 2 m along u.
    const BsdfCase bumped = wrapped([](Scene& scene) {
        const uint child = add_material(scene, lambertian(kRed));
        const int texture = add_bitmap(scene, 2, 1, {Vec3{0, 0, 0}, Vec3{0.2f, 0.2f, 0.2f}});
        return add_material(scene, bump_map_material(textured(texture, 2.0f), child));
    });
    const double slope = 0.4 / 0.5;
    expect_color(bumped.seen_from(towards(0.95)).normal(), normalize(Vec3d{-slope, 0, 1}), 1e-4);
    const BsdfCase along_v = wrapped([](Scene& scene) {
        const uint child = add_material(scene, lambertian(kRed));
        const int texture =
            add_bitmap(scene, 1, 4, {Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{0, 0, 0}, Vec3{0.2f, 0.2f, 0.2f}});
        return add_material(scene, bump_map_material(textured(texture), child));
    });
    // The point (0.5, 0.25) lies half way between the centres of the two lower rows, which are 0.25 apart.
    expect_color(along_v.seen_from(towards(0.95)).normal(), normalize(Vec3d{0, 0.8, 1}), 1e-4);
}

TEST(SurfaceBsdf, ABumpMapWithoutInterpolationIsFlat) {
    const BsdfCase bumped = wrapped([](Scene& scene) {
        const uint child = add_material(scene, lambertian(kRed));
        const int texture = add_bitmap(scene, 2, 1, {Vec3{0, 0, 0}, Vec3{1, 1, 1}}, NEARLIGHT_FILTER_NEAREST);
        return add_material(scene, bump_map_material(textured(texture, 2.0f), child));
    });
    expect_color(bumped.seen_from(towards(0.95)).normal(), {0, 0, 1});
}

/// As in Mitsuba, a bump map turns the axes of roughness with the derivative of the position by u.
TEST(SurfaceBsdf, AnisotropyUnderABumpMapFollowsTheTextureCoordinates) {
    BsdfCase test = wrapped([](Scene& scene) {
        const uint child = add_material(scene, rough(gold(), 0.6f, 0.1f));
        const int texture = add_bitmap(scene, 2, 1, {Vec3{0, 0, 0}, Vec3{0, 0, 0}});
        return add_material(scene, bump_map_material(textured(texture), child));
    });
    const auto spread = [&](Vec3d wi) { return test.seen_from({0, 0, 1}).eval(wi).specular.x; };
    EXPECT_GT(spread(towards(0.8, 0)), 5 * spread(towards(0.8, std::numbers::pi / 2)));
    // The derivative by u is then (0, 1, 0) in the world, and is taken for an axis of the surface's own
    // frame, whose first axis is that derivative already.
    for (Vertex& vertex : test.scene.vertices) {
        std::swap(vertex.u, vertex.v);
    }
    EXPECT_GT(spread(towards(0.8, 0)), 5 * spread(towards(0.8, std::numbers::pi / 2)));
}

TEST(SurfaceBsdf, ARoughnessForEachAxisComesFromATextureOfTwoNumbers) {
    const BsdfCase two = wrapped([](Scene& scene) {
        Material material = gold();
        const int texture = add_bitmap(scene, 1, 1, {Vec3{0.6f, 0.2f, 1.0f}});
        scene.textures[static_cast<std::size_t>(texture)].parameters.flags |= NEARLIGHT_TEXTURE_TWO_NUMBERS;
        material.roughness = textured(texture);
        return add_material(scene, material);
    });
    const BsdfCase constant =
        wrapped([](Scene& scene) { return add_material(scene, rough(gold(), 0.6f, 0.2f)); });
    for (const double azimuth : {0.0, 1.0, std::numbers::pi / 2}) {
        expect_color(two.seen_from({0, 0, 1}).eval(towards(0.8, azimuth)).specular,
                     constant.seen_from({0, 0, 1}).eval(towards(0.8, azimuth)).specular, 1e-5);
    }
}

TEST(SurfaceBsdf, AnisotropyFollowsTheTextureCoordinates) {
    BsdfCase test = bsdf_case("", [](Scene&) { return rough(gold(), 0.6f, 0.1f); });
    const auto spread = [&](Vec3d wi) { return test.seen_from({0, 0, 1}).eval(wi).specular.x; };
    EXPECT_GT(spread(towards(0.8, 0)), 5 * spread(towards(0.8, std::numbers::pi / 2)));
    for (Vertex& vertex : test.scene.vertices) {
        std::swap(vertex.u, vertex.v);
    }
    EXPECT_LT(5 * spread(towards(0.8, 0)), spread(towards(0.8, std::numbers::pi / 2)));
}

TEST(SurfaceBsdf, ShadingNormalsSayWhereTheFrontIs) {
    BsdfCase test = bsdf_case("", [](Scene&) { return lambertian(kRed); });
    for (Vertex& vertex : test.scene.vertices) {
        vertex.normal = normalize(Vec3{0.5f, 0, 1});
    }
    expect_color(test.seen_from({0, 0, 1}).normal(), normalize(Vec3d{0.5, 0, 1}), 1e-6);
    EXPECT_FALSE(test.seen_from(normalize(Vec3d{-1, 0, 0.2})).has_diffuse());
    EXPECT_TRUE(test.seen_from(normalize(Vec3d{1, 0, -0.2})).has_diffuse());
}

TEST(SurfaceBsdf, NestingReachesAsDeepAsTheLoaderAllows) {
    const BsdfCase nested = wrapped([](Scene& scene) {
        uint material = add_material(scene, lambertian(kRed));
        for (int depth = 0; depth < NEARLIGHT_MAX_BSDF_NESTING; ++depth) {
            material = add_material(scene, two_sided_material(material, material));
        }
        return material;
    });
    EXPECT_TRUE(nested.seen_from(towards(0.5)).has_diffuse());
}

TEST(SurfaceBsdf, NestingWithoutEndIsBlack) {
    const BsdfCase endless =
        wrapped([](Scene& scene) { return add_material(scene, two_sided_material(0, 0)); });
    EXPECT_FALSE(endless.seen_from(towards(0.5)).has_diffuse());
    EXPECT_FALSE(endless.seen_from(towards(0.5)).has_specular());
}

}  // namespace
}  // namespace nearlight::core
