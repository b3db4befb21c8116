// SPDX-License-Identifier: Apache-2.0
#include "host/stages/film.h"

#include <cmath>

#include "host/reference/film_oracle.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

const FilmLayout kLayout;

class FilmTest : public test::DeviceTest {};

/// Adds samples in the given batches and resolves.
std::vector<float> develop(Device& device, const FilmSamples& samples, const std::vector<uint>& batches) {
    Film film(device);
    Buffer<float> sums(device, kLayout.width * kLayout.height * NEARLIGHT_FILM_CHANNELS);
    sums.fill_zero();
    uint first = 0;
    for (const uint count : batches) {
        const FilmSamples batch = batch_of_samples(samples, kLayout, first, count);
        const Buffer<ReceiverPacket> receivers(device, batch.receivers);
        const Buffer<CameraVertex> vertices(device, batch.vertices);
        const Buffer<IrradiancePacket> direct(device, batch.direct);
        const Buffer<IrradiancePacket> gathered(device, batch.gathered);
        const Buffer<IrradiancePacket> indirect(device, batch.indirect);
        film.add(receivers, vertices, {.direct = direct, .gathered = gathered, .indirect = indirect},
                 {.tile_row_count = static_cast<uint>(kLayout.tile_rows()),
                  .first_sample = first,
                  .sample_count = count,
                  .samples_per_pixel = kLayout.samples,
                  .branch_count = kLayout.branches},
                 kLayout.width, kLayout.height, sums);
        device.finish();
        first += count;
    }
    test::GuardedBuffer<float> layers(device, kLayout.width * kLayout.height * NEARLIGHT_LAYER_CHANNELS);
    film.resolve(sums, kLayout.width * kLayout.height, kLayout.samples, layers.buffer());
    return layers.download();
}

TEST_F(FilmTest, LayersAreSumsOverSamplesAndBranches) {
    const FilmSamples samples = random_film_samples(kLayout);
    on_each_device([&](Device& device) {
        const std::vector<float> layers = develop(device, samples, {kLayout.samples});
        for (uint y = 0; y < kLayout.height; ++y) {
            for (uint x = 0; x < kLayout.width; ++x) {
                const std::vector<double> expected = expected_layers(samples, kLayout, x, y);
                for (std::size_t c = 0; c < expected.size(); ++c) {
                    ASSERT_NEAR(layers[(y * kLayout.width + x) * NEARLIGHT_LAYER_CHANNELS + c], expected[c],
                                2e-6)
                        << layer_channels()[c] << " of pixel " << x << ", " << y;
                }
            }
        }
    });
}

TEST_F(FilmTest, EveryLayerOfTheTableIsWritten) {
    const FilmSamples samples = random_film_samples(kLayout);
    on_each_device([&](Device& device) {
        const std::vector<float> layers = develop(device, samples, {kLayout.samples});
        for (const FilmLayer& layer : kFilmLayers) {
            for (std::size_t c = 0; c < layer.channel_count; ++c) {
                std::size_t lit = 0;
                for (std::size_t at = layer.first_channel + c; at < layers.size();
                     at += NEARLIGHT_LAYER_CHANNELS) {
                    ASSERT_LT(std::abs(layers[at]), 100.0f)
                        << channel_names(layer)[c] << " was never written";
                    lit += layers[at] > 0.0f;
                }
                EXPECT_GT(lit, kLayout.width * kLayout.height / 2) << channel_names(layer)[c];
            }
        }
    });
}

TEST_F(FilmTest, BatchesOfSamplesGiveTheSameBits) {
    const FilmSamples samples = random_film_samples(kLayout);
    on_each_device([&](Device& device) {
        const std::vector<float> whole = develop(device, samples, {3});
        EXPECT_EQ(develop(device, samples, {1, 2}), whole);
        EXPECT_EQ(develop(device, samples, {1, 1, 1}), whole);
    });
}

}  // namespace
}  // namespace nearlight::core
