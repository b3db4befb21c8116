// SPDX-License-Identifier: Apache-2.0
// Compares the light of each sampler's sets, by region and depth, with the path tracer. Whether a set carries
// all light does not depend on the gather; lights that a sampler adds while gathering are not in the sets.
#include "tests/session/energy.h"

#include <gtest/gtest.h>

#include <functional>

#include "host/base/random.h"
#include "host/samplers/sampler.h"
#include "host/session/view.h"
#include "tests/session/variants.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::EnergyClass;
using test::Verdict;

constexpr uint kDepths = 4;
constexpr uint kEnergySeeds = 24;

/// A closed room with a block in it, under a point light.
Scene room_with_block() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.7f, 0.7f, 0.7f}));
    const uint red = add_material(scene, lambertian({0.6f, 0.2f, 0.1f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);
    add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, red);
    add_quad(scene, {-0.2f, -0.2f, 0.1f}, {0, 0, 0.5f}, {0.6f, 0, 0.1f}, white);  // the block's top
    add_quad(scene, {-0.2f, -1, 0.1f}, {0, 0.8f, 0}, {0.6f, 0, 0.1f}, white);     // its front
    add_point_light(scene, {0.3f, 0.7f, -0.2f}, {1, 1, 1});
    set_camera(scene, {0.1, 0.2, -0.9}, {0, -0.3, 1}, 100);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

/// A camera that looks back from the far end at what the scene's own camera does not see.
SceneCamera camera_behind() {
    Scene scene;
    set_camera(scene, {-0.3, 0.3, 0.9}, {0.1, -0.2, -1}, 100);
    scene.camera.width = scene.camera.height = 32;
    return scene.camera;
}

using Change = std::function<void(std::vector<Vpl>& vpls, const CloseRange& region)>;

class Energy : public test::DeviceTest {
  protected:
    struct Bench {
        explicit Bench(Device& device)
            : camera_pass(device),
              stages(device),
              on_device(device, room_with_block()),
              view(choose_view(device, camera_pass, on_device.buffers, on_device.scene,
                               on_device.scene.camera, {.range = 2.0f}, 0)),
              photographer(on_device.scene, {on_device.scene.camera, camera_behind()}, view.close_range,
                           kDepths) {}

        CameraPass camera_pass;
        SamplerStages stages;
        test::SceneOnDevice on_device;
        View view;
        test::Photographer photographer;
    };

    /// Photographs of sets of `vpl_count` VPLs, which are changed before.
    static std::vector<std::map<EnergyClass, double>> photograph(Bench& bench, const test::Variant& variant,
                                                                 uint vpl_count, const Change& change = {},
                                                                 uint depths = kDepths) {
        std::vector<std::map<EnergyClass, double>> photographs;
        for (uint seed = 0; seed < kEnergySeeds; ++seed) {
            const VplSet set = sample_vpls(bench.stages, {.scene = bench.on_device.buffers,
                                                          .view = bench.view.pilot,
                                                          .sampler = variant.sampler,
                                                          .policy = variant.policy,
                                                          .vpl_count = vpl_count,
                                                          .bounce_count = depths,
                                                          .close_fraction = 0.5f,
                                                          .close_range = bench.view.close_range,
                                                          .clamp_radius = bench.view.clamp_radius,
                                                          .seed = 100 + seed});
            std::vector<Vpl> vpls = set.vpls.download();
            if (change) {
                change(vpls, bench.view.close_range);
            }
            photographs.push_back(bench.photographer.photograph(vpls));
        }
        return photographs;
    }
};

constexpr test::Variant kWalks{SamplerKind::instant_radiosity, Policy::partition};
constexpr test::Variant kPaper{SamplerKind::close_range, Policy::paper};

/// Some VPLs of this sampler carry light of all depths, so that only sums over depths can be compared.
bool mixes_depths(const test::Variant& variant) {
    return (variant.sampler == SamplerKind::close_range && variant.policy == Policy::complete) ||
           variant.sampler == SamplerKind::bidirectional;
}

TEST_F(Energy, EverySamplerPutsTheRightLightInEachRegionAndDepth) {
    on_each_device([](Device& device) {
        Bench bench(device);
        const auto& truth = bench.photographer.truth();
        EXPECT_EQ(truth.size(), 4u * kDepths) << "both cameras see both regions";
        for (const test::Variant& variant : test::all_variants()) {
            if (mixes_depths(variant)) {
                for (const uint depth : {1u, 2u, kDepths}) {
                    const Verdict verdict = judge_energies(photograph(bench, variant, 1000, {}, depth),
                                                           light_up_to(depth, truth));
                    EXPECT_TRUE(verdict.agrees)
                        << variant.name() << ", depth " << depth << ": " << verdict.reason;
                    EXPECT_LT(verdict.relative_error, 0.1)
                        << variant.name() << ": too noisy to tell anything";
                }
            } else if (variant.policy != Policy::paper) {
                const Verdict verdict = judge_energies(photograph(bench, variant, 10'000), truth);
                EXPECT_TRUE(verdict.agrees) << variant.name() << ": " << verdict.reason;
                EXPECT_LT(verdict.relative_error, 0.1) << variant.name() << ": too noisy to tell anything";
            }
        }
    });
}

TEST_F(Energy, ThePaperDropsBouncesInTheCloseRangeAndNothingElse) {
    on_each_device([](Device& device) {
        Bench bench(device);
        const auto photographs = photograph(bench, kPaper, 20'000);
        auto kept = bench.photographer.truth();
        auto lost = kept;
        std::erase_if(kept, [](const auto& entry) { return entry.first.depth > 1; });
        std::erase_if(lost, [](const auto& entry) { return entry.first.depth == 1 || !entry.first.inside; });
        const Verdict first = judge_energies(photographs, kept);
        EXPECT_TRUE(first.agrees) << first.reason;
        for (const auto& [energy_class, expected] : lost) {
            const Verdict verdict = judge_energies(photographs, {{energy_class, expected}});
            EXPECT_FALSE(verdict.agrees) << to_string(energy_class);
            EXPECT_LT(verdict.bias, -0.9) << to_string(energy_class);
        }
    });
}

/// Tests the check itself: it must refuse a few percent too much light of one depth.
TEST_F(Energy, AWrongFactorOfOneDepthIsFound) {
    on_each_device([](Device& device) {
        Bench bench(device);
        for (const auto& [wrong, factor] : {std::pair{2u, 1.05f}, {4u, 1.1f}}) {
            const Change brighten = [wrong = wrong, factor = factor](std::vector<Vpl>& vpls,
                                                                     const CloseRange&) {
                for (Vpl& vpl : vpls) {
                    vpl.power *= vpl.depth == wrong ? factor : 1.0f;
                }
            };
            const Verdict verdict =
                judge_energies(photograph(bench, kWalks, 100'000, brighten), bench.photographer.truth());
            EXPECT_FALSE(verdict.agrees) << "depth " << wrong;
            EXPECT_NE(verdict.reason.find("depth " + std::to_string(wrong)), std::string::npos)
                << verdict.reason;
        }
    });
}

/// Drops VPLs at random, more of them outside than inside; `of` gives the factor for the others.
void thin_out(std::vector<Vpl>& vpls, const CloseRange& region,
              const std::function<float(float p, float share)>& of) {
    constexpr float kOutside = 0.5f;
    Pcg32 random(vpls.size());
    std::vector<Vpl> kept;
    std::vector<float> probabilities;
    for (const Vpl& vpl : vpls) {
        const float p = test::in_region(region, vpl.position) ? 1.0f : kOutside;
        if (random.uniform() < p) {
            kept.push_back(vpl);
            probabilities.push_back(p);
        }
    }
    const float share = static_cast<float>(kept.size()) / static_cast<float>(vpls.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        kept[i].power *= of(probabilities[i], share);
    }
    vpls = std::move(kept);
}

/// A chosen VPL must be divided by its own probability, not by the fraction of all VPLs that were accepted.
TEST_F(Energy, DividingByWhatWasAcceptedIsFound) {
    on_each_device([](Device& device) {
        Bench bench(device);
        const auto& truth = bench.photographer.truth();
        const auto judge = [&](const std::function<float(float, float)>& of) {
            const Change thin = [&of](std::vector<Vpl>& vpls, const CloseRange& region) {
                thin_out(vpls, region, of);
            };
            return judge_energies(photograph(bench, kWalks, 40'000, thin), truth);
        };
        const Verdict right = judge([](float p, float) { return 1.0f / p; });
        EXPECT_TRUE(right.agrees) << right.reason;
        EXPECT_FALSE(judge([](float, float share) { return 1.0f / share; }).agrees);
    });
}

}  // namespace
}  // namespace nearlight::core
