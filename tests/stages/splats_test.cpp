// SPDX-License-Identifier: Apache-2.0
#include "host/stages/splats.h"

#include <cmath>
#include <cstring>

#include "host/reference/splat_oracle.h"
#include "host/scene/camera.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

const FilmLayout kSplatLayout{.samples = 4};

class SplatsTest : public test::DeviceTest {};

Camera camera_with(FilterKind kind) {
    SceneCamera camera;
    camera.filter = default_filter(kind);
    Camera result =
        make_camera(camera, static_cast<int>(kSplatLayout.width), static_cast<int>(kSplatLayout.height));
    result.splat_reach = kind == FilterKind::tent ? 1 : 2;
    return result;
}

CameraBatch batch_of(uint first, uint count) {
    return {.tile_row_count = static_cast<uint>(kSplatLayout.tile_rows()),
            .first_sample = first,
            .sample_count = count,
            .samples_per_pixel = kSplatLayout.samples,
            .branch_count = kSplatLayout.branches};
}

/// The row splats that the samples come to in the given batches. With `apart`, the light of camera paths goes
/// into splats of its own.
std::vector<RowSplat> splat(Device& device, const FilmSamples& samples, FilterKind filter,
                            const std::vector<uint>& batches, bool apart) {
    const Camera camera = camera_with(filter);
    const Buffer<Camera> cameras(device, std::span(&camera, 1));
    const uint reach = camera.splat_reach;
    const std::size_t pixels = std::size_t{kSplatLayout.width} * kSplatLayout.height;
    const SplatPixels size{kSplatLayout.width, kSplatLayout.height, kSplatLayout.samples / 2};
    Buffer<Splat> splats(device, pixels * splats_per_pixel(reach));
    Buffer<CameraSplat> camera_splats(device, pixels * splats_per_pixel(reach));
    splats.fill_zero();
    camera_splats.fill_zero();
    Splats stage(device);
    uint first = 0;
    for (const uint count : batches) {
        const FilmSamples some = batch_of_samples(samples, kSplatLayout, first, count);
        const Buffer<CameraVertex> vertices(device, some.vertices);
        const Buffer<IrradiancePacket> direct(device, some.direct);
        const Buffer<IrradiancePacket> gathered(device, some.gathered);
        const Buffer<IrradiancePacket> indirect(device, some.indirect);
        stage.add(vertices, {.direct = direct, .gathered = gathered, .indirect = indirect}, cameras,
                  batch_of(first, count), size, !apart, splats);
        if (apart) {
            stage.add_camera_light(vertices, cameras, batch_of(first, count), size, camera_splats);
        }
        device.finish();
        first += count;
    }
    Buffer<RowSplat> rows(device, pixels * splat_rows(reach));
    stage.gather(splats, apart ? &camera_splats : nullptr, size, reach, rows);
    return rows.download();
}

TEST_F(SplatsTest, PixelsAreTheMeanOfAllSamplesThatTheirFilterReaches) {
    const FilmSamples samples = random_splat_samples(kSplatLayout);
    on_each_device([&](Device& device) {
        for (const FilterKind filter : {FilterKind::tent, FilterKind::gaussian, FilterKind::mitchell}) {
            SCOPED_TRACE(to_string(filter));
            const Camera camera = camera_with(filter);
            const std::vector<RowSplat> rows = splat(device, samples, filter, {4}, false);
            for (uint y = 0; y < kSplatLayout.height; ++y) {
                for (uint x = 0; x < kSplatLayout.width; ++x) {
                    const SplattedLight expected =
                        expected_splatted_light(samples, kSplatLayout, camera, x, y);
                    const SplattedLight found = light_of_splats(rows, kSplatLayout, camera.splat_reach, x, y);
                    for (std::size_t c = 0; c < 3; ++c) {
                        ASSERT_NEAR(found.direct[c], expected.direct[c], 2e-5) << x << ' ' << y;
                        ASSERT_NEAR(found.indirect[c], expected.indirect[c], 2e-5) << x << ' ' << y;
                        ASSERT_NEAR(found.half[c], expected.half[c], 2e-5) << x << ' ' << y;
                    }
                    ASSERT_NEAR(found.coverage, expected.coverage, 1e-5) << x << ' ' << y;
                }
            }
        }
    });
}

