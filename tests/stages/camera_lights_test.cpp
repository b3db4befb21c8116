// SPDX-License-Identifier: Apache-2.0
#include "host/stages/camera_lights.h"

#include <gmock/gmock.h>

#include "host/base/random.h"
#include "host/reference/camera_lights_oracle.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

constexpr FilmLayout kFiveSamples{.samples = 5};
constexpr uint kPixelCount = kFiveSamples.width * kFiveSamples.height;
constexpr uint kFirstHalf = kFiveSamples.samples / 2;

/// Pixels whose camera light varies from not at all to by several times the light there is.
struct VariedPixels {
    std::vector<CameraLight> lights;
    std::vector<float> sums = std::vector<float>(std::size_t{kPixelCount} * NEARLIGHT_FILM_CHANNELS);
};
VariedPixels varied_pixels() {
    Pcg32 random(3, 1);
    VariedPixels pixels;
    for (uint i = 0; i < kPixelCount; ++i) {
        // Neighbours vary alike, and the more the lower they stand.
        const float spread = std::exp2(static_cast<float>(i / kFiveSamples.width) - 6.0f);
        const auto color = [&] {
            return Vec3{1 + spread * random.uniform(), 1 - spread * random.uniform(),
                        spread * random.uniform()};
        };
        pixels.lights.push_back({2 * color(), 3 * color()});
        for (const uint channel : {NEARLIGHT_SUM_DIRECT, NEARLIGHT_SUM_INDIRECT}) {
            std::generate_n(pixels.sums.begin() + i * NEARLIGHT_FILM_CHANNELS + channel, 3,
                            [&] { return 5 * random.uniform(); });
        }
    }
    return pixels;
}

class CameraLightsTest : public test::DeviceTest {
  protected:
    static std::vector<CameraLight> add(Device& device, const FilmSamples& samples, const CameraBatch& batch,
                                        const std::vector<CameraLight>& before) {
        CameraLights stage(device);
        Buffer<CameraLight> lights(device, before);
        stage.add(Buffer<CameraVertex>(device, samples.vertices), batch, kFiveSamples.width,
                  kFiveSamples.height, kFirstHalf, lights);
        return lights.download();
    }
    static std::vector<uint> rounds(Device& device, const VariedPixels& pixels) {
        test::GuardedBuffer<uint> rounds(device, kPixelCount);
        CameraLights(device).choose(
            Buffer<CameraLight>(device, pixels.lights), Buffer<float>(device, pixels.sums),
            {kFiveSamples.width, kFiveSamples.height, kFiveSamples.samples}, rounds.buffer());
        return rounds.download();
    }
};

TEST_F(CameraLightsTest, HalvesAreSumsOverSamplesAndBranches) {
    const FilmSamples samples = random_film_samples(kFiveSamples);
    const CameraBatch batch{.tile_row_count = static_cast<uint>(kFiveSamples.tile_rows()),
                            .sample_count = kFiveSamples.samples,
                            .samples_per_pixel = kFiveSamples.samples,
                            .branch_count = kFiveSamples.branches};
    on_each_device([&](Device& device) {
        const std::vector<CameraLight> found =
            add(device, samples, batch, std::vector<CameraLight>(kPixelCount, {{1, 0, 0}, {0, 2, 0}}));
        for (uint i = 0; i < kPixelCount; ++i) {
            const CameraLight expected = expected_camera_light(
                samples, kFiveSamples, kFirstHalf, i % kFiveSamples.width, i / kFiveSamples.width);
            ASSERT_NEAR(found[i].first.x, 1 + expected.first.x, 1e-5) << i;
            ASSERT_NEAR(found[i].first.z, expected.first.z, 1e-5) << i;
            ASSERT_NEAR(found[i].second.y, 2 + expected.second.y, 1e-5) << i;
        }
    });
}

