// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_contribution.h"

#include "host/base/random.h"
#include "host/base/receivers.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
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

/// The square of the importance that an importon sends to a VPL if nothing is in the way.
double squared_importance(const CameraVertex& vertex, double term) {
    const Vec3 response = vertex.throughput * vertex.albedo;
    return dot(response, response) * term * term;
}

/// The square below which importons are not asked about the VPL: a little less than the mean over `count`
/// importons, namely all vertices and others that send nothing.
double threshold_of(const test::GatherCase& data, const std::vector<CameraVertex>& vertices, const Vpl& vpl,
                    std::size_t count) {
    double sum = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const ReceiverPoint receiver = receiver_at(data.receivers, i);
        sum += squared_importance(vertices[i], test::pair_term(vpl, receiver, data.clamp_radius).value);
    }
    return VplContribution::kNegligiblePart * sum / static_cast<double>(count);
}

/// The column sum, or the root of the sum of squares, by a plain loop with rays on the host.
double expected_contribution(const test::GatherCase& data, const std::vector<CameraVertex>& vertices,
                             const Vpl& vpl, ContributionNorm norm, double threshold = 0) {
    double sum = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const ReceiverPoint receiver = receiver_at(data.receivers, i);
        const double term = test::pair_term(vpl, receiver, data.clamp_radius).value;
        if (term > 0 && squared_importance(vertices[i], term) >= threshold &&
            !occluded(data.bvh, vpl.position, receiver.position - vpl.position, 1e-5f, 1.0f - 1e-5f)) {
            const Vec3 color = vertices[i].throughput * vertices[i].albedo * vpl.power;
            const double scale = term / (M_PI * M_PI);
            sum +=
                norm == ContributionNorm::mean ? luminance(color) * scale : dot(color, color) * scale * scale;
        }
    }
    return norm == ContributionNorm::mean ? sum : std::sqrt(sum);
}

/// The stage's result for the mean. It has one more slot than there are VPLs, which stays −1.
std::vector<float> found_contributions(Device& device, const test::GatherCase& data,
                                       const std::vector<CameraVertex>& vertices) {
    const test::SceneOnDevice on_device(device, data.scene);
    Buffer<float> contribution(device, std::vector<float>(data.vpls.size(), -1.0f));
    PilotView view;
    set_importons(device, view, make_importons(data.receivers, vertices));
    Gatherer gatherer(device);
    VplContribution(device, gatherer)
        .run(on_device.buffers, Buffer<Vpl>(device, data.vpls), data.vpls.size() - 1, view, data.clamp_radius,
             contribution);
    return contribution.download();
}

GroupContribution found_by_group(Device& device, const test::GatherCase& data, const PilotView& view) {
    const test::SceneOnDevice on_device(device, data.scene);
    Gatherer gatherer(device);
    return VplContribution(device, gatherer)
        .by_group(on_device.buffers, Buffer<Vpl>(device, data.vpls), data.vpls.size(), view,
                  data.clamp_radius);
}

test::GatherCase small_case() {
    // There are so few receivers that all of them are among the importons.
    test::GatherCase data = test::room_of_boxes(30, 70, 4, 2);
    data.scene.materials.push_back(small_scenes::lambertian({0.5f, 0.5f, 0.5f}));
    for (Vpl& vpl : data.vpls) {
        vpl.flags = 0;  // shading normals do not count
    }
    return data;
}

TEST_F(VplContributionTest, IsTheColumnSumOfAPlainLoop) {
    const test::GatherCase data = small_case();
    const std::vector<CameraVertex> vertices = random_vertices(data.receivers.size() * NEARLIGHT_PACKET_SIZE);
    on_each_device([&](Device& device) {
        const std::vector<float> found = found_contributions(device, data, vertices);
        const std::size_t vpl_count = data.vpls.size() - 1;
        uint seen = 0;
        for (std::size_t v = 0; v < vpl_count; ++v) {
            const double expected =
                expected_contribution(data, vertices, data.vpls[v], ContributionNorm::mean);
            seen += expected > 0.0 ? 1 : 0;
            EXPECT_NEAR(found[v], expected, 1e-4 * expected) << "VPL " << v;
        }
        EXPECT_GT(seen, vpl_count / 2);
        EXPECT_EQ(found[vpl_count], -1.0f) << "written beyond the last VPL";
    });
}

