// SPDX-License-Identifier: Apache-2.0
// Tunables affect the speed of a render, but not the picture.
#include <gtest/gtest.h>

#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// A floor, a step above it and a sky.
Scene step() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.6f, 0.5f, 0.4f}));
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, grey);
    add_quad(scene, {-1, -0.5f, 0}, {0, 0, 1}, {1, 0, 0}, grey);
    scene.environment = {.width = 1, .height = 1, .radiance = {{0.3f, 0.4f, 0.5f}}, .to_world = {}};
    set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, 70);
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
            const std::uint64_t usual = test::render_image(device, step(), settings).report.image_hash;
            for (const auto& [name, tunables] : extremes(shared.tunables())) {
                device.set_tunables(tunables);
                EXPECT_EQ(test::render_image(device, step(), settings).report.image_hash, usual)
                    << to_string(sampler) << ", " << name;
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