TEST_F(CameraLightsTest, NeighboursDecideHowManyRoundsAPixelGets) {
    const VariedPixels pixels = varied_pixels();
    on_each_device([&](Device& device) {
        const std::vector<uint> found = rounds(device, pixels);
        std::array<uint, NEARLIGHT_MAX_ROUNDS + 1> counts{};
        for (uint i = 0; i < kPixelCount; ++i) {
            ASSERT_EQ(found[i],
                      expected_rounds(pixels.lights, pixels.sums, kFiveSamples.width, kFiveSamples.samples,
                                      i % kFiveSamples.width, i / kFiveSamples.width))
                << i;
            ++counts.at(found[i]);
        }
        EXPECT_THAT(counts, ::testing::Each(::testing::Gt(3u))) << "every number must occur";
    });
}

/// What a pixel has seen itself must not decide: else one that missed a lamp by chance would stay as it is.
TEST_F(CameraLightsTest, APixelDoesNotDecideForItselfNorForOtherSquares) {
    on_each_device([](Device& device) {
        for (const uint place : {7u, 8u}) {  // the last and the first pixels of squares
            VariedPixels pixels = varied_pixels();
            pixels.lights.assign(kPixelCount, {{2, 2, 2}, {3, 3, 3}});
            pixels.lights[place * kFiveSamples.width + place].first = {500, 500, 500};
            const std::vector<uint> found = rounds(device, pixels);
            for (uint i = 0; i < kPixelCount; ++i) {
                const uint x = i % kFiveSamples.width, y = i / kFiveSamples.width;
                const uint inwards = place == 7 ? 6 : 9;
                const bool is_neighbour = (x == place || x == inwards) && (y == place || y == inwards) &&
                                          (x == inwards || y == inwards);
                EXPECT_EQ(found[i], is_neighbour ? NEARLIGHT_MAX_ROUNDS : 0u) << x << ", " << y;
            }
        }
    });
}

TEST_F(CameraLightsTest, RoundsMakeTheMeanOfAllSamples) {
    on_each_device([](Device& device) {
        CameraLights stage(device);
        // Three pixels, of which the last and the first take a round that doubles their four samples.
        Buffer<CameraLight> lights(device, std::vector<CameraLight>(3, {{2, 4, 6}, {4, 4, 4}}));
        Buffer<float> sums(device, std::vector<float>(3 * std::size_t{NEARLIGHT_FILM_CHANNELS}, 10.0f));
        Buffer<uint> rounds(device, std::vector<uint>{2, 0, 1});
        const Buffer<uint> listed(device, std::vector<uint>{7, 2, 0});
        const Buffer<CameraLight> added(
            device, std::vector<CameraLight>{{{4, 4, 4}, {6, 0, 4}}, {{2, 4, 6}, {4, 4, 4}}});
        stage.refine(listed, 1, 2, added, 0.5f, lights, sums, rounds);
        EXPECT_EQ(rounds.download(), (std::vector<uint>{1, 0, 0}));
        const std::vector<float> changed = sums.download();
        const auto direct = [&](std::size_t pixel, std::size_t channel) {
            return changed[pixel * NEARLIGHT_FILM_CHANNELS + NEARLIGHT_SUM_DIRECT + channel];
        };
        EXPECT_EQ(direct(0, 0), 10.0f) << "as much as before";
        EXPECT_EQ(direct(1, 0), 10.0f);
        EXPECT_EQ(direct(2, 0), 10.0f - 6.0f + 0.5f * (6.0f + 10.0f));
        EXPECT_EQ(direct(2, 1), 10.0f - 8.0f + 0.5f * (8.0f + 4.0f));
        EXPECT_EQ(changed[2 * NEARLIGHT_FILM_CHANNELS + NEARLIGHT_SUM_VARIANCE],
                  10.0f - 2.0f + 0.5f * (2.0f + 4.0f));
        EXPECT_EQ(changed[2 * NEARLIGHT_FILM_CHANNELS + NEARLIGHT_SUM_INDIRECT], 10.0f);
        EXPECT_EQ(lights.download_one(2).first.x, 6.0f);
        EXPECT_EQ(lights.download_one(2).second.x, 10.0f);
        // The next round doubles eight samples.
        stage.refine(listed, 2, 1, added, 0.25f, lights, sums, rounds);
        EXPECT_EQ(sums.download()[NEARLIGHT_SUM_DIRECT], 10.0f - 6.0f + 0.25f * (12.0f + 10.0f));
    });
}

}  // namespace
}  // namespace nearlight::core