TEST_F(VplContributionTest, ErrorsAreRootsOfSumsOfSquaresAndGroupsAddUpToThePicture) {
    const test::GatherCase data = small_case();
    std::vector<CameraVertex> vertices = random_vertices(data.receivers.size() * NEARLIGHT_PACKET_SIZE);
    vertices.front().albedo = {};  // so that they do not fill groups of one size
    on_each_device([&](Device& device) {
        PilotView view;
        set_importons(device, view, make_importons(data.receivers, vertices));
        const ImportonGroups& groups = view.importon_groups;
        ASSERT_GT(groups.group_count, 8u);
        ASSERT_NE(groups.importon_count % groups.group_count, 0u) << "some groups are to be filled up";
        const GroupContribution found = found_by_group(device, data, view);
        ASSERT_EQ(found.errors.size(), data.vpls.size());
        ASSERT_EQ(found.rows.size(), data.vpls.size() * 3 * groups.group_count);
        const float scale =
            std::sqrt(static_cast<float>(groups.importon_count) / static_cast<float>(groups.group_count));
        double max_left_out = 0;
        for (std::size_t v = 0; v < data.vpls.size(); ++v) {
            Vec3 sum{};
            for (std::size_t group = 0; group < groups.group_count; ++group) {
                const float* brought = found.rows.data() + 3 * (v * groups.group_count + group);
                sum += scale * Vec3{brought[0], brought[1], brought[2]};
            }
            const double threshold = threshold_of(data, vertices, data.vpls[v],
                                                  std::size_t{groups.group_count} * groups.group_size);
            const double mean =
                expected_contribution(data, vertices, data.vpls[v], ContributionNorm::mean, threshold);
            EXPECT_NEAR(luminance(sum), mean, 1e-4 * mean) << "VPL " << v;
            const double error = expected_contribution(data, vertices, data.vpls[v],
                                                       ContributionNorm::error_of_draw, threshold);
            EXPECT_NEAR(found.errors[v], error, 1e-4 * error) << "VPL " << v;
            const double all =
                expected_contribution(data, vertices, data.vpls[v], ContributionNorm::error_of_draw);
            max_left_out = std::max(max_left_out, 1 - error / all);
            const double unoccluded = std::sqrt(threshold) / M_PI * luminance(data.vpls[v].power);
            EXPECT_NEAR(found.unoccluded[v], unoccluded, 1e-4 * unoccluded) << "VPL " << v;
        }
        EXPECT_GT(max_left_out, 0.0);
        EXPECT_LT(max_left_out, 0.5);
    });
}

TEST_F(VplContributionTest, UnoccludedErrorsAreThoseOfFewImportonsWithoutRays) {
    const test::GatherCase data = small_case();
    const std::vector<CameraVertex> vertices = random_vertices(data.receivers.size() * NEARLIGHT_PACKET_SIZE);
    on_each_device([&](Device& device) {
        PilotView view;
        set_importons(device, view, make_importons(data.receivers, vertices));
        const std::size_t few = view.few_squared_importons.count;
        ASSERT_LT(few, vertices.size());
        Gatherer gatherer(device);
        const std::vector<float> found =
            VplContribution(device, gatherer)
                .unoccluded_errors(Buffer<Vpl>(device, data.vpls), data.vpls.size(), view, data.clamp_radius);
        ASSERT_EQ(found.size(), data.vpls.size());
        for (std::size_t v = 0; v < found.size(); ++v) {
            double sum = 0;
            for (std::size_t i = 0; i < few; ++i) {
                const std::size_t importon = i * vertices.size() / few;
                const ReceiverPoint receiver = receiver_at(data.receivers, importon);
                sum += squared_importance(vertices[importon],
                                          test::pair_term(data.vpls[v], receiver, data.clamp_radius).value);
            }
            const double expected =
                std::sqrt(sum / static_cast<double>(few)) / M_PI * luminance(data.vpls[v].power);
            EXPECT_NEAR(found[v], expected, 1e-4 * expected) << "VPL " << v;
        }
    });
}

TEST_F(VplContributionTest, WithoutImportonsNothingIsBrought) {
    const test::GatherCase data = small_case();
    on_each_device([&](Device& device) {
        PilotView view;
        set_importons(device, view, {});
        const GroupContribution found = found_by_group(device, data, view);
        EXPECT_EQ(found.errors, std::vector<float>(data.vpls.size(), 0.0f));
        EXPECT_EQ(found.unoccluded, std::vector<float>(data.vpls.size(), 0.0f));
        EXPECT_TRUE(found.rows.empty());
    });
}

}  // namespace
}  // namespace nearlight::core
