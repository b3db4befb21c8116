// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>
#include <vector>

#include "host/reference/camera_lights_oracle.h"
#include "host/reference/film_oracle.h"
#include "host/reference/splat_oracle.h"
#include "host/scene/camera.h"
#include "host/selftest/checks.h"
#include "host/stages/camera_lights.h"
#include "host/stages/film.h"
#include "host/stages/splats.h"

namespace nearlight::core {

namespace {

/// All samples of a layout in one batch.
CameraBatch whole_batch(const FilmLayout& layout) {
    return {.tile_row_count = static_cast<uint>(layout.tile_rows()),
            .sample_count = layout.samples,
            .samples_per_pixel = layout.samples,
            .branch_count = layout.branches};
}

bool are_close(Vec3 a, Vec3 b, double tolerance) {
    return std::abs(a.x - b.x) <= tolerance && std::abs(a.y - b.y) <= tolerance &&
           std::abs(a.z - b.z) <= tolerance;
}

}  // namespace

void check_film(Device& device, CheckResult& result) {
    const FilmLayout layout{.width = 53, .height = 37};
    const FilmSamples samples = random_film_samples(layout);
    const CameraBatch batch = whole_batch(layout);
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
    film.add(receivers, vertices, {.direct = direct, .gathered = gathered, .indirect = indirect}, batch,
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

void check_camera_lights(Device& device, CheckResult& result) {
    const FilmLayout layout{.width = 53, .height = 37, .samples = 5};
    const FilmSamples samples = random_film_samples(layout);
    const CameraBatch batch = whole_batch(layout);
    const std::size_t pixels = std::size_t{layout.width} * layout.height;
    const uint half = layout.samples / 2;
    const Buffer<CameraVertex> vertices(device, samples.vertices);
    const std::vector<float> light(pixels * NEARLIGHT_FILM_CHANNELS, 1.0f);
    Buffer<float> sums(device, light);
    Buffer<CameraLight> lights(device, pixels);
    Buffer<uint> rounds(device, pixels);
    lights.fill_zero();
    CameraLights stage(device);
    stage.add(vertices, batch, layout.width, layout.height, half, lights);
    const std::vector<CameraLight> found = lights.download();
    stage.choose(lights, sums, {layout.width, layout.height, layout.samples}, rounds);
    const std::vector<uint> chosen = rounds.download();
    for (uint pixel = 0; pixel < pixels; ++pixel) {
        const uint x = pixel % layout.width;
        const uint y = pixel / layout.width;
        const CameraLight expected = expected_camera_light(samples, layout, half, x, y);
        result.expect(are_close(found[pixel].first, expected.first, 2e-5));
        result.expect(are_close(found[pixel].second, expected.second, 2e-5));
        result.expect(chosen[pixel] == expected_rounds(found, light, layout.width, layout.samples, x, y));
    }
    std::vector<uint> all(pixels);
    std::iota(all.begin(), all.end(), 0u);
    const Buffer<uint> listed(device, all);
    const Buffer<CameraLight> added(device, std::vector<CameraLight>(pixels, {{1, 1, 1}, {2, 2, 2}}));
    stage.refine(listed, 0, pixels, added, 0.5f, lights, sums, rounds);
    const std::vector<float> refined = sums.download();
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        // The light of 1 had all of the camera's light in it, which is now half of it and half of what was
        // added.
        const double before = double{found[pixel].first.x} + double{found[pixel].second.x};
        result.expect(std::abs(refined[pixel * NEARLIGHT_FILM_CHANNELS + NEARLIGHT_SUM_DIRECT] -
                               (1.0 + 0.5 * (3.0 - before))) <= 2e-5);
    }
}

void check_splats(Device& device, CheckResult& result) {
    const FilmLayout layout{.width = 29, .height = 21, .samples = 4};
    const FilmSamples samples = random_splat_samples(layout);
    SceneCamera scene_camera;
    scene_camera.filter = default_filter(FilterKind::tent);
    Camera camera =
        make_camera(scene_camera, static_cast<int>(layout.width), static_cast<int>(layout.height));
    camera.splat_reach = 1;
    const std::size_t pixels = std::size_t{layout.width} * layout.height;
    const SplatPixels size{layout.width, layout.height, layout.samples / 2};
    const CameraBatch batch = whole_batch(layout);
    const Buffer<Camera> cameras(device, std::span(&camera, 1));
    const Buffer<CameraVertex> vertices(device, samples.vertices);
    const Buffer<IrradiancePacket> direct(device, samples.direct);
    const Buffer<IrradiancePacket> gathered(device, samples.gathered);
    const Buffer<IrradiancePacket> indirect(device, samples.indirect);
    Buffer<Splat> splats(device, pixels * splats_per_pixel(1));
    Buffer<CameraSplat> camera_splats(device, pixels * splats_per_pixel(1));
    Buffer<RowSplat> rows(device, pixels * splat_rows(1));
    splats.fill_zero();
    camera_splats.fill_zero();
    Splats stage(device);
    stage.add(vertices, {.direct = direct, .gathered = gathered, .indirect = indirect}, cameras, batch, size,
              false, splats);
    stage.add_camera_light(vertices, cameras, batch, size, camera_splats);
    std::vector<uint> all(pixels);
    std::iota(all.begin(), all.end(), 0u);
    // The mean of nothing and of twice the camera light is that light.
    const Buffer<CameraSplat> more(device, camera_splats.download());
    camera_splats.fill_zero();
    stage.refine(Buffer<uint>(device, all), 0, pixels, 1, more, 2.0f, camera_splats);
    stage.gather(splats, &camera_splats, size, 1, rows);
    const std::vector<RowSplat> found = rows.download();
    for (uint y = 0; y < layout.height; ++y) {
        for (uint x = 0; x < layout.width; ++x) {
            const SplattedLight expected = expected_splatted_light(samples, layout, camera, x, y);
            const SplattedLight light = light_of_splats(found, layout, 1, x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                const double scale = 1.0 + std::abs(expected.direct[c]) + std::abs(expected.indirect[c]);
                result.expect(std::abs(light.direct[c] - expected.direct[c]) <= 1e-4 * scale);
                result.expect(std::abs(light.indirect[c] - expected.indirect[c]) <= 1e-4 * scale);
            }
            result.expect(std::abs(light.coverage - expected.coverage) <= 1e-4);
        }
    }
}

}  // namespace nearlight::core
