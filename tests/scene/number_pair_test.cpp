// SPDX-License-Identifier: Apache-2.0
#include "host/scene/number_pair.h"

#include <gtest/gtest.h>

#include <functional>

#include "host/scene/material_model.h"
#include "host/scene/texture.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core {
namespace {

class NumberPair : public testing::Test {
  protected:
    /// A bitmap of linear grey texels in one row.
    Parameter bitmap(const std::vector<unsigned>& bytes, float scale = 1.0f) {
        TextureImage image{"grey", static_cast<int>(bytes.size()), 1, NEARLIGHT_TEXELS_LINEAR8, {}};
        for (const unsigned byte : bytes) {
            image.words.push_back(byte * 0x010101u);
        }
        scene_.images.push_back(image);
        SceneTexture texture = plain_texture(static_cast<int>(scene_.images.size() - 1));
        texture.parameters.filter = NEARLIGHT_FILTER_NEAREST;
        return textured(add_texture(scene_, texture), scale);
    }
    Parameter board(const Parameter& first, const Parameter& second, float scale = 1.0f) {
        SceneTexture texture = plain_texture(-1);
        texture.parameters.kind = NEARLIGHT_TEXTURE_CHECKERBOARD;
        texture.parameters.color0 = first;
        texture.parameters.color1 = second;
        return textured(add_texture(scene_, texture), scale);
    }
    Parameter vertex_color() {
        SceneTexture texture = plain_texture(-1);
        texture.parameters.kind = NEARLIGHT_TEXTURE_VERTEX_COLOR;
        return textured(add_texture(scene_, texture));
    }
    /// The pair has the numbers of u and v all over the surface.
    void expect_pair(const Parameter& u, const Parameter& v) {
        const std::optional<Parameter> pair = pair_of_numbers(scene_, u, v);
        ASSERT_TRUE(pair.has_value());
        for (const float s : {0.1f, 0.3f, 0.6f, 0.9f}) {
            for (const float t : {0.2f, 0.8f}) {
                const Vec3 both = parameter_value(scene_, *pair, s, t);
                EXPECT_NEAR(both.x, parameter_number(scene_, u, s, t), 1e-3f) << s << " " << t;
                EXPECT_NEAR(both.y, parameter_number(scene_, v, s, t), 1e-3f) << s << " " << t;
            }
        }
    }
    /// The pair of two bitmaps of two texels, where `change` is done to the second one's texture.
    bool is_pair_after(const std::function<void(Texture&)>& change) {
        const Parameter u = bitmap({10, 200});
        const Parameter v = bitmap({90, 50});
        change(scene_.textures[static_cast<std::size_t>(v.texture)].parameters);
        return pair_of_numbers(scene_, u, v).has_value();
    }

    Scene scene_;
};

TEST_F(NumberPair, NumbersAndOneTextureNeedNothingNew) {
    expect_pair(parameter_of(0.25f), parameter_of(0.5f));
    Parameter u = bitmap({10, 200}, 0.5f);
    const Parameter v{u.value * 0.25f, u.texture};
    expect_pair(u, v);
    EXPECT_EQ(scene_.textures.size(), 1u);
    EXPECT_FALSE(holds_two_numbers(scene_, u));
    EXPECT_FALSE(holds_two_numbers(scene_, parameter_of(1.0f)));
}

TEST_F(NumberPair, BitmapsBecomeOne) {
    const Parameter u = bitmap({10, 200}, 0.5f);
    expect_pair(u, bitmap({90, 50}, 2.0f));
    expect_pair(u, parameter_of(0.3f));
    expect_pair(parameter_of(0.3f), u);
    EXPECT_TRUE(holds_two_numbers(scene_, *pair_of_numbers(scene_, u, parameter_of(0.3f))));
}

TEST_F(NumberPair, CheckerboardsBecomeOneFieldByField) {
    const Parameter u = board(parameter_of(0.1f), parameter_of(0.7f), 0.5f);
    expect_pair(u, board(parameter_of(0.6f), parameter_of(0.2f)));
    expect_pair(u, parameter_of(0.3f));
    expect_pair(parameter_of(0.3f), u);
    expect_pair(u, board(bitmap({10, 200}), parameter_of(0.2f)));
    expect_pair(board(bitmap({1, 2}), u), board(bitmap({10, 200}), parameter_of(0.2f)));
}

TEST_F(NumberPair, TexturesThatDifferAreNoPair) {
    EXPECT_TRUE(is_pair_after([](Texture&) {}));
    EXPECT_FALSE(is_pair_after([](Texture& t) { t.wrap_s = NEARLIGHT_WRAP_CLAMP; }));
    EXPECT_FALSE(is_pair_after([](Texture& t) { t.wrap_t = NEARLIGHT_WRAP_MIRROR; }));
    EXPECT_FALSE(is_pair_after([](Texture& t) { t.filter = NEARLIGHT_FILTER_BILINEAR; }));
    EXPECT_FALSE(is_pair_after([](Texture& t) { t.flags = NEARLIGHT_TEXTURE_SECOND_UV; }));
    for (float Texture::*const place : {&Texture::u_scale, &Texture::u_shear, &Texture::u_offset,
                                        &Texture::v_shear, &Texture::v_scale, &Texture::v_offset}) {
        EXPECT_FALSE(is_pair_after([place](Texture& t) { t.*place += 0.5f; }));
    }
    const Parameter u = bitmap({10, 200});
    EXPECT_FALSE(pair_of_numbers(scene_, u, bitmap({1, 2, 3})));
    EXPECT_FALSE(pair_of_numbers(scene_, u, board(parameter_of(0.1f), parameter_of(0.7f))));
    EXPECT_FALSE(pair_of_numbers(scene_, u, vertex_color()));
    EXPECT_FALSE(pair_of_numbers(scene_, vertex_color(), parameter_of(0.5f)));
    EXPECT_FALSE(pair_of_numbers(scene_, board(u, parameter_of(0.1f)), board(vertex_color(), u)));
}

}  // namespace
}  // namespace nearlight::core
