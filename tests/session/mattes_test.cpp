// SPDX-License-Identifier: Apache-2.0
#include "host/session/mattes.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <map>

#include "host/base/cryptomatte_id.h"
#include "host/session/passes.h"
#include "host/session/render.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr std::array kBoth{NamedKind::object, NamedKind::material};

/// Twenty triangles, each an object of its own, of two materials.
Scene named_triangles() {
    Scene scene;
    for (const char* name : {"stone", "wood"}) {
        name_material(scene, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})), name);
    }
    for (uint i = 0; i < 20; ++i) {
        begin_object(scene, "thing " + std::to_string(i));
        add_triangle(scene, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, i % 2);
    }
    return scene;
}

/// The coverage of each identifier in a pixel's ranks.
std::map<std::uint32_t, float> coverage(std::span<const float> ranks) {
    std::map<std::uint32_t, float> result;
    for (std::size_t i = 0; i < kMatteChannels; i += 2) {
        if (ranks[i + 1] > 0.0f) {
            result[std::bit_cast<std::uint32_t>(ranks[i])] += ranks[i + 1];
        }
    }
    return result;
}

TEST(MatteCounter, RanksByCoverageAndKeepsTheSix) {
    const Scene scene = named_triangles();
    MatteCounter counter(scene, kBoth);
    counter.begin(2);
    // Pixel 0: object 3 three times, object 4 twice, six others once, and four samples of nothing. Pixel 1:
    // nothing but the last triangle.
    std::vector<uint> samples{3, 4, ~0u, 5, 3, 6, ~0u, 7, 8, 9, 10, 4, 3, ~0u, ~0u};
    const std::size_t count = samples.size();
    samples.resize(2 * count, 19);
    counter.add(samples);
    const std::vector<float> rows = counter.rows();
    ASSERT_EQ(rows.size(), 2 * 2 * kMatteChannels);
    const std::span<const float> ranks = rows;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(ranks[0]), cryptomatte_id("thing 3"));
    EXPECT_EQ(ranks[1], 3.0f / 15.0f);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(ranks[2]), cryptomatte_id("thing 4"));
    EXPECT_EQ(ranks[3], 2.0f / 15.0f);
    for (std::size_t rank = 2; rank < kMatteRanks; ++rank) {
        EXPECT_EQ(ranks[2 * rank + 1], 1.0f / 15.0f);
        EXPECT_TRUE(rank == 2 || std::bit_cast<std::uint32_t>(ranks[2 * rank - 2]) <
                                     std::bit_cast<std::uint32_t>(ranks[2 * rank]));
    }
    const auto materials = coverage(ranks.subspan(kMatteChannels, kMatteChannels));
    EXPECT_EQ(materials.size(), 2u);
    EXPECT_EQ(materials.at(cryptomatte_id("wood")), 6.0f / 15.0f);   // objects 3, 5, 7, 9
    EXPECT_EQ(materials.at(cryptomatte_id("stone")), 5.0f / 15.0f);  // objects 4, 6, 8, 10
    const std::span<const float> of_pixel_1 = ranks.subspan(2 * kMatteChannels);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(of_pixel_1[0]), cryptomatte_id("thing 19"));
    EXPECT_EQ(of_pixel_1[1], 1.0f);
    EXPECT_EQ(of_pixel_1[2], 0.0f);
    EXPECT_EQ(of_pixel_1[3], 0.0f);
}

TEST(MatteCounter, AddsSeveralPassesAndBeginsAnew) {
    const Scene scene = named_triangles();
    MatteCounter counter(scene, std::span(kBoth).first(1));
    for (int round = 0; round < 2; ++round) {
        counter.begin(1);
        counter.add(std::vector<uint>{0, 0});
        counter.add(std::vector<uint>{1, 1, 1, 0});
        const auto found = coverage(counter.rows());
        EXPECT_EQ(found.at(cryptomatte_id("thing 0")), 0.5f);
        EXPECT_EQ(found.at(cryptomatte_id("thing 1")), 0.5f);
    }
}

TEST(MatteBands, HoldEachSampleOnce) {
    for (const auto& [width, height, passes] : {std::tuple{7u, 5u, std::vector<MattePass>{{1, 3}, {2, 1}}},
                                                {5000u, 40u, std::vector<MattePass>{{1, 100}}},
                                                {60000u, 3u, std::vector<MattePass>{{1, 64}, {5, 2}}},
                                                {1u, 1u, std::vector<MattePass>{{1, 65536 * 16}}}}) {
        uint next_row = 10;
        for (const PixelWindow& band : matte_bands({3, 10, width, height}, passes)) {
            EXPECT_EQ(band.y, next_row);
            EXPECT_EQ(band.x, 3u);
            EXPECT_EQ(band.width, width);
            next_row += band.height;
            for (const MattePass& pass : passes) {
                uint next_sample = 0;
                for (const SampleBlock& block : sample_blocks(band, pass)) {
                    EXPECT_EQ(block.first_sample, next_sample);
                    EXPECT_EQ(block.in_middle, pass.samples_per_pixel == 1);
                    EXPECT_LE(block.size(), std::size_t{1} << 19);
                    next_sample += block.sample_count;
                }
                EXPECT_EQ(next_sample, pass.samples_per_pixel);
            }
        }
        EXPECT_EQ(next_row, 10 + height);
    }
}

