// SPDX-License-Identifier: Apache-2.0
// Pixels at edges of lamps and in highlights get more camera paths, which must lower their noise and nothing
// else.
#include "host/session/camera_refinement.h"

#include <cmath>
#include <utility>

#include "host/scene/camera.h"
#include "host/stages/close_range.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// A lamp before the camera over a floor of rough plastic that reflects it, and a mirror beside it.
Scene lamp_over_gloss() {
    Scene scene;
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{8, 7, 6});
    add_quad(scene, {-2, -1, -2}, {0, 0, 6}, {4, 0, 0},
             add_material(scene, coated(scene, {0.5f, 0.4f, 0.3f}, {.alpha = 0.1})));
    add_quad(scene, {-0.7f, -0.3f, 2.5f}, {0.2f, 0.9f, 0}, {0.9f, -0.1f, 0}, add_material(scene, lamp));
    set_camera(scene, {0.1, 0.2, -1.9}, {0, -0.2, 1}, 60);
    scene.camera.width = 45;
    scene.camera.height = 30;
    return scene;
}

RenderSettings refined(bool refine, uint samples = 8) {
    return {.sampling = {.vpl_count = 16},
            .gather = {.samples_per_pixel = samples,
                       .direct_samples_per_pixel = 16,
                       .rays_per_pixel = 8,
                       .refine = refine}};
}

/// The moments of a channel of each pixel over pictures.
struct PixelMoments {
    std::vector<double> mean, variance;
};
PixelMoments moments_of(const std::vector<Image>& images, std::size_t channel) {
    const std::size_t pixels = images[0].values.size() / NEARLIGHT_LAYER_CHANNELS;
    const auto count = static_cast<double>(images.size());
    PixelMoments moments{std::vector<double>(pixels), std::vector<double>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) {
        double sum = 0, squares = 0;
        for (const Image& image : images) {
            const double value = image.values[i * NEARLIGHT_LAYER_CHANNELS + channel];
            sum += value;
            squares += value * value;
        }
        moments.mean[i] = sum / count;
        moments.variance[i] = (squares - sum * sum / count) / (count - 1);
    }
    return moments;
}

/// The pixels that have most of the noise.
std::vector<std::size_t> noisy_pixels(const PixelMoments& moments) {
    std::vector<std::size_t> pixels;
    for (std::size_t i = 0; i < moments.mean.size(); ++i) {
        if (moments.variance[i] > 0.02 * moments.mean[i] * moments.mean[i]) {
            pixels.push_back(i);
        }
    }
    return pixels;
}

class CameraRefinementTest : public test::DeviceTest {};

TEST_F(CameraRefinementTest, NoiseAtEdgesFallsAndTheMeanStays) {
    constexpr uint kSeeds = 48;
    on_each_device([](Device& device) {
        const Scene scene = lamp_over_gloss();
        Session session(device, scene);
        const std::vector<Image> images = test::render_seeds(session, refined(true), 1, kSeeds);
        const PixelMoments off = moments_of(test::render_seeds(session, refined(false), 1001, kSeeds), 0);
        const PixelMoments on = moments_of(images, 0);
        const PixelMoments estimated = moments_of(images, NEARLIGHT_LAYER_VARIANCE);
        const std::vector<std::size_t> noisy = noisy_pixels(off);
        ASSERT_GT(noisy.size(), 40u);
        ASSERT_LT(noisy.size(), off.mean.size() / 4);
        double difference = 0, uncertainty = 0, before = 0, after = 0, expected = 0;
        for (const std::size_t i : noisy) {
            difference += on.mean[i] - off.mean[i];
            uncertainty += (on.variance[i] + off.variance[i]) / kSeeds;
            const double relative = 1 / (off.mean[i] * off.mean[i] + 0.001);
            before += relative * off.variance[i];
            after += relative * on.variance[i];
            expected += relative * estimated.mean[i];
        }
        EXPECT_LT(after, 0.65 * before) << "over " << noisy.size() << " pixels";
        EXPECT_LT(std::abs(difference), 4 * std::sqrt(uncertainty));
        EXPECT_GT(expected, 0.6 * after) << "the layer of the variance";
        EXPECT_LT(expected, 1.8 * after) << "the layer of the variance";
    });
}

