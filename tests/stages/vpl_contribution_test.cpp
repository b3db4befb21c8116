// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_contribution.h"

#include "host/base/random.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight {
namespace {

class VplContributionTest : public test::DeviceTest {};

std::vector<CameraVertex> random_vertices(std::size_t count) {
    Pcg32 random(1);
    const auto color = [&] {
        const float r = random.uniform();
        const float g = random.uniform();
        return Vec3{r, g, random.uniform()};
    };
    std::vector<CameraVertex> vertices(count);
    for (CameraVertex& vertex : vertices) {
        vertex.throughput = color();
        vertex.albedo = color();
    }
    return vertices;
}

/// The column sum by a plain loop, with the host's own rays.
double expected_contribution(const test::GatherCase& data, const std::vector<CameraVertex>& vertices,
                             const Vpl& vpl) {
    double sum = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const test::Point receiver =
            test::point_of(data.receivers[i / NEARLIGHT_PACKET_SIZE], i % NEARLIGHT_PACKET_SIZE);
        const double term = test::pair_term(vpl, receiver, data.clamp_radius).value;
        if (term > 0 &&
            !occluded(data.bvh, vpl.position, receiver.position - vpl.position, 1e-5f, 1.0f - 1e-5f)) {
            sum += term * luminance(vertices[i].throughput * vertices[i].albedo * vpl.power) / (M_PI * M_PI);
        }
    }
    return sum;
}

TEST_F(VplContributionTest, IsTheColumnSumOfAPlainLoop) {
    test::GatherCase data = test::room_of_boxes(30, 70, 4, 2);
    data.scene.materials.push_back(small_scenes::lambertian({0.5f, 0.5f, 0.5f}));
    const std::vector<CameraVertex> vertices = random_vertices(data.receivers.size() * NEARLIGHT_PACKET_SIZE);
    on_each_device([&](Device& device) {
        const test::SceneOnDevice on_device(device, data.scene);
        Buffer<float> contribution(device, std::vector<float>(data.vpls.size(), -1.0f));
        const std::size_t vpl_count = data.vpls.size() - 1;
        const std::vector<Vpl> importons = make_importons(data.receivers, vertices);
        PilotView view;
        view.importons = Buffer<Vpl>(device, std::span(importons));
        view.importon_count = importons.size();
        Gatherer gatherer(device);
        VplContribution(device, gatherer)
            .run(on_device.buffers, Buffer<Vpl>(device, data.vpls), vpl_count, view, data.clamp_radius, contribution);
        const std::vector<float> found = contribution.download();
        uint seen = 0;
        for (std::size_t v = 0; v < vpl_count; ++v) {
            const double expected = expected_contribution(data, vertices, data.vpls[v]);
            seen += expected > 0.0 ? 1 : 0;
            EXPECT_NEAR(found[v], expected, 1e-4 * expected) << "VPL " << v;
        }
        EXPECT_GT(seen, vpl_count / 2);
        EXPECT_EQ(found[vpl_count], -1.0f) << "written beyond the last VPL";
    });
}

}  // namespace
}  // namespace nearlight
