// SPDX-License-Identifier: Apache-2.0
#include "host/stages/roulette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "host/selftest/roulette_oracle.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/spread.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::test {
namespace {

constexpr float kThreshold = 2.0f;
constexpr uint kSeeds = 200;
/// Standard errors that chance does not reach in hundreds of comparisons (two-sided 1e-6 each).
constexpr double kMostErrors = 4.9;

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

/// Largest distance, in standard errors, of the mean over runs from what is expected, over all packets.
double most_errors(const std::vector<std::vector<double>>& runs, const std::vector<double>& expected) {
    double most = 0.0;
    for (std::size_t packet = 0; packet < expected.size(); ++packet) {
        std::vector<double> values;
        for (const std::vector<double>& run : runs) {
            values.push_back(run[packet]);
        }
        const Spread spread = spread_of(values);
        // Sums of floats in another order differ by rounding too.
        const double rounding = 1e-6 * expected[packet];
        most = std::max(most, std::abs(spread.mean - expected[packet]) / std::max(spread.error, rounding));
    }
    return most;
}

/// What the lists say about each pair of packet and VPL, over all seeds.
struct Choices {
    std::vector<int> chosen;     ///< how often
    std::vector<float> weights;  ///< when it was; 0: never
};

class RouletteTest : public DeviceTest {
  protected:
    static Choices choose_often(Device& device, const GatherCase& data, float threshold) {
        const Buffer<Vpl> vpls(device, data.vpls);
        const Buffer<ReceiverPacket> receivers(device, data.receivers);
        const std::size_t pairs = data.vpls.size() * data.receivers.size();
        Choices result{std::vector<int>(pairs), std::vector<float>(pairs)};
        Roulette roulette(device);
        for (uint seed = 0; seed < kSeeds; ++seed) {
            const RouletteLists& lists = roulette.choose({.vpls = vpls,
                                                          .vpl_count = data.vpls.size(),
                                                          .receivers = receivers,
                                                          .clamp_radius = data.clamp_radius,
                                                          .threshold = threshold,
                                                          .seed = seed},
                                                         0, data.receivers.size());
            const std::vector<uint> chosen = lists.vpls.download();
            const std::vector<float> weights = lists.weights.download();
            const std::vector<uint> counts = lists.counts.download();
            for (std::size_t packet = 0; packet < data.receivers.size(); ++packet) {
                const std::size_t first = packet * data.vpls.size();
                for (std::size_t k = first; k < first + counts[packet]; ++k) {
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
    const GatherCase data = room();
    on_each_device([&](Device& device) {
        const Choices choices = choose_often(device, data, kThreshold);
        std::size_t certain = 0;
        std::size_t by_chance = 0;
        for (std::size_t packet = 0; packet < data.receivers.size(); ++packet) {
            const std::vector<double> probabilities =
                roulette_probabilities(data.vpls, data.receivers[packet], data.clamp_radius, kThreshold);
            for (std::size_t vpl = 0; vpl < probabilities.size(); ++vpl) {
                const double p = probabilities[vpl];
                const int count = choices.chosen[packet * probabilities.size() + vpl];
                if (p == 0.0 || p == 1.0) {
                    EXPECT_EQ(count, p == 0.0 ? 0 : static_cast<int>(kSeeds))
                        << "packet " << packet << " VPL " << vpl;
                    certain += p == 1.0 ? 1 : 0;
                    continue;
                }
                ++by_chance;
                EXPECT_LE(std::abs(count - p * kSeeds), kMostErrors * std::sqrt(kSeeds * p * (1.0 - p)) + 2.0)
                    << "packet " << packet << " VPL " << vpl << ", probability " << p;
                if (count > 0) {
                    EXPECT_NEAR(choices.weights[packet * probabilities.size() + vpl] * p, 1.0, 1e-3);
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
            EXPECT_LT(most_errors(runs, full), kMostErrors);
            EXPECT_NE(runs[0], runs[1]);
            // The test would see weights that are wrong by one part in a hundred.
            EXPECT_GT(most_errors(wrong, full), kMostErrors);
        }
    });
}

TEST_F(RouletteTest, LowThresholdResolvesAll) {
    const GatherCase data = room();
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        Uploaded uploaded(device, data);
        const std::vector<double> full = packet_sums(uploaded.gather(gatherer));
        const std::vector<double> almost = packet_sums(uploaded.gather(gatherer, 1e-12f));
        for (std::size_t packet = 0; packet < full.size(); ++packet) {
            EXPECT_NEAR(almost[packet], full[packet], 1e-5 * full[packet]);
        }
    });
}

TEST_F(RouletteTest, SameBitsForAnyDivision) {
    const GatherCase data = room_of_boxes(40, 700, 6, 22);
    GatherCase last = data;
    last.receivers.erase(last.receivers.begin(), last.receivers.end() - 2);
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            Gatherer gatherer(device, {.kernel = kernel});
            Gatherer step_by_step(device,
                                  {.kernel = kernel, .first_launch_pairs = 1, .launch_seconds = 1e-9});
            std::vector<IrradiancePacket> whole = Uploaded(device, data).gather(gatherer, kThreshold, 5);
            EXPECT_TRUE(same_bits(whole, Uploaded(device, data).gather(step_by_step, kThreshold, 5)));
            whole.erase(whole.begin(), whole.end() - 2);
            EXPECT_TRUE(same_bits(whole, Uploaded(device, last).gather(gatherer, kThreshold, 5)));
        }
    });
}

TEST_F(RouletteTest, RecordsOnlyWhatWasTraced) {
    const GatherCase data = room();
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        Uploaded uploaded(device, data);
        GatherInput input = uploaded.input();
        const std::vector<GatherPair> full = gatherer.gather_recorded(input, uploaded.irradiance());
        input.roulette = kThreshold;
        const std::vector<GatherPair> some = gatherer.gather_recorded(input, uploaded.irradiance());
        const std::vector<IrradiancePacket> recorded = uploaded.irradiance().download();
        std::size_t passed_over = 0;
        for (std::size_t i = 0; i < full.size(); ++i) {
            passed_over += full[i] != some[i] ? 1 : 0;
            ASSERT_TRUE(full[i] == some[i] || some[i] == GatherPair::culled) << "pair " << i;
        }
        EXPECT_GT(passed_over, full.size() / 10);
        EXPECT_TRUE(same_bits(recorded, uploaded.gather(gatherer, kThreshold)));
    });
}

TEST_F(RouletteTest, NothingToChooseFrom) {
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        GatherCase none = room();
        none.vpls.clear();
        for (const IrradiancePacket& packet : Uploaded(device, none).gather(gatherer, kThreshold)) {
            EXPECT_EQ(packet.g[0], 0.0f);
        }
        GatherCase dark = room();
        for (Vpl& vpl : dark.vpls) {
            vpl.power = {0, 0, 0};
        }
        for (const IrradiancePacket& packet : Uploaded(device, dark).gather(gatherer, kThreshold)) {
            EXPECT_EQ(packet.g[0], 0.0f);
        }
    });
}

}  // namespace
}  // namespace nearlight::test