TEST_F(CameraRefinementTest, DirectLightAloneChanges) {
    on_each_device([](Device& device) {
        const Scene scene = lamp_over_gloss();
        Session session(device, scene);
        const Image on = test::render_image(session, refined(true)).image;
        const Image off = test::render_image(session, refined(false)).image;
        std::size_t changed = 0;
        for (std::size_t i = 0; i < on.values.size(); i += NEARLIGHT_LAYER_CHANNELS) {
            for (std::size_t c = NEARLIGHT_LAYER_INDIRECT; c < NEARLIGHT_LAYER_CHANNELS; ++c) {
                if (c < NEARLIGHT_LAYER_VARIANCE || c > NEARLIGHT_LAYER_VARIANCE_LAST) {
                    ASSERT_EQ(on.values[i + c], off.values[i + c]) << layer_channels()[c];
                }
            }
            changed += on.values[i] != off.values[i];
        }
        EXPECT_GT(changed, 40u);
        EXPECT_LT(changed, off.values.size() / NEARLIGHT_LAYER_CHANNELS / 2) << "most pixels are left alone";
    });
}

/// Rounds of many samples take longer than anyone waits after Ctrl-C.
TEST_F(CameraRefinementTest, RoundsAskWhetherToGoOn) {
    on_each_device([](Device& device) {
        const Scene scene = lamp_over_gloss();
        const test::SceneOnDevice on_device(device, scene);
        const Camera camera = make_camera(scene.camera, scene.camera.width, scene.camera.height);
        const CloseRange region = make_close_range(camera, 1.0f);
        const Buffer<Camera> cameras(device, std::span(&camera, 1));
        const Buffer<CloseRange> regions(device, std::span(&region, 1));
        const CameraBatch batch{.tile_row_count = tiles_across(camera.height),
                                .sample_count = 8,
                                .samples_per_pixel = 8,
                                .branch_count = 2};
        const std::size_t packets = packet_count(batch, camera.width);
        const std::size_t pixels = std::size_t{camera.width} * camera.height;
        Buffer<ReceiverPacket> receivers(device, packets);
        Buffer<CameraVertex> vertices(device, packets * NEARLIGHT_PACKET_SIZE);
        Buffer<float> sums(device, std::vector<float>(pixels * NEARLIGHT_FILM_CHANNELS, 1.0f));
        const CameraPassInput input{on_device.buffers, cameras, camera.width, regions, batch, 1};
        CameraPass camera_pass(device);
        RefinementStages stages(device);
        CameraRefinement refinement(
            device, stages, nullptr,
            {.max_pixels = pixels, .max_packets = packets, .sample_count = batch.sample_count});
        const auto finishes_after = [&](int max_launches) {
            int launches = 0;
            refinement.begin({0, 0, camera.width, camera.height});
            camera_pass.run(input, {receivers, vertices});
            refinement.add(batch, cameras, vertices);
            const bool finished = refinement.finish(camera_pass, input, {receivers, vertices}, sums,
                                                    [&] { return ++launches < max_launches; });
            return std::pair(finished, launches);
        };
        const auto [finished, all] = finishes_after(1000);
        EXPECT_TRUE(finished);
        ASSERT_GT(all, 1);
        for (int i = 1; i <= all; ++i) {
            EXPECT_EQ(finishes_after(i), std::pair(false, i)) << "of " << all;
        }
    });
}

TEST_F(CameraRefinementTest, FewSamplesAreNotRefined) {
    on_each_device([](Device& device) {
        const Scene scene = lamp_over_gloss();
        Session session(device, scene);
        const auto hash = [&](bool refine, uint samples) {
            return test::render_image(session, refined(refine, samples)).report.image_hash;
        };
        EXPECT_EQ(hash(true, kMinRefinedSamples - 1), hash(false, kMinRefinedSamples - 1));
        EXPECT_NE(hash(true, kMinRefinedSamples), hash(false, kMinRefinedSamples));
    });
}

/// Rounds of more packets than a batch holds are cut in samples and in pixels.
TEST_F(CameraRefinementTest, NoBitDependsOnTheMemoryOfTheDevice) {
    on_each_device([](Device& device) {
        for (const uint samples : {5u, 96u}) {
            const std::uint64_t whole =
                test::render_image(device, lamp_over_gloss(), refined(true, samples)).report.image_hash;
            DeviceEntry entry = device.entry();
            entry.max_allocation_bytes = std::size_t{1} << 19u;
            Device small(entry, device.options());
            EXPECT_EQ(test::render_image(small, lamp_over_gloss(), refined(true, samples)).report.image_hash,
                      whole)
                << samples;
        }
    });
}

}  // namespace
}  // namespace nearlight::core
