// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_cuts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/stages/gatherer.h"
#include "host/stages/vpl_order.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/spread.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

/// Strata stand for so many evenly spaced shifts that the mean over all of them is the expectation.
constexpr uint kManyStrata = 2000;
constexpr std::size_t kBundleSize = NEARLIGHT_BUNDLE_PACKETS * NEARLIGHT_PACKET_SIZE;

/// The lists of all bundles.
struct Lists {
    std::vector<uint> vpls;
    std::vector<float> weights;
    std::vector<uint> lengths;
    std::size_t stride = 0;
};

/// The VPLs of a case along the Morton curve, a tree over them, and strata for the bundles.
class Cut {
  public:
    Cut(Device& device, const GatherCase& data, std::size_t asked, uint strata = 1)
        : stage_(device),
          vpls_(VplOrder(device).sort(data.vpls)),
          tree_(stage_.make_tree(vpls_.buffer(), vpls_.count())),
          receivers_(device, data.receivers),
          strata_(device, strata, numbers(strata)),
          clamp_radius_(data.clamp_radius),
          asked_(asked) {}

    [[nodiscard]] const CutTree& tree() const { return tree_; }
    [[nodiscard]] const Buffer<Vpl>& vpls() const { return vpls_.buffer(); }
    [[nodiscard]] VplSelection select(uint seed) {
        return stage_.select({.vpls = vpls_.buffer(),
                              .tree = tree_,
                              .receivers = receivers_,
                              .packet_count = receivers_.count(),
                              .strata = strata_,
                              .clamp_radius = clamp_radius_,
                              .asked_count = asked_,
                              .seed = seed});
    }
    Lists lists(uint seed) {
        const BundleLayout layout{static_cast<uint>(receivers_.count())};
        const VplSelection selection = select(seed);
        const VplLists& lists = selection.lists(0, layout.bundle_count());
        return {lists.vpls.download(), lists.weights.download(), lists.lengths.download(), lists.stride};
    }
    /// The light at the receivers, as `gatherer` finds it.
    std::vector<IrradiancePacket> gather(Device& device, Gatherer& gatherer, const GatherCase& data,
                                         uint seed) {
        const DeviceTree tree = upload_both_trees(device, data.bvh);
        const VplSelection selection = select(seed);
        GatherSums<Vpl> sums(device, receivers_.count());
        EXPECT_TRUE(gatherer.gather<Vpl>({.tree = tree,
                                          .vpls = vpls_.buffer(),
                                          .vpl_count = vpls_.count(),
                                          .receivers = receivers_,
                                          .packet_count = receivers_.count(),
                                          .clamp_radius = clamp_radius_,
                                          .selection = &selection},
                                         sums));
        return sums.light.download();
    }

  private:
    static std::vector<uint> numbers(uint count) {
        std::vector<uint> result(count);
        std::iota(result.begin(), result.end(), 0u);
        return result;
    }

    LightCuts stage_;
    VplBuffer vpls_;
    CutTree tree_;
    Buffer<ReceiverPacket> receivers_;
    VplStrata strata_;
    float clamp_radius_;
    std::size_t asked_;
};

/// A room of which one bundle of receivers is there `times` times.
GatherCase room_with_copies(std::size_t vpls, uint times) {
    GatherCase data = room_of_boxes(30, vpls, NEARLIGHT_BUNDLE_PACKETS, 41);
    const std::vector<ReceiverPacket> bundle = data.receivers;
    for (uint i = 1; i < times; ++i) {
        data.receivers.insert(data.receivers.end(), bundle.begin(), bundle.end());
    }
    return data;
}

/// The green light of a receiver of the bundle, over all copies.
Spread spread_over_copies(std::span<const IrradiancePacket> light, std::size_t receiver) {
    std::vector<double> values;
    for (std::size_t i = receiver; i < light.size() * NEARLIGHT_PACKET_SIZE; i += kBundleSize) {
        values.push_back(irradiance_at(light, i).y);
    }
    return spread_of(values);
}

/// Receivers that all see the same: points of one packet's plane.
GatherCase flat_case(std::vector<Vpl> vpls) {
    GatherCase data = room_of_boxes(1, 1, NEARLIGHT_BUNDLE_PACKETS, 5);
    data.vpls = std::move(vpls);
    data.receivers.assign(NEARLIGHT_BUNDLE_PACKETS, ReceiverPacket{});
    for (std::size_t i = 0; i < data.receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        const auto x = 0.001f * static_cast<float>(i);
        set_receiver(data.receivers[i / NEARLIGHT_PACKET_SIZE], i % NEARLIGHT_PACKET_SIZE,
                     {{x, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}});
    }
    return data;
}

Vpl vpl_at(Vec3 position, Vec3 normal, float power) {
    Vpl vpl{};
    vpl.position = position;
    vpl.normal = normal;
    vpl.power = {power, power, power};
    return vpl;
}

