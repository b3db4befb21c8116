// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_contribution.h"

#include "host/base/random.h"
#include "host/base/receivers.h"
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

/// The column sum, or the root of the sum of squares, by a plain loop with the host's own rays.
double expected_contribution(const test::GatherCase& data, const std::vector<CameraVertex>& vertices,
                             const Vpl& vpl, ContributionNorm norm) {
    double sum = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const ReceiverPoint receiver = receiver_at(data.receivers, i);
        const double term = test::pair_term(vpl, receiver, data.clamp_radius).value;
        if (term > 0 &&
            !occluded(data.bvh, vpl.position, receiver.position - vpl.position, 1e-5f, 1.0f - 1e-5f)) {
            const Vec3 color = vertices[i].throughput * vertices[i].albedo * vpl.power;
            const double scale = term / (M_PI * M_PI);
            sum +=
                norm == ContributionNorm::mean ? luminance(color) * scale : dot(color, color) * scale * scale;
        }
    }
    return norm == ContributionNorm::mean ? sum : std::sqrt(sum);
}

/// What the stage finds; one more slot than VPLs, −1.
std::vector<float> found_contributions(Device& device, const test::GatherCase& data,
                                       const std::vector<CameraVertex>& vertices, ContributionNorm norm) {
    const test::SceneOnDevice on_device(device, data.scene);
    Buffer<float> contribution(device, std::vector<float>(data.vpls.size(), -1.0f));
    PilotView view;
    set_importons(device, view, make_importons(data.receivers, vertices));
    Gatherer gatherer(device);
    VplContribution(device, gatherer)
        .run(on_device.buffers, Buffer<Vpl>(device, data.vpls), data.vpls.size() - 1, view, data.clamp_radius,
             contribution, norm);
    return contribution.download();
}

TEST_F(VplContributionTest, IsTheColumnNormOfAPlainLoop) {
    // Few enough receivers for all of them to be among the squared importons.
    test::GatherCase data = test::room_of_boxes(30, 70, 4, 2);
    data.scene.materials.push_back(small_scenes::lambertian({0.5f, 0.5f, 0.5f}));
    const std::vector<CameraVertex> vertices = random_vertices(data.receivers.size() * NEARLIGHT_PACKET_SIZE);
    on_each_device([&](Device& device) {
        for (const ContributionNorm norm : {ContributionNorm::mean, ContributionNorm::mean_square}) {
            const std::vector<float> found = found_contributions(device, data, vertices, norm);
            const std::size_t vpl_count = data.vpls.size() - 1;
            uint seen = 0;
            for (std::size_t v = 0; v < vpl_count; ++v) {
                const double expected = expected_contribution(data, vertices, data.vpls[v], norm);
                seen += expected > 0.0 ? 1 : 0;
                EXPECT_NEAR(found[v], expected, 1e-4 * expected) << "VPL " << v;
            }
            EXPECT_GT(seen, vpl_count / 2);
            EXPECT_EQ(found[vpl_count], -1.0f) << "written beyond the last VPL";
        }
    });
}

TEST_F(VplContributionTest, GroupsAddUpToThePicture) {
    test::GatherCase data = test::room_of_boxes(30, 70, 4, 2);
    data.scene.materials.push_back(small_scenes::lambertian({0.5f, 0.5f, 0.5f}));
    const std::vector<CameraVertex> vertices = random_vertices(data.receivers.size() * NEARLIGHT_PACKET_SIZE);
    on_each_device([&](Device& device) {
        const test::SceneOnDevice on_device(device, data.scene);
        PilotView view;
        set_importons(device, view, make_importons(data.receivers, vertices));
        ASSERT_GT(view.importon_groups.size(), 8u);
        Gatherer gatherer(device);
        const std::size_t vpl_count = data.vpls.size();
        const std::vector<float> rows = VplContribution(device, gatherer)
                                            .by_group(on_device.buffers, Buffer<Vpl>(device, data.vpls),
                                                      vpl_count, view, data.clamp_radius);
        const std::size_t row_length = 3 * view.importon_groups.size();
        ASSERT_EQ(rows.size(), vpl_count * row_length);
        for (std::size_t v = 0; v < vpl_count; ++v) {
            Vec3 sum{};
            for (std::size_t group = 0; group < view.importon_groups.size(); ++group) {
                const float* brought = rows.data() + v * row_length + 3 * group;
                const float scale = std::sqrt(static_cast<float>(view.importon_groups[group].count));
                sum += scale * Vec3{brought[0], brought[1], brought[2]};
            }
            const double expected =
                expected_contribution(data, vertices, data.vpls[v], ContributionNorm::mean);
            EXPECT_NEAR(luminance(sum), expected, 1e-4 * expected) << "VPL " << v;
        }
    });
}

}  // namespace
}  // namespace nearlight
