// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "host/reference/film_oracle.h"
#include "host/selftest/checks.h"
#include "host/stages/film.h"

namespace nearlight::core {

void check_film(Device& device, CheckResult& result) {
    const FilmLayout layout{.width = 53, .height = 37};
    const FilmSamples samples = random_film_samples(layout);
    const CameraBand band{.tile_row_count = static_cast<uint>(layout.tile_rows()),
                          .sample_count = layout.samples,
                          .samples_per_pixel = layout.samples,
                          .branch_count = layout.branches};
    const std::size_t pixels = std::size_t{layout.width} * layout.height;
    const Buffer<ReceiverPacket> receivers(device, samples.receivers);
    const Buffer<CameraVertex> vertices(device, samples.vertices);
    const Buffer<IrradiancePacket> direct(device, samples.direct);
    const Buffer<IrradiancePacket> gathered(device, samples.gathered);
    const Buffer<IrradiancePacket> indirect(device, samples.indirect);
    Buffer<float> sums(device, pixels * NEARLIGHT_FILM_CHANNELS);
    Buffer<float> layers(device, pixels * NEARLIGHT_LAYER_CHANNELS);
    sums.fill_zero();
    Film film(device);
    film.add(receivers, vertices, {.direct = direct, .gathered = gathered, .indirect = indirect}, band,
             layout.width, layout.height, sums);
    film.resolve(sums, pixels, layout.samples, layers);
    const std::vector<float> found = layers.download();
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::vector<double> expected =
            expected_layers(samples, layout, static_cast<uint>(pixel % layout.width),
                            static_cast<uint>(pixel / layout.width));
        for (std::size_t c = 0; c < expected.size(); ++c) {
            result.expect(std::abs(found[pixel * NEARLIGHT_LAYER_CHANNELS + c] - expected[c]) <= 2e-6);
        }
    }
}

}  // namespace nearlight::core
