// SPDX-License-Identifier: Apache-2.0
#include "host/stages/metropolis_chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr float kRoomAlbedo = 0.5f;
constexpr float kFlux = 4 * kPi;
constexpr uint kDepths = 4;
constexpr uint kStates = 20'000;

/// In a closed sphere no walk is lost, and without a camera chains follow power alone, so all is known.
struct Furnace {
    explicit Furnace(Device& device)
        : scene(device, make_scene()),
          gatherer(device),
          contribution(device, gatherer),
          chains(device, contribution),
          states(device, kStates, kDepths),
          proposed(device, kStates, kDepths) {
        view.importons.importons = Buffer<Importon>(device, 0);
    }
    static Scene make_scene() {
        Scene scene;
        add_inward_sphere(scene, 1.0f, 2,
                          add_material(scene, lambertian({kRoomAlbedo, kRoomAlbedo, kRoomAlbedo})));
        add_point_light(scene, {0.2f, 0.1f, -0.3f}, {1, 1, 1});
        return scene;
    }
    [[nodiscard]] PathSpace space(Device& device) const {
        return {.scene = scene.buffers,
                .view = view,
                .clamp_radius = 0.1f,
                .blind_target = 2.0f,
                .seed = 5,
                .bounce_count = kDepths,
                .depth_cdf = make_depth_cdf(device, kDepths, 0.8f)};
    }
    /// State i is seed first + i.
    void seed(Device& device, const PathSpace& path_space, uint first) {
        std::vector<uint> indices(kStates);
        std::iota(indices.begin(), indices.end(), first);
        chains.seed(path_space, Buffer<uint>(device, std::span<const uint>(indices)), states);
    }

    test::SceneOnDevice scene;
    Gatherer gatherer;
    VplContribution contribution;
    MetropolisChains chains;
    PilotView view;
    PathStates states;
    PathStates proposed;
};

/// Fraction of the states at each depth.
std::array<double, kDepths> depth_shares(const PathStates& states) {
    std::array<double, kDepths> shares{};
    for (const Vpl& vpl : states.vpls.download()) {
        shares.at(vpl.depth - 1) += 1.0 / kStates;
    }
    return shares;
}

/// Fractions in proportion to ratio^depth.
std::array<double, kDepths> geometric_shares(double ratio) {
    std::array<double, kDepths> shares{};
    double sum = 0;
    for (uint i = 0; i < kDepths; ++i) {
        sum += shares.at(i) = std::pow(ratio, i);
    }
    for (double& share : shares) {
        share /= sum;
    }
    return shares;
}

class MetropolisChainsTest : public test::DeviceTest {};

/// Each seed estimates the light of all depths by one of them.
TEST_F(MetropolisChainsTest, SeedsCarryTheLightOfEachDepth) {
    on_each_device([](Device& device) {
        Furnace furnace(device);
        furnace.seed(device, furnace.space(device), 0);
        std::array<double, kDepths> power{};
        for (const Vpl& vpl : furnace.states.vpls.download()) {
            power.at(vpl.depth - 1) += static_cast<double>(vpl.power.y) / kStates;
            ASSERT_NEAR(length(vpl.position), 0.98f, 0.02f);
        }
        for (uint depth = 1; depth <= kDepths; ++depth) {
            const double expected = kFlux * std::pow(kRoomAlbedo, depth);
            EXPECT_NEAR(power.at(depth - 1), expected, 0.01 * expected) << "depth " << depth;
        }
        const auto shares = depth_shares(furnace.states);
        for (uint i = 0; i < kDepths; ++i) {
            EXPECT_NEAR(shares.at(i), geometric_shares(0.8).at(i), 0.01);
        }
    });
}

