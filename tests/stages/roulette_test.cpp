// SPDX-License-Identifier: Apache-2.0
#include "host/stages/roulette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "host/reference/roulette_oracle.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/spread.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

constexpr float kThreshold = 2.0f;
constexpr uint kSeeds = 200;
/// Number of standard errors that chance does not reach in hundreds of comparisons (two-sided 1e-6 each).
constexpr double kMaxErrors = 4.9;

GatherCase room() {
    return room_of_boxes(40, 300, 6, 21);
}

/// Irradiance of each packet, summed over receivers and channels.
std::vector<double> packet_sums(const std::vector<IrradiancePacket>& irradiance) {
    std::vector<double> sums;
    for (const IrradiancePacket& packet : irradiance) {
        sums.push_back(std::accumulate(packet.r, packet.r + 3 * NEARLIGHT_PACKET_SIZE, 0.0));
    }
    return sums;
}

/// Maximum over all packets of the distance, in standard errors, between the mean over repeats and the
/// expectation.
double max_errors(const std::vector<std::vector<double>>& runs, const std::vector<double>& expected) {
    double most = 0.0;
    for (std::size_t packet = 0; packet < expected.size(); ++packet) {
        std::vector<double> values;
        for (const std::vector<double>& run : runs) {
            values.push_back(run[packet]);
        }
        const Spread spread = spread_of(values);
        // Sums of floats in another order also differ by rounding.
        const double rounding = 1e-6 * expected[packet];
        most = std::max(most, std::abs(spread.mean - expected[packet]) / std::max(spread.error, rounding));
    }
    return most;
}

/// The contents of the lists for each pair of bundle and VPL, over all seeds.
struct Choices {
    std::vector<int> chosen;     ///< how often the pair was chosen
    std::vector<float> weights;  ///< weight when it was chosen; 0: never
};

class RouletteTest : public DeviceTest {
  protected:
    static Choices choose_often(Device& device, const GatherCase& data, const BundleLayout& layout) {
        const Buffer<Vpl> vpls(device, data.vpls);
        const Buffer<ReceiverPacket> receivers(device, data.receivers);
        const std::size_t pairs = data.vpls.size() * layout.bundle_count();
        Choices result{std::vector<int>(pairs), std::vector<float>(pairs)};
        Roulette roulette(device);
        for (uint seed = 0; seed < kSeeds; ++seed) {
            const VplSelection selection = roulette.select({.vpls = vpls,
                                                            .vpl_count = data.vpls.size(),
                                                            .receivers = receivers,
                                                            .packet_count = data.receivers.size(),
                                                            .clamp_radius = data.clamp_radius,
                                                            .threshold = kThreshold,
                                                            .seed = seed});
            const VplLists& lists = selection.lists(0, layout.bundle_count());
            const std::vector<uint> chosen = lists.vpls.download();
            const std::vector<float> weights = lists.weights.download();
            const std::vector<uint> counts = lists.lengths.download();
            for (std::size_t bundle = 0; bundle < layout.bundle_count(); ++bundle) {
                const std::size_t first = bundle * data.vpls.size();
                for (std::size_t k = first; k < first + counts[bundle]; ++k) {
                    EXPECT_TRUE(k == first || chosen[k] > chosen[k - 1]);
                    ++result.chosen[first + chosen[k]];
                    result.weights[first + chosen[k]] = weights[k];
                }
            }
        }
        return result;
    }
};

TEST_F(RouletteTest, ChoosesInProportionToTheBound) {
    const GatherCase data = room_of_boxes(40, 300, 31, 21);
    const BundleLayout layout{31};  // the last bundle has 3 packets
    ASSERT_EQ(layout.bundle_count(), 8u);
    on_each_device([&](Device& device) {
        const Choices choices = choose_often(device, data, layout);
        std::size_t certain = 0;
        std::size_t by_chance = 0;
        for (uint bundle = 0; bundle < layout.bundle_count(); ++bundle) {
            const std::vector<double> probabilities = roulette_probabilities(
                data.vpls, data.receivers, layout.bundle(bundle), data.clamp_radius, kThreshold);
            for (std::size_t vpl = 0; vpl < probabilities.size(); ++vpl) {
                const double p = probabilities[vpl];
                const int count = choices.chosen[bundle * probabilities.size() + vpl];
                if (p == 0.0 || p == 1.0) {
                    EXPECT_EQ(count, p == 0.0 ? 0 : static_cast<int>(kSeeds))
                        << "bundle " << bundle << " VPL " << vpl;
                    certain += p == 1.0 ? 1 : 0;
                    continue;
                }
                ++by_chance;
                EXPECT_LE(std::abs(count - p * kSeeds), kMaxErrors * std::sqrt(kSeeds * p * (1.0 - p)) + 2.0)
                    << "bundle " << bundle << " VPL " << vpl << ", probability " << p;
                if (count > 0) {
                    EXPECT_NEAR(choices.weights[bundle * probabilities.size() + vpl] * p, 1.0, 1e-3);
                }
            }
        }
        EXPECT_GT(certain, 100u);
        EXPECT_GT(by_chance, 300u);
    });
}

