// SPDX-License-Identifier: Apache-2.0
// Rays of receivers bring back what the clamp radius takes away. So every sampler has the expectation of the
// path tracer without a clamp radius, whatever the radius is.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "host/reference/path_tracer.h"
#include "tests/session/convergence.h"
#include "tests/session/corner_scene.h"
#include "tests/session/rendering.h"
#include "tests/session/variants.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// Of these radii, the first leaves almost all light to VPLs, and the second, as long as the scene is wide,
/// leaves most of it to rays.
constexpr std::array kRadii{0.02f, 2.0f};
constexpr uint kRadiusSeeds = 16;

/// A block on the corner's floor, of two sides and the top.
void add_block(Scene& scene, Vec3 at, float size, uint material) {
    add_quad(scene, at, {0, size, 0}, {size, 0, 0}, material);
    add_quad(scene, at, {0, 0, size}, {0, size, 0}, material);
    add_quad(scene, at + Vec3{0, size, 0}, {0, 0, size}, {size, 0, 0}, material);
}

Scene corner_with_metal() {
    Scene scene = test::corner();
    Material copper = conductor_material({0.2f, 0.92f, 1.1f}, {3.9f, 2.45f, 2.1f});
    copper.roughness = parameter_of(0.3f);
    add_block(scene, {0.2f, -1, 0.2f}, 0.5f, add_material(scene, copper));
    return scene;
}

Scene corner_with_plastic_and_glass() {
    Scene scene = test::corner();
    Material plastic = plastic_material(scene, {.alpha = 0.2});
    plastic.reflectance = parameter_of(Vec3{0.2f, 0.5f, 0.7f});
    add_block(scene, {0.2f, -1, 0.2f}, 0.5f, add_material(scene, plastic));
    const uint pane = add_material(scene, thin_dielectric_material(1.5));
    add_quad(scene, {-0.3f, -0.9f, 0.0f}, {0, 1.2f, 0}, {0.9f, 0, -0.3f}, pane);
    return scene;
}

/// The walls that were white are plastic under a map, which tilts their normals far enough for many viewers
/// to see them from behind.
Scene corner_of_mapped_plastic() {
    Scene scene = test::corner();
    Material plastic = plastic_material(scene, {.alpha = 0});
    plastic.reflectance = parameter_of(Vec3{0.8f, 0.8f, 0.8f});
    const Vec3 tilted = normalize({0.5f, 0.3f, 0.6f});
    const Parameter map = parameter_of((tilted + Vec3{1, 1, 1}) * 0.5f);
    scene.materials[0] = normal_map_material(map, add_material(scene, plastic));
    return scene;
}

/// The ways in which VPLs come to be: from cells of the close range and walks, from walks alone, from walks
/// of both ends, and from the next hits of the receivers.
bool is_of_its_own_kind(const test::Variant& variant) {
    return variant.policy == Policy::complete &&
           (variant.sampler == SamplerKind::close_range ||
            variant.sampler == SamplerKind::instant_radiosity ||
            variant.sampler == SamplerKind::bidirectional || variant.sampler == SamplerKind::local);
}

class AnyClampRadius : public test::DeviceTest {
  protected:
    using Choice = std::function<bool(const test::Variant&)>;

    void expect_no_influence(const Scene& scene, const Choice& choice = is_of_its_own_kind) {
        const Image truth = trace_paths(scene, {.spp = 8192, .max_depth = 6, .seed = 31});
        on_each_device([&](Device& device) {
            Session session(device, scene);
            for (const test::Variant& variant : test::all_variants()) {
                if (variant.policy != Policy::paper && choice(variant)) {
                    for (const float radius : kRadii) {
                        SCOPED_TRACE(variant.name() + ", radius " + std::to_string(radius));
                        expect_right(session, variant, radius, truth);
                    }
                }
            }
        });
    }

  private:
    static void expect_right(Session& session, const test::Variant& variant, float radius,
                             const Image& truth) {
        const RenderSettings settings{
            .view = {.range = 2.0f, .clamp_radius = radius, .max_depth = 6},
            .sampling = {.sampler = variant.sampler, .policy = variant.policy, .vpl_count = 1000},
            .gather = {.samples_per_pixel = 8, .direct_samples_per_pixel = 32, .rays_per_pixel = 64}};
        const std::vector<Image> renders = test::render_seeds(session, settings, 300, kRadiusSeeds);
        for (const std::string layer : {"direct", "indirect"}) {
            const test::Verdict verdict = test::judge_convergence(renders, truth, layer);
            EXPECT_TRUE(verdict.agrees) << layer << ": " << verdict.reason;
            EXPECT_LT(verdict.relative_error, 0.02)
                << layer << ": too noisy to tell anything, bias " << verdict.bias;
        }
    }
};

TEST_F(AnyClampRadius, InADiffuseCorner) {
    expect_no_influence(test::corner(), [](const test::Variant&) { return true; });
}
TEST_F(AnyClampRadius, BesideMetal) {
    expect_no_influence(corner_with_metal());
}
TEST_F(AnyClampRadius, UnderMapsOnPlastic) {
    expect_no_influence(corner_of_mapped_plastic());
}
TEST_F(AnyClampRadius, BesidePlasticAndBehindGlass) {
    expect_no_influence(corner_with_plastic_and_glass());
}

}  // namespace
}  // namespace nearlight::core