/// Seeds have depths in proportion to 0.8^d, and chains converge to the light at each depth, 0.5^d.
/// A proposal must be as likely as the way back.
TEST_F(MetropolisChainsTest, SmallStepsGoBothWaysAlike) {
    on_each_device([](Device& device) {
        Furnace furnace(device);
        const PathSpace space = furnace.space(device);
        furnace.seed(device, space, 0);
        const std::vector<float> before = furnace.states.numbers.download();
        furnace.chains.advance(space, 0, furnace.states, furnace.proposed);
        const std::vector<float> after = furnace.proposed.numbers.download();
        double up = 0;
        double down = 0;
        int at_ends = 0;
        for (std::size_t i = 2 * kStates; i < 4 * kStates; ++i) {  // place and direction of the light
            const float moved = after[i] - before[i] - std::round(after[i] - before[i]);  // around the ends
            up += moved > 0 && moved < 1 / 16.0f ? 1 : 0;
            down += moved < 0 && moved > -1 / 16.0f ? 1 : 0;
            at_ends += after[i] == 0 || after[i] >= 0x1.fffffep-1f ? 1 : 0;
        }
        EXPECT_LE(at_ends, 2) << "steps go around the ends";
        EXPECT_GT(up + down, kStates);
        EXPECT_NEAR(up, down, 5 * std::sqrt(up + down));
    });
}

TEST_F(MetropolisChainsTest, ChainsFollowTheirTarget) {
    on_each_device([](Device& device) {
        Furnace furnace(device);
        const PathSpace space = furnace.space(device);
        furnace.seed(device, space, 0);
        for (uint step = 0; step < 25; ++step) {
            furnace.chains.advance(space, step, furnace.states, furnace.proposed);
        }
        const auto shares = depth_shares(furnace.states);
        for (uint i = 0; i < kDepths; ++i) {
            const double expected = geometric_shares(kRoomAlbedo).at(i);
            EXPECT_NEAR(shares.at(i), expected, 4.5 * std::sqrt(expected / kStates)) << "depth " << i + 1;
        }
    });
}

TEST_F(MetropolisChainsTest, KeptStatesCarryTheirShareOfTheLight) {
    on_each_device([](Device& device) {
        Furnace furnace(device);
        const PathSpace space = furnace.space(device);
        furnace.seed(device, space, 0);
        Buffer<Vpl> kept(device, kStates + 3);
        kept.fill_zero();
        furnace.chains.keep(furnace.states, 0.25f, kept, 3);
        const std::vector<Vpl> found = kept.download();
        const std::vector<Vpl> vpls = furnace.states.vpls.download();
        const std::vector<float> targets = furnace.states.targets.download();
        EXPECT_EQ(found[2].depth, 0u);
        for (uint i = 0; i < kStates; i += 17) {
            ASSERT_FLOAT_EQ(targets[i], 2.0f * luminance(vpls[i].power));
            ASSERT_FLOAT_EQ(found[i + 3].power.x, vpls[i].power.x * 0.25f / targets[i]);
            ASSERT_EQ(found[i + 3].depth, vpls[i].depth);
        }
    });
}

/// The target is what a VPL brings to the camera, whatever the order in which the gather takes them.
TEST_F(MetropolisChainsTest, TargetsAreContributionsOfTheirOwnStates) {
    on_each_device([](Device& device) {
        Furnace furnace(device);
        std::vector<Importon> importons;
        for (const float z : {-0.9f, 0.1f, 0.5f}) {
            importons.push_back({.position = {0, 0, z},
                                 .pad0 = 0,
                                 .normal = {0, 0, 1},
                                 .flags = 0,
                                 .response = {1, 1, 1},
                                 .pad1 = 0});
        }
        furnace.view.importons.importons = Buffer<Importon>(device, std::span<const Importon>(importons));
        furnace.view.importons.count = importons.size();
        const PathSpace space = furnace.space(device);
        furnace.seed(device, space, 100);
        Buffer<float> contribution(device, kStates);
        furnace.contribution.run(space.scene, furnace.states.vpls, kStates, space.view, space.clamp_radius,
                                 contribution);
        const std::vector<float> contributions = contribution.download();
        const std::vector<Vpl> vpls = furnace.states.vpls.download();
        const std::vector<float> targets = furnace.states.targets.download();
        for (uint i = 0; i < kStates; ++i) {
            ASSERT_NEAR(targets[i], contributions[i] + 2.0f * luminance(vpls[i].power), 1e-4f * targets[i])
                << i;
        }
        EXPECT_GT(*std::ranges::max_element(contributions), 0.0f);
    });
}

}  // namespace
}  // namespace nearlight::core
