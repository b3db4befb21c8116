// SPDX-License-Identifier: Apache-2.0
// Instant radiosity and partition against the path tracer on scene files: the measured box, and a room that
// is lit almost only indirectly, with glass and rough metal in it.
#include "host/scene/scene_loader.h"
#include "tests/render/agreement.h"
#include "tests/support/device_fixture.h"
#include "tests/support/real_scenes.h"

namespace nearlight {
namespace {

using test::expect_agreement;

constexpr float kCornellClampRadius = 0.05f;  // the box is 0.55 m wide
constexpr float kVeachClampRadius = 1.0f;     // the room is 13 units long

Scene load_small(const std::filesystem::path& file) {
    Scene scene = load_scene(file);
    scene.camera.width = test::kAgreementSize;
    scene.camera.height = test::kAgreementSize;
    return scene;
}

class SceneFiles : public test::DeviceTest {};

TEST_F(SceneFiles, CornellBoxByInstantRadiosity) {
    const Scene scene =
        load_small(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "scenes/cornell-box/scene.xml");
    on_each_device(
        [&](Device& d) { expect_agreement(d, scene, SamplerKind::instant_radiosity, kCornellClampRadius); });
}

TEST_F(SceneFiles, CornellBoxByPartition) {
    const Scene scene =
        load_small(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "scenes/cornell-box/scene.xml");
    on_each_device(
        [&](Device& d) { expect_agreement(d, scene, SamplerKind::close_range, kCornellClampRadius); });
}

TEST_F(SceneFiles, VeachBidirByInstantRadiosity) {
    const auto file = test::real_scene("veach-bidir/scene.xml");
    if (file.empty()) {
        GTEST_SKIP() << "veach-bidir is not there; set NEARLIGHT_TEST_SCENES";
    }
    const Scene scene = load_small(file);
    on_each_device(
        [&](Device& d) { expect_agreement(d, scene, SamplerKind::instant_radiosity, kVeachClampRadius); });
}

TEST_F(SceneFiles, VeachBidirByPartition) {
    const auto file = test::real_scene("veach-bidir/scene.xml");
    if (file.empty()) {
        GTEST_SKIP() << "veach-bidir is not there; set NEARLIGHT_TEST_SCENES";
    }
    const Scene scene = load_small(file);
    on_each_device(
        [&](Device& d) { expect_agreement(d, scene, SamplerKind::close_range, kVeachClampRadius); });
}

}  // namespace
}  // namespace nearlight