TEST_F(RouletteTest, MeanOverSeedsIsTheFullGather) {
    const GatherCase data = room();
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            SCOPED_TRACE(kernel == GatherKernel::packets ? "packets" : "rays");
            Gatherer gatherer(device, {.kernel = kernel});
            Uploaded uploaded(device, data);
            const std::vector<double> full = packet_sums(uploaded.gather(gatherer));
            std::vector<std::vector<double>> runs;
            std::vector<std::vector<double>> wrong;
            for (uint seed = 0; seed < kSeeds; ++seed) {
                runs.push_back(packet_sums(uploaded.gather(gatherer, kThreshold, seed)));
                wrong.push_back(runs.back());
                for (double& sum : wrong.back()) {
                    sum *= 0.99;
                }
            }
            EXPECT_LT(max_errors(runs, full), kMaxErrors);
            EXPECT_NE(runs[0], runs[1]);
            // The error is so small that the test would notice weights wrong by one percent.
            EXPECT_GT(max_errors(wrong, full), kMaxErrors);
        }
    });
}

TEST_F(RouletteTest, LowThresholdResolvesAll) {
    const GatherCase data = room();
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        Uploaded uploaded(device, data);
        const std::vector<double> full = packet_sums(uploaded.gather(gatherer));
        const std::vector<double> almost = packet_sums(uploaded.gather(gatherer, 1e-12f, 0));
        for (std::size_t packet = 0; packet < full.size(); ++packet) {
            EXPECT_NEAR(almost[packet], full[packet], 1e-5 * full[packet]);
        }
    });
}

TEST_F(RouletteTest, SameBitsForAnyDivision) {
    const GatherCase data = room_of_boxes(40, 700, 6, 22);
    on_each_device([&](Device& device) {
        test::expect_same_bits_for_any_division(
            device, data, [&](const GatherCase& some, Gatherer& gatherer) {
                return Uploaded(device, some).gather(gatherer, kThreshold, 5);
            });
    });
}

TEST_F(RouletteTest, BeamWidthDoesNotChangeABit) {
    const GatherCase data = room_of_boxes(40, 300, 7, 24);
    on_each_device([&](Device& device) {
        Gatherer wide(device, {.kernel = GatherKernel::packets});
        const auto expected = Uploaded(device, data).gather(wide, kThreshold, 3);
        for (const uint width : {16u, 64u}) {
            Gatherer gatherer(device, {.kernel = GatherKernel::packets, .beam_width = width});
            EXPECT_TRUE(same_bits(Uploaded(device, data).gather(gatherer, kThreshold, 3), expected));
        }
    });
}

TEST_F(RouletteTest, RecordsOnlyWhatWasTraced) {
    const GatherCase data = room();
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        Uploaded uploaded(device, data);
        GatherInput<Vpl> input = uploaded.input();
        const std::vector<GatherPair> full = gatherer.gather_recorded(input, uploaded.sums());
        const VplSelection selection = uploaded.select(kThreshold, 0);
        input.selection = &selection;
        const std::vector<GatherPair> some = gatherer.gather_recorded(input, uploaded.sums());
        const std::vector<IrradiancePacket> recorded = uploaded.sums().light.download();
        std::size_t passed_over = 0;
        for (std::size_t i = 0; i < full.size(); ++i) {
            passed_over += full[i] != some[i] ? 1 : 0;
            ASSERT_TRUE(full[i] == some[i] || some[i] == GatherPair::culled) << "pair " << i;
        }
        EXPECT_GT(passed_over, full.size() / 10);
        EXPECT_TRUE(same_bits(recorded, uploaded.gather(gatherer, kThreshold, 0)));
    });
}

TEST_F(RouletteTest, NothingToChooseFrom) {
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        GatherCase none = room();
        none.vpls.clear();
        for (const IrradiancePacket& packet : Uploaded(device, none).gather(gatherer, kThreshold, 0)) {
            EXPECT_EQ(packet.g[0], 0.0f);
        }
        GatherCase dark = room();
        for (Vpl& vpl : dark.vpls) {
            vpl.power = {0, 0, 0};
        }
        for (const IrradiancePacket& packet : Uploaded(device, dark).gather(gatherer, kThreshold, 0)) {
            EXPECT_EQ(packet.g[0], 0.0f);
        }
    });
}

}  // namespace
}  // namespace nearlight::core::test
