// SPDX-License-Identifier: Apache-2.0
// Angles of kernels/lib/angle.cl, and the search of kernels/lib/sampling.cl, against the host's.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/base/random.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"

namespace nearlight::core {
namespace {

using test::KernelProbe;

constexpr double kTurn = 2.0 * std::numbers::pi;

class SamplingMaps : public test::DeviceTest {};

/// Random numbers of all magnitudes from 1e-6 to 1, both signs, and the borders of octants.
std::vector<float> turns_to_try() {
    std::vector<float> turns = {0.0f, 1e-30f};
    for (int eighth = -16; eighth <= 16; ++eighth) {
        const float border = 0.125f * static_cast<float>(eighth);
        turns.insert(turns.end(), {border, std::nextafter(border, 9.0f), std::nextafter(border, -9.0f)});
    }
    Pcg32 random(3);
    while (turns.size() < 40'000) {
        const float size = std::pow(10.0f, -6.0f * random.uniform());
        turns.push_back(random.uniform() < 0.5f ? size : -size);
    }
    return turns;
}

TEST_F(SamplingMaps, PointsOfTheCircleAreCosinesAndSines) {
    const std::vector<float> turns = turns_to_try();
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/angle.cl\"\n"
                          "kernel void probe(const global float* turns, global float2* points) {\n"
                          "    points[get_global_id(0)] = circle_point(turns[get_global_id(0)]);\n"
                          "}\n");
        const Buffer<float> in(probe.device(), turns);
        Buffer<std::array<float, 2>> out(probe.device(), turns.size());
        probe.kernel().launch(turns.size(), 1, in, out);
        const std::vector<std::array<float, 2>> points = out.download();
        for (std::size_t i = 0; i < turns.size(); ++i) {
            const double angle = kTurn * static_cast<double>(turns[i]);
            ASSERT_NEAR(points[i][0], std::cos(angle), 2e-7) << turns[i];
            ASSERT_NEAR(points[i][1], std::sin(angle), 2e-7) << turns[i];
            if (std::abs(turns[i]) < 0.1f) {
                ASSERT_NEAR(points[i][1], std::sin(angle), 1e-6 * std::abs(std::sin(angle)) + 1e-37)
                    << turns[i];  // denormal numbers may be 0
            }
        }
    });
}

TEST_F(SamplingMaps, AnglesOfPointsAndCosinesAreTurnedBack) {
    // The third number is the cosine, which devices would round differently.
    std::vector<std::array<float, 3>> points = {{0, 0, 0},  {1, 0, 1},    {-1, 0, -1},    {0, 1, 0},
                                                {0, -1, 0}, {2, 2, 0.7f}, {-3, -3, -0.7f}};
    Pcg32 random(4);
    for (const float turn : turns_to_try()) {
        const double angle = kTurn * static_cast<double>(turn);
        const double radius = std::pow(10.0, 6.0 * static_cast<double>(random.uniform()) - 3.0);
        points.push_back({static_cast<float>(radius * std::cos(angle)),
                          static_cast<float>(radius * std::sin(angle)), static_cast<float>(std::cos(angle))});
    }
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/angle.cl\"\n"
                          "kernel void probe(const global float* points, global float2* turns) {\n"
                          "    const float3 p = vload3(get_global_id(0), points);\n"
                          "    turns[get_global_id(0)] = (float2)(turns_of_point(p.x, p.y),\n"
                          "                                       turns_of_cosine(p.z));\n"
                          "}\n");
        const Buffer<std::array<float, 3>> in(probe.device(), points);
        Buffer<std::array<float, 2>> out(probe.device(), points.size());
        probe.kernel().launch(points.size(), 1, in, out);
        const std::vector<std::array<float, 2>> turns = out.download();
        EXPECT_EQ(turns[0][0], 0.0f) << "the origin";
        EXPECT_EQ(turns[2][0], 0.5f) << "straight back";
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto& [x, y, cosine] = points[i];
            const double expected = std::atan2(double{y}, double{x}) / kTurn;
            ASSERT_NEAR(turns[i][0], expected, std::min(1e-7, 2e-6 * std::abs(expected) + 1e-30))
                << x << ", " << y;
            ASSERT_NEAR(turns[i][1], std::acos(double{cosine}) / kTurn, 1e-7) << cosine;
        }
    });
}

TEST_F(SamplingMaps, CosinesBeyondOneCountAsOne) {
    on_each_device([](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/angle.cl\"\n"
                          "kernel void probe(global float* turns) {\n"
                          "    turns[0] = turns_of_cosine(1.0000002f);\n"
                          "    turns[1] = turns_of_cosine(-1.0000002f);\n"
                          "}\n");
        Buffer<float> out(probe.device(), 2);
        probe.kernel().launch(1, 1, out);
        EXPECT_EQ(out.download(), (std::vector<float>{0.0f, 0.5f}));
    });
}

/// The search finds the first entry above the number for tables of each size, with steps of no height.
TEST_F(SamplingMaps, TheSearchOfADistributionFindsTheFirstEntryAbove) {
    constexpr uint kSizes = 40;
    constexpr uint kNumbers = 64;
    std::vector<float> tables;
    Pcg32 random(8);
    for (uint size = 1; size <= kSizes; ++size) {
        float sum = 0.0f;
        for (uint i = 0; i < kSizes; ++i) {
            sum += random.uniform() < 0.3f ? 0.0f : random.uniform();
            tables.push_back(sum);
        }
    }
    const auto number_of = [](uint j) { return static_cast<float>(j) * 0.25f; };
    on_each_device([&](Device& device) {
        KernelProbe probe(
            device,
            "#include \"lib/sampling.cl\"\n"
            "kernel void probe(const global float* tables, global uint* found) {\n"
            "    const uint i = get_global_id(0);\n"
            "    found[i] = search_cdf(tables + i / 64 * 40, i / 64 + 1, (float)(i % 64) * 0.25f);\n"
            "}\n");
        const Buffer<float> in(probe.device(), tables);
        Buffer<uint> out(probe.device(), kSizes * kNumbers);
        probe.kernel().launch(kSizes * kNumbers, 1, in, out);
        const std::vector<uint> found = out.download();
        for (uint i = 0; i < kSizes * kNumbers; ++i) {
            const auto first = tables.begin() + i / kNumbers * kSizes;
            const uint size = i / kNumbers + 1;
            const auto above = std::upper_bound(first, first + size, number_of(i % kNumbers));
            const auto expected = static_cast<uint>(std::min<std::ptrdiff_t>(above - first, size - 1));
            ASSERT_EQ(found[i], expected) << size << " entries, " << number_of(i % kNumbers);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
