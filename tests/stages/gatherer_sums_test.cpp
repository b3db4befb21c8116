// SPDX-License-Identifier: Apache-2.0
// Tests sums of squares and of groups, and pairs that a gather leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/math.h"
#include "host/base/receivers.h"
#include "host/stages/gatherer.h"
#include "tests/stages/gatherer_variants.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

class GathererSumsTest : public DeviceTest {};

/// The sums of squares, gathered from VPLs that are marked for squares.
std::vector<IrradiancePacket> gather_squares(Device& device, Gatherer& gatherer, GatherCase data) {
    for (Vpl& vpl : data.vpls) {
        vpl.power = (1.0f / kPi) * vpl.power * vpl.power;
        vpl.flags |= NEARLIGHT_IMPORTON_SQUARED;
    }
    return Uploaded(device, data).gather(gatherer);
}

TEST_F(GathererSumsTest, GroupsAreSummedByThemselves) {
    constexpr uint kGroup = 48;
    const GatherCase data = random_triangles(100, 200, 5, 21);  // the last group has 8
    on_each_device([&](Device& device) {
        const Uploaded uploaded(device, data);
        GatherInput<Vpl> input = uploaded.input();
        input.group_size = kGroup;
        ASSERT_EQ(input.group_count(), 5u);
        for (Variant variant : variants()) {
            for (const double launch_seconds : {1e-9, 1.0}) {
                SCOPED_TRACE(variant.name);
                variant.config.first_launch_pairs = launch_seconds < 1.0 ? 1 : std::uint64_t{1} << 40u;
                variant.config.launch_seconds = launch_seconds;
                Gatherer gatherer(device, variant.config);
                GatherSums<Vpl> sums(device, data.receivers.size(), input.group_count());
                ASSERT_TRUE(gatherer.gather(input, sums));
                expect_close(sums.squares.download(), gather_squares(device, gatherer, data));
                const std::vector<IrradiancePacket> groups = sums.groups.download();
                const auto sum_of = [&](std::size_t group) {
                    const auto first =
                        groups.begin() + static_cast<std::ptrdiff_t>(group * data.receivers.size());
                    return std::vector(first, first + static_cast<std::ptrdiff_t>(data.receivers.size()));
                };
                for (std::size_t group = 0; group < input.group_count(); ++group) {
                    GatherCase of_group = data;
                    const auto first = data.vpls.begin() + static_cast<std::ptrdiff_t>(group * kGroup);
                    of_group.vpls.assign(first, std::min(first + kGroup, data.vpls.end()));
                    EXPECT_TRUE(same_bits(sum_of(group), Uploaded(device, of_group).gather(gatherer)))
                        << "group " << group;
                }
            }
        }
    });
}

/// The square of a pair's light, which is compared with GatherInput::thresholds.
double squared_light(const Vpl& vpl, const PairTerm& term) {
    const Vec3 scale = (1.0f / kPi) * vpl.power;
    const bool squared = (vpl.flags & NEARLIGHT_IMPORTON_SQUARED) != 0;
    return term.value * term.value *
           static_cast<double>(squared ? scale.x + scale.y + scale.z : dot(scale, scale));
}

/// The mean of the squares over all VPLs, for each receiver.
std::vector<float> mean_squares(const GatherCase& data) {
    std::vector<float> means;
    for (std::size_t i = 0; i < data.receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        double sum = 0;
        for (const Vpl& vpl : data.vpls) {
            sum += squared_light(vpl, pair_term(vpl, receiver_at(data.receivers, i), data.clamp_radius));
        }
        means.push_back(static_cast<float>(sum / static_cast<double>(data.vpls.size())));
    }
    return means;
}

TEST_F(GathererSumsTest, LeavesOutWhatIsBelowTheThreshold) {
    GatherCase data = random_triangles(200, 90, 5, 23);
    for (std::size_t i = 0; i < data.vpls.size(); i += 3) {
        data.vpls[i].flags = NEARLIGHT_IMPORTON_SQUARED;
    }
    const std::vector<float> thresholds = mean_squares(data);
    on_each_device([&](Device& device) {
        Uploaded uploaded(device, data);
        const Buffer<float> on_device(device, thresholds);
        GatherInput<Vpl> input = uploaded.input();
        for (const Variant& variant : variants()) {
            SCOPED_TRACE(variant.name);
            Gatherer gatherer(device, variant.config);
            input.thresholds = nullptr;
            const std::vector<GatherPair> all = gatherer.gather_recorded(input, uploaded.sums());
            input.thresholds = &on_device;
            const std::vector<GatherPair> some = gatherer.gather_recorded(input, uploaded.sums());
            std::size_t left_out = 0;
            std::size_t left = 0;
            for (std::size_t i = 0; i < all.size(); ++i) {
                const Vpl& vpl = data.vpls[i / NEARLIGHT_PACKET_SIZE % data.vpls.size()];
                const std::size_t receiver =
                    i / NEARLIGHT_PACKET_SIZE / data.vpls.size() * NEARLIGHT_PACKET_SIZE +
                    i % NEARLIGHT_PACKET_SIZE;
                const double square = squared_light(
                    vpl, pair_term(vpl, receiver_at(data.receivers, receiver), data.clamp_radius));
                if (all[i] == GatherPair::culled || std::abs(square - thresholds[receiver]) < 1e-4 * square) {
                    continue;
                }
                const bool counts = square >= thresholds[receiver];
                ++(counts ? left : left_out);
                ASSERT_EQ(some[i], counts ? all[i] : GatherPair::culled) << "pair " << i;
            }
            EXPECT_GT(left, all.size() / 50);
            EXPECT_GT(left_out, left);
            const std::vector<IrradiancePacket> recorded = uploaded.sums().light.download();
            EXPECT_TRUE(gatherer.gather(input, uploaded.sums()));
            expect_close(uploaded.sums().light.download(), recorded);
        }
    });
}

TEST_F(GathererSumsTest, RefusesASelectionByGroups) {
    const GatherCase data = random_triangles(100, 20, 1, 22);
    on_each_device([&](Device& device) {
        Uploaded uploaded(device, data);
        const VplSelection selection = uploaded.select(1.0f, 0);
        GatherInput<Vpl> input = uploaded.input();
        input.group_size = 10;
        input.selection = &selection;
        Gatherer gatherer(device);
        EXPECT_THROW(gatherer.gather(input, uploaded.sums()), Error);
    });
}

}  // namespace
}  // namespace nearlight::core::test