TEST_F(SplatsTest, BatchesDoNotChangeABit) {
    const FilmSamples samples = random_splat_samples(kSplatLayout);
    on_each_device([&](Device& device) {
        for (const bool apart : {false, true}) {
            const std::vector<RowSplat> whole = splat(device, samples, FilterKind::gaussian, {4}, apart);
            const std::vector<RowSplat> parts =
                splat(device, samples, FilterKind::gaussian, {1, 2, 1}, apart);
            ASSERT_EQ(whole.size(), parts.size());
            EXPECT_EQ(std::memcmp(whole.data(), parts.data(), whole.size() * sizeof(RowSplat)), 0) << apart;
        }
    });
}

TEST_F(SplatsTest, CameraLightApartAddsUpToTheSameLight) {
    const FilmSamples samples = random_splat_samples(kSplatLayout);
    on_each_device([&](Device& device) {
        const std::vector<RowSplat> together = splat(device, samples, FilterKind::tent, {4}, false);
        const std::vector<RowSplat> apart = splat(device, samples, FilterKind::tent, {1, 3}, true);
        for (uint y = 0; y < kSplatLayout.height; ++y) {
            for (uint x = 0; x < kSplatLayout.width; ++x) {
                const SplattedLight a = light_of_splats(together, kSplatLayout, 1, x, y);
                const SplattedLight b = light_of_splats(apart, kSplatLayout, 1, x, y);
                for (std::size_t c = 0; c < 3; ++c) {
                    ASSERT_NEAR(a.direct[c], b.direct[c], 2e-5) << x << ' ' << y;
                    ASSERT_EQ(a.indirect[c], b.indirect[c]) << x << ' ' << y;
                }
            }
        }
        // The halves end where they should: two samples each.
        const RowSplat& row = apart[(5 * kSplatLayout.width + 6) * 3 + 1];
        EXPECT_NEAR(row.camera.first_weight, row.all.half_weight, 1e-5);
        EXPECT_NEAR(row.camera.second_weight, row.all.weight - row.all.half_weight, 1e-5);
    });
}

/// Further camera paths count as much as all before them, whatever their number.
TEST_F(SplatsTest, FurtherCameraPathsAreAveragedWithThoseBefore) {
    on_each_device([](Device& device) {
        const std::size_t each = splats_per_pixel(1);
        const auto value = [](float v) { return CameraSplat{{v, v, v}, v, {2 * v, 0, v}, 3 * v}; };
        Buffer<CameraSplat> splats(device, std::vector<CameraSplat>(4 * each, value(1)));
        std::vector<CameraSplat> more(2 * each, value(8));
        more[each + 4] = value(16);
        const Buffer<CameraSplat> added(device, more);
        const Buffer<uint> listed(device, std::vector<uint>{0, 3, 1});
        Splats(device).refine(listed, 1, 2, 1, added, 0.25f, splats);
        const std::vector<CameraSplat> found = splats.download();
        for (const std::size_t pixel : {0u, 2u}) {
            EXPECT_EQ(found[pixel * each].first.x, 1.0f) << "pixel " << pixel << " is not listed there";
        }
        const CameraSplat& of_third = found[3 * each];
        EXPECT_EQ(of_third.first.y, 1.5f);
        EXPECT_EQ(of_third.first_weight, 1.5f);
        EXPECT_EQ(of_third.second.x, 3.0f);
        EXPECT_EQ(of_third.second_weight, 4.5f);
        EXPECT_EQ(found[1 * each + 4].first.z, 2.5f);
        EXPECT_EQ(found[1 * each + 5].first.z, 1.5f);
    });
}

}  // namespace
}  // namespace nearlight::core
