// SPDX-License-Identifier: Apache-2.0
#include "host/stages/path_light.h"

#include <cmath>

#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight {
namespace {

using namespace small_scenes;

class PathLightTest : public test::DeviceTest {};

constexpr Vec3 kAlbedo{0.8f, 0.5f, 0.2f};

/// An integrating sphere of radius 2 with a lamp of 4 W/sr in its middle: E = 1 W/m² all over, and each
/// bounce gives albedo times the irradiance of the one before.
Scene integrating_sphere() {
    Scene scene;
    add_inward_sphere(scene, 2.0f, 4, add_material(scene, lambertian(kAlbedo)));
    add_point_light(scene, {0, 0, 0}, {4, 4, 4});
    return scene;
}

/// A packet on the sphere, every fifth absent.
std::vector<test::ReceiverPoint> points_on_sphere() {
    std::vector<test::ReceiverPoint> points;
    for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
        const auto angle = static_cast<float>(i);
        const float z = (static_cast<float>(i) + 0.5f) / 32.0f - 1.0f;
        const float r = std::sqrt(1 - z * z);
        const Vec3 out{r * std::cos(angle), r * std::sin(angle), z};
        points.push_back({out * 1.99f, i % 5 == 4 ? Vec3{0, 0, 0} : -out});
    }
    return points;
}

TEST_F(PathLightTest, EachBounceInAnIntegratingSphereGivesAlbedoTimesTheOneBefore) {
    on_each_device([](Device& device) {
        const test::SceneOnDevice scene(device, integrating_sphere());
        const std::vector<test::ReceiverPoint> points = points_on_sphere();
        const std::vector<ReceiverPacket> packets = test::pack_receivers(points);
        Buffer<IrradiancePacket> irradiance(device, 1);
        PathLight stage(device);
        const SparseVpls plain{.vpls = Buffer<Vpl>(device, 0), .count = 0, .radius = 1e9f};
        Vec3 expected{0, 0, 0};
        Vec3 bounce{1, 1, 1};
        for (uint bounces = 1; bounces <= 4; ++bounces, bounce *= kAlbedo) {
            expected += bounce;
            stage.run(scene.buffers, Buffer<ReceiverPacket>(device, std::span(packets)), 1, plain,
                      {.path_count = 8, .bounce_count = bounces, .direct_samples = 1, .seed = 5}, irradiance);
            const std::vector<IrradiancePacket> found = irradiance.download();
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec3 e = test::irradiance_at(found, i);
                const Vec3 wanted = is_zero(points[i].normal) ? Vec3{0, 0, 0} : expected;
                EXPECT_LT(length(e - wanted), 0.03f * length(wanted) + 1e-9f)
                    << bounces << " bounces, receiver " << i;
            }
        }
    });
}

}  // namespace
}  // namespace nearlight