/// VPLs on a ceiling one metre above the receivers of flat_case(), within a square of two metres.
std::vector<Vpl> ceiling(uint side) {
    std::vector<Vpl> vpls;
    for (uint i = 0; i < side * side; ++i) {
        const auto x = static_cast<float>(i % side) / static_cast<float>(side);
        const auto y = static_cast<float>(i / side) / static_cast<float>(side);
        vpls.push_back(vpl_at({2 * x - 1, 2 * y - 1, 1.0f}, {0.0f, 0.0f, -1.0f}, 1.0f));
    }
    return vpls;
}

class LightCutsTest : public DeviceTest {};

TEST_F(LightCutsTest, NodesHoldTheirVpls) {
    const GatherCase data = room_of_boxes(40, 5000, 1, 40);
    on_each_device([&](Device& device) {
        const Cut cut(device, data, 10);
        const std::vector<CutNode> nodes = cut.tree().nodes.download();
        const std::vector<Vpl> vpls = cut.vpls().download();
        ASSERT_EQ(nodes.size(), 625u + 79u + 10u);
        ASSERT_EQ(cut.tree().root_count(), 10u);
        double power = 0.0;
        for (uint i = cut.tree().first_root(); i < nodes.size(); ++i) {
            power += nodes[i].power;
        }
        double expected = 0.0;
        std::size_t run = NEARLIGHT_CUT_FANOUT;  // VPLs below a node
        for (std::size_t level = 0; level + 1 < cut.tree().first_nodes.size(); ++level) {
            for (std::size_t i = 0; i < vpls.size(); ++i) {
                const CutNode& node = nodes[cut.tree().first_nodes[level] + i / run];
                const Vec3 p = vpls[i].position;
                ASSERT_TRUE(p.x >= node.low.x && p.y >= node.low.y && p.z >= node.low.z);
                ASSERT_TRUE(p.x <= node.high.x && p.y <= node.high.y && p.z <= node.high.z);
                ASSERT_LE(length(vpls[i].normal - node.axis), node.spread + 1e-5f);
            }
            run *= NEARLIGHT_CUT_FANOUT;
        }
        for (const Vpl& vpl : vpls) {
            expected += max_component(vpl.power) / kPi;
        }
        EXPECT_NEAR(power, expected, 1e-4 * expected);
    });
}

TEST_F(LightCutsTest, MeanOverShiftsIsTheFullGather) {
    const GatherCase data = room_with_copies(700, kManyStrata);
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            SCOPED_TRACE(kernel == GatherKernel::packets ? "packets" : "rays");
            Gatherer gatherer(device, {.kernel = kernel});
            const std::vector<IrradiancePacket> full =
                Uploaded(device, room_with_copies(700, 1)).gather(gatherer);
            Cut cut(device, data, std::size_t{20} * kManyStrata, kManyStrata);
            const std::vector<IrradiancePacket> some = cut.gather(device, gatherer, data, 1);
            double total = 0.0;
            double expected_total = 0.0;
            for (std::size_t i = 0; i < kBundleSize; ++i) {
                const Spread light = spread_over_copies(some, i);
                const double expected = irradiance_at(full, i).y;
                // Evenly spaced shifts are closer to the expectation than independent ones, whose error this
                // is.
                EXPECT_NEAR(light.mean, expected, 2.0 * light.error + 1e-5 * expected) << "receiver " << i;
                total += light.mean;
                expected_total += expected;
            }
            EXPECT_NEAR(total, expected_total, 1e-3 * expected_total);
        }
    });
}

TEST_F(LightCutsTest, StrataShareTheVplsOfACut) {
    const GatherCase data = room_with_copies(400, kManyStrata);
    on_each_device([&](Device& device) {
        Cut cut(device, data, std::size_t{30} * kManyStrata, kManyStrata);
        const Lists lists = cut.lists(2);
        std::vector<uint> times(data.vpls.size());
        std::vector<float> weights(data.vpls.size());
        for (std::size_t bundle = 0; bundle < kManyStrata; ++bundle) {
            const std::size_t first = bundle * lists.stride;
            EXPECT_GE(lists.lengths[bundle], 29u);
            EXPECT_LE(lists.lengths[bundle], 31u);
            for (std::size_t k = first; k < first + lists.lengths[bundle]; ++k) {
                EXPECT_TRUE(k == first || lists.vpls[k] > lists.vpls[k - 1]);
                EXPECT_GE(lists.weights[k], 1.0f);
                weights[lists.vpls[k]] = lists.weights[k];
                ++times[lists.vpls[k]];
            }
        }
        std::size_t asked = 0;
        for (std::size_t i = 0; i < times.size(); ++i) {
            if (times[i] > 0) {
                EXPECT_NEAR(times[i], kManyStrata / weights[i], 2.0) << "VPL " << i;
                ++asked;
            }
        }
        EXPECT_GT(asked, data.vpls.size() / 3);
    });
}

