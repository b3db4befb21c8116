// SPDX-License-Identifier: Apache-2.0
// Tests the check of convergence.h itself: it accepts pictures that are right, and refuses each kind of
// mistake.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "host/base/random.h"
#include "host/scene/scene_loader.h"
#include "tests/session/convergence.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using test::judge_convergence;
using test::Verdict;

constexpr int kSize = 16;
constexpr int kRenders = 24;

Image picture(const std::string& layer) {
    return make_image(kSize, kSize, {layer + ".R", layer + ".G", layer + ".B"});
}

/// A picture whose pixels follow an exponential distribution of mean 1; a third of the variance is common to
/// all pixels, as if they shared VPLs.
Image noisy_picture(Pcg32& random) {
    const auto exponential = [&] { return -std::log(1.0f - random.uniform()); };
    Image image = picture("indirect");
    const float common = exponential();
    for (float& value : image.values) {
        value = 0.577f * common + 0.816f * exponential() - 0.393f;
    }
    return image;
}

/// The picture and the variance that trace_paths() would have after 16 batches.
Image noisy_truth(Pcg32& random) {
    constexpr int kBatches = 16;
    Image truth = make_image(kSize, kSize,
                             {"indirect.R", "indirect.G", "indirect.B", "indirectVariance.R",
                              "indirectVariance.G", "indirectVariance.B", "count.X"});
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                double sum = 0;
                double squares = 0;
                for (int batch = 0; batch < kBatches; ++batch) {
                    const double value = -0.3 * std::log(1.0 - random.uniform()) + 0.7;
                    sum += value;
                    squares += value * value;
                }
                truth.at(x, y, channel) = static_cast<float>(sum / kBatches);
                truth.at(x, y, channel + 3) =
                    static_cast<float>((squares - sum * sum / kBatches) / (kBatches * (kBatches - 1)));
            }
            truth.at(x, y, 6) = kBatches;  // number of batches, of one sample each
        }
    }
    return truth;
}

TEST(ConvergenceCheck, RaisesHardlyAFalseAlarm) {
    Pcg32 random(1);
    int alarms = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const Image truth = noisy_truth(random);
        std::vector<Image> renders;
        for (int i = 0; i < kRenders; ++i) {
            renders.push_back(noisy_picture(random));
        }
        alarms += judge_convergence(renders, truth, "indirect").agrees ? 0 : 1;
    }
    EXPECT_LE(alarms, 1);  // 0.03 are expected with normal noise, but this noise is skewed
}

using Mistake = std::function<void(Image&)>;

/// Compares pictures of the Cornell box, each with a mistake, with the mean of others that have twenty times
/// as many VPLs and counts as exact.
class ConvergenceMistakes : public test::DeviceTest {
  protected:
    [[nodiscard]] static Image truth_of(const std::vector<Image>& renders) {
        const Image& first = renders.front();
        Image truth = make_image(first.width, first.height,
                                 {"indirect.R", "indirect.G", "indirect.B", "indirectVariance.R",
                                  "indirectVariance.G", "indirectVariance.B", "count.X"});
        const auto n = static_cast<float>(renders.size());
        for (int y = 0; y < first.height; ++y) {
            for (int x = 0; x < first.width; ++x) {
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    const auto source = static_cast<std::size_t>(first.find_channel(truth.channels[channel]));
                    float sum = 0;
                    for (const Image& image : renders) {
                        sum += image.at(x, y, source);
                    }
                    truth.at(x, y, channel) = sum / n;
                }
                truth.at(x, y, 6) = 64;
            }
        }
        return truth;
    }
};

TEST_F(ConvergenceMistakes, AreFound) {
    const Scene scene =
        load_scene(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "scenes/cornell-box/scene.xml");
    const RenderSettings settings{
        .view = {.width = kSize, .height = kSize, .clamp_radius = 0.1f, .max_depth = 5},
        .sampling = {.sampler = SamplerKind::instant_radiosity, .vpl_count = 1000},
        .gather = {.samples_per_pixel = 1, .compensate = false, .indirect_only = true}};
    const auto multiply = [](float factor, const std::function<bool(int x, int y)>& where) -> Mistake {
        return [=](Image& image) {
            for (const char* name : {"indirect.R", "indirect.G", "indirect.B"}) {
                const auto channel = static_cast<std::size_t>(image.find_channel(name));
                for (int y = 0; y < image.height; ++y) {
                    for (int x = 0; x < image.width; ++x) {
                        image.at(x, y, channel) *= where(x, y) ? factor : 1.0f;
                    }
                }
            }
        };
    };
    on_each_device([&](Device& device) {
        Session session(device, scene);
        const std::vector<Image> right = test::render_seeds(session, settings, 0, kRenders);
        RenderSettings fine = settings;
        fine.sampling.vpl_count = 40'000;
        const Image truth = truth_of(test::render_seeds(session, fine, 500, 12));
        const auto judge = [&](const Mistake& mistake) {
            std::vector<Image> renders = right;
            for (Image& image : renders) {
                mistake(image);
            }
            return judge_convergence(renders, truth, "indirect");
        };
        const Verdict none = judge([](Image&) {});
        EXPECT_TRUE(none.agrees) << none.reason;
        EXPECT_FALSE(judge(multiply(1.05f, [](int, int) { return true; })).agrees) << "too bright as a whole";
        EXPECT_FALSE(judge(multiply(0.95f, [](int, int) { return true; })).agrees) << "too dark as a whole";
        EXPECT_FALSE(judge(multiply(0.85f, [](int x, int y) { return x < 4 && y < 4; })).agrees)
            << "a dark corner";
        EXPECT_FALSE(judge(multiply(0.5f, [](int x, int y) { return x == 9 && y == 12; })).agrees)
            << "a pixel";
        const float nan = std::numeric_limits<float>::quiet_NaN();
        EXPECT_FALSE(judge(multiply(nan, [](int x, int y) { return x == 0 && y == 0; })).agrees)
            << "not a number";
        EXPECT_FALSE(judge(multiply(1.06f, [](int x, int y) { return (x + y) % 2 == 0; })).agrees)
            << "every other pixel";
    });
}

}  // namespace
}  // namespace nearlight::core