constexpr std::size_t kMatteWidth = 48;
constexpr std::size_t kMatteHeight = 32;
constexpr std::size_t kPixelFloats = kBoth.size() * kMatteChannels;

/// Five boards side by side before the sky.
Scene boards() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    for (uint i = 0; i < 5; ++i) {
        begin_object(scene, "board " + std::to_string(i));
        const auto place = static_cast<float>(i);
        add_quad(scene, {-0.9f + 0.35f * place, -0.4f, 2.0f + 0.1f * place}, {0.1f, 0.7f, 0}, {0.2f, 0, 0},
                 grey);
    }
    set_constant_sky(scene, {1, 1, 1});
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 50);
    scene.camera.filter = default_filter(FilterKind::gaussian);
    return scene;
}

/// A picture of three passes and its mattes.
class MattesOfPicture {
  public:
    MattesOfPicture(Device& device, const Scene& scene) : session_(device, scene) {
        RenderSettings settings;
        settings.view.width = kMatteWidth;
        settings.view.height = kMatteHeight;
        settings.sampling.vpl_count = 20;
        settings.gather.samples_per_pixel = 4;
        settings.gather.splat = false;  // mattes have samples of each pixel's own
        settings.passes = 3;
        settings.seed = 7;
        RenderHooks hooks;
        hooks.open = [&](const RenderReport&, const View& view, const VplSet&) { camera_ = view.camera; };
        hooks.rows = [&](std::span<const float> rows) {
            picture_.insert(picture_.end(), rows.begin(), rows.end());
        };
        const RenderReport report = render(session_, settings, hooks);
        for (const uint samples : report.pass_samples) {
            const auto pass = static_cast<uint>(passes_.size());
            passes_.push_back({pass_seed(settings.seed, pass), samples});
        }
    }
    [[nodiscard]] float alpha(std::size_t pixel) const {
        return picture_.at(pixel * NEARLIGHT_LAYER_CHANNELS + NEARLIGHT_LAYER_ALPHA);
    }
    std::vector<float> mattes(const std::optional<PixelWindow>& window) {
        std::vector<float> all;
        fraction_ = 0.0;
        session_.mattes(
            camera_, window, passes_, kBoth,
            [&](std::span<const float> rows) {
                all.insert(all.end(), rows.begin(), rows.end());
                return true;
            },
            [&](double fraction) {
                EXPECT_GT(fraction, fraction_);
                fraction_ = fraction;
                return fraction < stop_at_;
            });
        return all;
    }
    void stop_at(double fraction) { stop_at_ = fraction; }
    [[nodiscard]] double fraction() const { return fraction_; }  ///< of the mattes that were counted

  private:
    Session session_;
    Camera camera_{};
    std::vector<MattePass> passes_;
    std::vector<float> picture_;
    double stop_at_ = 2.0;
    double fraction_ = 0.0;
};

class Mattes : public test::DeviceTest {};

/// Surfaces without holes cover what the layer A says, in each pixel, with all passes together.
TEST_F(Mattes, CoverWhatSurfacesCover) {
    const Scene scene = boards();
    on_each_device([&](Device& device) {
        MattesOfPicture picture(device, scene);
        const std::vector<float> all = picture.mattes(std::nullopt);
        ASSERT_EQ(all.size(), kMatteWidth * kMatteHeight * kPixelFloats);
        std::size_t partly = 0;
        for (std::size_t i = 0; i < kBoth.size() * kMatteWidth * kMatteHeight; ++i) {
            float covered = 0.0f;
            for (const auto& [id, part] :
                 coverage(std::span(all).subspan(i * kMatteChannels, kMatteChannels))) {
                covered += part;
            }
            const float alpha = picture.alpha(i / kBoth.size());
            EXPECT_NEAR(covered, alpha, 1e-6f) << i;
            partly += alpha > 0.0f && alpha < 1.0f ? 1 : 0;
        }
        EXPECT_GT(partly, 100u);
    });
}

TEST_F(Mattes, StopWhenNobodyWantsMore) {
    const Scene scene = boards();
    on_each_device([&](Device& device) {
        MattesOfPicture picture(device, scene);
        EXPECT_FALSE(picture.mattes(std::nullopt).empty());
        EXPECT_EQ(picture.fraction(), 1.0);
        picture.stop_at(0.5);
        EXPECT_TRUE(picture.mattes(std::nullopt).empty()) << "all rows are one band";
        EXPECT_NEAR(picture.fraction(), 2.0 / 3.0, 1e-9) << "after the second of three passes";
    });
}

TEST_F(Mattes, OfAPartHaveTheBitsOfTheWhole) {
    const Scene scene = boards();
    on_each_device([&](Device& device) {
        MattesOfPicture picture(device, scene);
        const std::vector<float> all = picture.mattes(std::nullopt);
        const std::vector<float> part = picture.mattes(PixelWindow{9, 5, 20, 17});
        ASSERT_EQ(part.size(), 20 * 17 * kPixelFloats);
        for (std::size_t row = 0; row < 17; ++row) {
            EXPECT_EQ(std::memcmp(&part[row * 20 * kPixelFloats],
                                  &all[((row + 5) * kMatteWidth + 9) * kPixelFloats],
                                  20 * kPixelFloats * sizeof(float)),
                      0)
                << row;
        }
    });
}

}  // namespace
}  // namespace nearlight::core