TEST_F(LightCutsTest, StrongAndNearVplsAreAskedForCertain) {
    std::vector<Vpl> vpls = ceiling(16);
    vpls[100].power = {500.0f, 0.0f, 0.0f};
    vpls.push_back(vpl_at({0.1f, 0.0f, 0.05f}, {0.0f, 0.0f, -1.0f}, 1.0f));
    const GatherCase data = flat_case(vpls);
    on_each_device([&](Device& device) {
        Cut cut(device, data, 16);
        const std::vector<Vpl> sorted = cut.vpls().download();
        for (uint seed = 0; seed < 20; ++seed) {
            const Lists lists = cut.lists(seed);
            int strong = 0;
            int near = 0;
            for (uint k = 0; k < lists.lengths[0]; ++k) {
                const Vpl& vpl = sorted[lists.vpls[k]];
                strong += vpl.power.x > 100.0f && lists.weights[k] == 1.0f ? 1 : 0;
                near += vpl.position.z < 0.5f && lists.weights[k] == 1.0f ? 1 : 0;
            }
            EXPECT_EQ(strong, 1);
            EXPECT_EQ(near, 1);
        }
    });
}

TEST_F(LightCutsTest, SameBitsForAnyDivision) {
    const GatherCase data = room_of_boxes(40, 900, 22, 42);
    on_each_device([&](Device& device) {
        test::expect_same_bits_for_any_division(
            device, data, [&](const GatherCase& some, Gatherer& gatherer) {
                return Cut(device, some, 25).gather(device, gatherer, some, 5);
            });
    });
}

TEST_F(LightCutsTest, FewVplsAreAllAsked) {
    const std::vector<Vpl> all = ceiling(3);
    on_each_device([&](Device& device) {
        for (const std::size_t count : {1u, 2u, 8u, 9u}) {
            const GatherCase data =
                flat_case({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)});
            const Lists lists = Cut(device, data, count).lists(3);
            ASSERT_EQ(lists.lengths[0], count);
            EXPECT_TRUE(std::all_of(lists.weights.begin(),
                                    lists.weights.begin() + static_cast<std::ptrdiff_t>(count),
                                    [](float weight) { return std::abs(weight - 1.0f) < 1e-4f; }));
        }
    });
}

TEST_F(LightCutsTest, NothingIsAskedThatBringsNothing) {
    const std::vector<Vpl> good = ceiling(10);
    std::vector<std::vector<Vpl>> cases(4, good);
    for (std::size_t i = 0; i < good.size(); ++i) {
        cases[0][i].normal = {0.0f, 0.0f, 1.0f};  // turned away
        cases[1][i].position.z = -1.0f;           // below the receivers
        cases[2][i].power = {0.0f, 0.0f, 0.0f};   // dark
        cases[3][i].power.y = std::nanf("");      // not a number
    }
    on_each_device([&](Device& device) {
        for (const std::vector<Vpl>& vpls : cases) {
            EXPECT_EQ(Cut(device, flat_case(vpls), 7).lists(0).lengths[0], 0u);
        }
        GatherCase absent = flat_case(good);
        absent.receivers.assign(NEARLIGHT_BUNDLE_PACKETS, ReceiverPacket{});
        EXPECT_EQ(Cut(device, absent, 7).lists(0).lengths[0], 0u);
        absent.receivers[2] = flat_case(good).receivers[2];
        EXPECT_GT(Cut(device, absent, 7).lists(0).lengths[0], 5u);
    });
}

TEST_F(LightCutsTest, OddSets) {
    GatherCase one_place = flat_case(std::vector<Vpl>(500, ceiling(1)[0]));
    GatherCase negative = flat_case(std::vector<Vpl>(500, vpl_at({0, 0, 1}, {0, 0, -1}, -1.0f)));
    GatherCase wide_radius = flat_case(ceiling(30));
    wide_radius.clamp_radius = 1e15f;
    GatherCase no_radius = flat_case(std::vector<Vpl>(100, vpl_at({0, 0, 0}, {0, 0, -1}, 1.0f)));
    no_radius.clamp_radius = 0.0f;
    GatherCase bright_without_radius = flat_case(std::vector<Vpl>(100, vpl_at({0, 0, 0}, {0, 0, -1}, 1e15f)));
    bright_without_radius.clamp_radius = 0.0f;
    on_each_device([&](Device& device) {
        for (const GatherCase* data :
             {&one_place, &negative, &wide_radius, &no_radius, &bright_without_radius}) {
            const Lists lists = Cut(device, *data, 20).lists(1);
            EXPECT_GE(lists.lengths[0], 19u);
            EXPECT_LE(lists.lengths[0], 21u);
            double count = 0.0;
            for (uint k = 0; k < lists.lengths[0]; ++k) {
                EXPECT_TRUE(std::isfinite(lists.weights[k]));
                count += lists.weights[k];
            }
            // VPLs that are alike have equal probabilities, so the weights add up to their number.
            if (data != &wide_radius) {
                EXPECT_NEAR(count, static_cast<double>(data->vpls.size()), 0.06 * count);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core::test
