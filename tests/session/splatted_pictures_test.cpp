// SPDX-License-Identifier: Apache-2.0
// Pictures whose samples count in all pixels that their filter reaches.
#include <gtest/gtest.h>

#include <cmath>

#include "host/session/splat_rows.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class SplattedPictures : public test::DeviceTest {};

/// A coated floor and a wall under a lamp and a sky: camera paths divide, bundles share light of the sky, and
/// the lamp's edges get more camera paths.
Scene open_corner(FilterKind filter) {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.6f, 0.5f, 0.4f}));
    const uint shiny = add_material(scene, coated(scene, {0.5f, 0.4f, 0.3f}, {.alpha = 0.2}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, shiny);
    add_quad(scene, {-2, -1, 1}, {0, 1.2f, 0}, {4, 0, 0}, grey);
    add_quad(scene, {-0.3f, 0.1f, 0.5f}, {0, 0.6f, 0}, {0.6f, 0, 0}, add_material(scene, lamp));
    scene.environment = {.width = 1, .height = 1, .radiance = {{0.3f, 0.4f, 0.5f}}, .to_world = {}};
    set_camera(scene, {0.1, 0.4, -1.9}, {0, -0.2, 1}, 70);
    scene.camera.width = 40;
    scene.camera.height = 24;
    scene.camera.filter = default_filter(filter);
    return scene;
}

RenderSettings splatted(bool splat, uint seed = 1) {
    return {.sampling = {.vpl_count = 100},
            .gather = {.samples_per_pixel = 16,
                       .direct_samples_per_pixel = 16,
                       .rays_per_pixel = 16,
                       .splat = splat},
            .seed = seed};
}

std::vector<Image> seeds(Session& session, bool splat, uint count) {
    return test::render_seeds(session, splatted(splat), 1, count);
}

/// Means and variances of the green channel of several pictures, pixel by pixel.
struct Moments {
    std::vector<double> mean, variance;
};

Moments moments_of(const std::vector<Image>& images) {
    const auto count = static_cast<double>(images.size());
    Moments moments;
    for (std::size_t at = 1; at < images.front().values.size(); at += NEARLIGHT_LAYER_CHANNELS) {
        double sum = 0.0;
        double squares = 0.0;
        for (const Image& image : images) {
            sum += double{image.values[at]};
            squares += double{image.values[at]} * double{image.values[at]};
        }
        moments.mean.push_back(sum / count);
        moments.variance.push_back((squares - sum * sum / count) / (count - 1.0));
    }
    return moments;
}

double sum_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) {
        sum += value;
    }
    return sum;
}

/// Pixel by pixel, both ways have the same mean, at the picture's edges too, and splats have the smaller
/// noise.
TEST_F(SplattedPictures, MeansStayAndNoiseFalls) {
    for (const bool has_border : {false, true}) {
        Scene scene = open_corner(has_border ? FilterKind::tent : FilterKind::gaussian);
        scene.camera.sample_border = has_border;
        on_each_device([&](Device& device) {
            constexpr uint kCount = 24;
            Session session(device, scene);
            const Moments on = moments_of(seeds(session, true, kCount));
            const Moments off = moments_of(seeds(session, false, kCount));
            EXPECT_LT(sum_of(on.variance), (has_border ? 0.7 : 0.6) * sum_of(off.variance));
            double chi2 = 0.0;
            for (std::size_t i = 0; i < on.mean.size(); ++i) {
                const double error = (on.variance[i] + off.variance[i]) / kCount;
                chi2 += std::pow(on.mean[i] - off.mean[i], 2.0) / (error + 1e-6);
            }
            EXPECT_LT(chi2 / static_cast<double>(on.mean.size()), 1.3) << "border: " << has_border;
            EXPECT_NEAR(sum_of(on.mean) / sum_of(off.mean), 1.0, 0.004) << "border: " << has_border;
        });
    }
}

/// What the layer `variance` says of pictures ÷ the variance that they have.
double said_of_variance(const std::vector<Image>& images) {
    double said = 0.0;
    for (const Image& image : images) {
        for (std::size_t i = 0; i < image.values.size(); i += NEARLIGHT_LAYER_CHANNELS) {
            said += double{image.values[i + NEARLIGHT_LAYER_VARIANCE + 1]};
        }
    }
    return said / static_cast<double>(images.size()) / sum_of(moments_of(images).variance);
}

/// The layer `variance` is as right with splats as without them.
TEST_F(SplattedPictures, TheVarianceIsThatOfManyPictures) {
    const Scene scene = open_corner(FilterKind::gaussian);
    on_each_device([&](Device& device) {
        Session session(device, scene);
        const double on = said_of_variance(seeds(session, true, 24));
        const double off = said_of_variance(seeds(session, false, 24));
        EXPECT_NEAR(on / off, 1.0, 0.35) << on << " and " << off;
    });
}

TEST_F(SplattedPictures, BandsAndBatchesDoNotChangeABit) {
    Scene scene = open_corner(FilterKind::gaussian);
    scene.camera.width = 100;
    scene.camera.height = 60;
    on_each_device([&](Device& device) {
        const std::uint64_t whole = test::render_image(device, scene, splatted(true)).report.image_hash;
        for (const std::size_t largest : {std::size_t{1} << 22u, std::size_t{5} << 19u}) {
            DeviceEntry entry = device.entry();
            entry.max_allocation_bytes = largest;  // the receivers do not fit: the picture is cut
            Device small(entry, device.options());
            EXPECT_EQ(test::render_image(small, scene, splatted(true)).report.image_hash, whole) << largest;
        }
    });
}

TEST_F(SplattedPictures, APartHasTheBitsOfTheWholePicture) {
    const Scene scene = open_corner(FilterKind::gaussian);
    on_each_device([&](Device& device) {
        Session session(device, scene);
        RenderSettings settings = splatted(true);
        const Image whole = test::render_image(session, settings).image;
        for (const PixelWindow& window :
             {PixelWindow{0, 0, 1, 1}, {39, 23, 1, 1}, {7, 5, 20, 11}, {16, 16, 16, 8}}) {
            settings.gather.window = window;
            const Image part = test::render_image(session, settings).image;
            ASSERT_EQ(part.width, static_cast<int>(window.width));
            ASSERT_EQ(part.height, static_cast<int>(window.height));
            for (int y = 0; y < part.height; ++y) {
                for (int x = 0; x < part.width; ++x) {
                    for (std::size_t c = 0; c < part.channel_count(); ++c) {
                        ASSERT_EQ(part.at(x, y, c),
                                  whole.at(x + static_cast<int>(window.x), y + static_cast<int>(window.y), c))
                            << x << ' ' << y << ' ' << c;
                    }
                }
            }
        }
    });
}

TEST_F(SplattedPictures, FewSamplesCountInTheirOwnPixel) {
    const Scene scene = open_corner(FilterKind::tent);
    on_each_device([&](Device& device) {
        Session session(device, scene);
        const auto hash = [&](bool splat, uint samples) {
            RenderSettings settings = splatted(splat);
            settings.gather.samples_per_pixel = samples;
            return test::render_image(session, settings).report.image_hash;
        };
        EXPECT_EQ(hash(true, kMinSplattedSamples - 1), hash(false, kMinSplattedSamples - 1));
        EXPECT_NE(hash(true, kMinSplattedSamples), hash(false, kMinSplattedSamples));
    });
}

}  // namespace
}  // namespace nearlight::core
