// SPDX-License-Identifier: Apache-2.0
// Tunables affect the speed of a render, but not the picture.
#include <gtest/gtest.h>

#include "tests/session/corner_scene.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// A corner with copper, and a veil in it: all kernels that the defaults need have work.
Scene veiled_corner() {
    Scene scene = test::corner();
    Material copper = conductor_material({0.2f, 0.92f, 1.1f}, {3.9f, 2.45f, 2.1f});
    copper.roughness = parameter_of(0.3f);
    add_quad(scene, {0.2f, -0.5f, 0.2f}, {0, 0, 0.5f}, {0.5f, 0, 0}, add_material(scene, copper));
    const uint grey = add_material(scene, lambertian({0.6f, 0.5f, 0.4f}));
    const uint veil = add_material(scene, mask_material(parameter_of(0.4f), grey));
    add_quad(scene, {-0.3f, -0.9f, 0.0f}, {0, 1.2f, 0}, {0.9f, 0, -0.3f}, veil);
    scene.camera.width = 60;
    scene.camera.height = 40;
    return scene;
}

/// Variants with one tunable at an end of its range. Beyond the length of the picture, longer runs and
/// batches make no difference.
std::vector<std::pair<std::string, Tunables>> extremes(const Tunables& usual) {
    std::vector<std::pair<std::string, Tunables>> result;
    for (const TunableField& field : tunable_fields()) {
        for (const std::uint32_t value : {field.min, std::min(field.max, 1u << 16u)}) {
            if (value != usual.*field.value) {
                Tunables tunables = usual;
                tunables.*field.value = value;
                result.emplace_back(std::string(field.name) + " " + std::to_string(value), tunables);
            }
        }
    }
    return result;
}

class TunablesTest : public test::DeviceTest {};

TEST_F(TunablesTest, NoneChangesABitOfThePicture) {
    on_each_device([](Device& shared) {
        Device device(shared.entry(), shared.options());
        for (const SamplerKind sampler : {SamplerKind::close_range, SamplerKind::local}) {
            RenderSettings settings = test::few_vpls(sampler);
            settings.gather.roulette = sampler == SamplerKind::close_range ? 1.0f : 0.0f;
            device.set_tunables(shared.tunables());
            const std::uint64_t usual =
                test::render_image(device, veiled_corner(), settings).report.image_hash;
            for (const auto& [name, tunables] : extremes(shared.tunables())) {
                device.set_tunables(tunables);
                EXPECT_EQ(test::render_image(device, veiled_corner(), settings).report.image_hash, usual)
                    << to_string(sampler) << ", " << name;
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
