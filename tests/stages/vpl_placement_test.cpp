// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_placement.h"

#include <cmath>
#include <numeric>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/scene/camera.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class VplPlacementTest : public test::DeviceTest {};

/// Right-angled triangles of given areas; texture coordinates are the x and y of the position. `ids` lists
/// the triangles to place on.
struct Surface {
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;
    std::vector<float> areas;
    std::vector<uint> ids;

    explicit Surface(const std::vector<float>& wanted_areas) : areas(wanted_areas), ids(wanted_areas.size()) {
        for (const float area : wanted_areas) {
            const float side = std::sqrt(2.0f * area);
            const uint first = static_cast<uint>(vertices.size());
            for (const Vec3 p : {Vec3{1, 2, 3}, Vec3{1 + side, 2, 3}, Vec3{1, 2 + side, 3}}) {
                vertices.push_back({.position = p, .u = p.x, .normal = {}, .v = p.y});
            }
            triangles.push_back({first, first + 1, first + 2, 0});
        }
        std::iota(ids.begin(), ids.end(), 0u);
    }
    [[nodiscard]] double total() const { return std::accumulate(areas.begin(), areas.end(), 0.0); }
};

/// A surface on a device, ready to be placed on.
class Placer {
  public:
    Placer(Device& device, const Surface& surface)
        : Placer(device, surface, area_units_per_square_metre(surface.total())) {}
    Placer(Device& device, const Surface& surface, float units)
        : device_(&device),
          placement_(device),
          vertices_(device, surface.vertices),
          triangles_(device, surface.triangles),
          surface_(placement_.surface_of(Buffer<float>(device, surface.areas),
                                         Buffer<uint>(device, surface.ids), surface.ids.size(), units)),
          range_(device, std::vector<CloseRange>(1)) {}
    std::vector<SurfaceSample> place(std::size_t count, uint seed) {
        Buffer<SurfaceSample> samples(*device_, count);
        placement_.place(surface_, vertices_, triangles_, range_, true, count, seed, samples);
        return samples.download();
    }
    [[nodiscard]] double total_area() const { return surface_.area; }

  private:
    Device* device_;
    VplPlacement placement_;
    Buffer<Vertex> vertices_;
    Buffer<Triangle> triangles_;
    PlacementSurface surface_;
    Buffer<CloseRange> range_;
};

std::vector<float> random_areas(std::size_t count, uint seed) {
    Pcg32 random(seed);
    std::vector<float> areas(count);
    for (float& area : areas) {
        area = std::exp2(6.0f * random.uniform() - 3.0f);
    }
    return areas;
}

/// Pearson's statistic has mean n and variance 2n for n degrees of freedom (less where samples are
/// stratified).
void expect_chi_square(const std::vector<double>& counts, const std::vector<double>& expected) {
    double statistic = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        statistic += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    }
    const double freedom = static_cast<double>(counts.size()) - 1;
    EXPECT_LT(statistic, freedom + 5 * std::sqrt(2 * freedom));
}

void check_choice(Device& device, const Surface& surface, std::size_t samples_at_once, uint seeds) {
    Placer placer(device, surface);
    std::vector<double> counts(surface.areas.size());
    for (uint seed = 0; seed < seeds; ++seed) {
        for (const SurfaceSample& sample : placer.place(samples_at_once, seed)) {
            counts[sample.triangle] += 1;
        }
    }
    std::vector<double> expected(surface.areas.size());
    const double samples = static_cast<double>(samples_at_once) * seeds;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        expected[i] = samples * surface.areas[i] / surface.total();
    }
    expect_chi_square(counts, expected);
}

TEST_F(VplPlacementTest, TrianglesAreChosenInProportionToArea) {
    on_each_device([](Device& device) {
        const Surface surface(random_areas(100, 1));
        check_choice(device, surface, 1, 5000);
        check_choice(device, surface, 16, 1000);
        check_choice(device, surface, 20'000, 1);
    });
}

TEST_F(VplPlacementTest, PartsAreExactInUnitsOfArea) {
    on_each_device([](Device& device) {
        Placer placer(device, Surface({1, 1, 1, 1, 1, 1, 1}), 1);
        for (const uint seed : {1u, 2u, 3u}) {
            const std::vector<SurfaceSample> sevenths = placer.place(7, seed);
            for (uint k = 0; k < 7; ++k) {
                EXPECT_EQ(sevenths[k].triangle, k) << "each part is one triangle";
            }
            const std::vector<SurfaceSample> quarters = placer.place(4, seed);
            for (uint k = 0; k < 4; ++k) {
                EXPECT_GE(quarters[k].triangle, k * 7 / 4);
                EXPECT_LT(quarters[k].triangle, (k + 1) * 7 / 4);
            }
        }
    });
}

TEST_F(VplPlacementTest, EachPartOfTheAreaGetsExactlyOneSample) {
    on_each_device([](Device& device) {
        Surface surface(random_areas(5000, 2));
        std::reverse(surface.ids.begin(), surface.ids.end());
        Placer placer(device, surface);
        std::vector<double> ends(surface.areas.size());  // sums of areas, in the order of ids
        double sum = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            ends[i] = sum += surface.areas[surface.ids[i]];
        }
        for (const std::size_t count : {1u, 7u, 64u, 1000u, 4097u, 30'000u}) {
            const std::vector<SurfaceSample> samples = placer.place(count, 3);
            ASSERT_EQ(samples.size(), count);
            const double part = sum / static_cast<double>(count);
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t place = surface.ids.size() - 1 - samples[k].triangle;
                const double begin = place == 0 ? 0.0 : ends[place - 1];
                EXPECT_LT(begin, part * static_cast<double>(k + 1) + 1e-9 * sum);
                EXPECT_GT(ends[place], part * static_cast<double>(k) - 1e-9 * sum);
            }
        }
    });
}

TEST_F(VplPlacementTest, PointsAreUniformWithinATriangle) {
    on_each_device([](Device& device) {
        Placer placer(device, Surface({0.5f}));
        constexpr int kRows = 8;  // cells of a barycentric grid, congruent triangles
        const auto add = [](std::vector<double>& counts, const SurfaceSample& sample) {
            const float x = (sample.position.x - 1) * kRows;
            const float y = (sample.position.y - 2) * kRows;
            const int column = static_cast<int>(x);
            const int row = static_cast<int>(y);
            const bool upper = x - static_cast<float>(column) + y - static_cast<float>(row) > 1;
            counts.at(static_cast<std::size_t>((row * kRows + column) * 2 + upper)) += 1;
        };
        const auto check = [](std::vector<double> counts, double samples) {
            // Cells beyond the hypotenuse exist in the grid but not in the triangle.
            double in_triangle = 0;
            std::vector<double> kept;
            for (int row = 0; row < kRows; ++row) {
                for (int column = 0; column < kRows - row; ++column) {
                    for (int upper = 0; upper < (column + row == kRows - 1 ? 1 : 2); ++upper) {
                        kept.push_back(counts[static_cast<std::size_t>((row * kRows + column) * 2 + upper)]);
                        in_triangle += kept.back();
                    }
                }
            }
            EXPECT_EQ(kept.size(), std::size_t{kRows * kRows});
            EXPECT_GE(in_triangle, samples - 2) << "rounding may put a point just past the hypotenuse";
            expect_chi_square(kept, std::vector<double>(kept.size(), samples / (kRows * kRows)));
        };
        std::vector<double> at_once(kRows * kRows * 2);
        for (const SurfaceSample& sample : placer.place(10'000, 1)) {
            add(at_once, sample);
        }
        check(at_once, 10'000);
        std::vector<double> one_by_one(kRows * kRows * 2);
        for (uint seed = 0; seed < 5000; ++seed) {
            add(one_by_one, placer.place(1, seed)[0]);
        }
        check(one_by_one, 5000);
    });
}

TEST_F(VplPlacementTest, SamplesCarryWhatTheSurfaceHasThere) {
    on_each_device([](Device& device) {
        Surface surface({2.0f, 0.02f, 8.0f});
        std::swap(surface.triangles[1].v1, surface.triangles[1].v2);  // faces −Z
        for (const SurfaceSample& sample : Placer(device, surface).place(1000, 9)) {
            const float side = std::sqrt(2.0f * surface.areas[sample.triangle]);
            const Vec3 p = sample.position;
            EXPECT_GE(p.x, 1.0f);
            EXPECT_GE(p.y, 2.0f);
            EXPECT_LE(p.x - 1 + p.y - 2, side * 1.000001f + 1e-6f);
            EXPECT_EQ(p.z, 3.0f);
            const Triangle& triangle = surface.triangles[sample.triangle];
            const Vec3 corner = surface.vertices[triangle.v0].position;
            const Vec3 of_weights = corner + (surface.vertices[triangle.v1].position - corner) * sample.u +
                                    (surface.vertices[triangle.v2].position - corner) * sample.v;
            EXPECT_NEAR(length(of_weights - p), 0.0f, 1e-5f);
            EXPECT_NEAR(sample.normal.z, sample.triangle == 1 ? -1.0f : 1.0f, 1e-6f);
            EXPECT_NEAR(length(sample.normal), 1.0f, 1e-6f);
        }
    });
}

TEST_F(VplPlacementTest, HugeAndTinyTrianglesTogether) {
    on_each_device([](Device& device) {
        std::vector<float> areas(1001, 1e-6f);
        areas[500] = 1e6f;
        Surface surface(areas);
        Placer all(device, surface);
        EXPECT_NEAR(all.total_area(), surface.total(), 1e-9 * surface.total());
        std::size_t on_huge = 0;
        for (const SurfaceSample& sample : all.place(100'000, 4)) {
            on_huge += sample.triangle == 500;
        }
        EXPECT_GE(on_huge, 99'998u);  // the parts at both ends may meet a tiny one

        // Units that suit the whole scene still distinguish the tiny triangles.
        const float units = area_units_per_square_metre(surface.total());
        surface.ids = {3, 7, 900};
        surface.areas[7] = 3e-6f;
        Placer tiny(device, surface, units);
        EXPECT_NEAR(tiny.total_area(), 5e-6, 1e-11);
        std::vector<double> counts(3);
        for (const SurfaceSample& sample : tiny.place(5000, 4)) {
            counts[sample.triangle == 3 ? 0 : sample.triangle == 7 ? 1 : 2] += 1;
        }
        EXPECT_NEAR(counts[0], 1000, 1);
        EXPECT_NEAR(counts[1], 3000, 2);
        EXPECT_NEAR(counts[2], 1000, 1);
    });
}

TEST_F(VplPlacementTest, TrianglesWithoutAreaAreNeverChosen) {
    on_each_device([](Device& device) {
        std::vector<float> areas(300);
        for (std::size_t i = 0; i < areas.size(); ++i) {
            areas[i] = i % 3 == 1 ? 1.0f : 0.0f;  // the first and the last triangle have no area
        }
        Placer placer(device, Surface(areas));
        for (const std::size_t count : {1u, 100u, 5000u}) {
            for (const SurfaceSample& sample : placer.place(count, 8)) {
                EXPECT_EQ(sample.triangle % 3, 1u);
            }
        }
    });
}

TEST_F(VplPlacementTest, NothingToPlaceAndNowhereToPlaceIt) {
    on_each_device([](Device& device) {
        EXPECT_TRUE(Placer(device, Surface({1.0f})).place(0, 1).empty());
        EXPECT_THROW(Placer(device, Surface({0.0f, 0.0f})).place(10, 1), Error);
        Placer none(device, Surface(std::vector<float>{}));
        EXPECT_EQ(none.total_area(), 0.0);
        EXPECT_THROW(none.place(10, 1), Error);
    });
}

TEST_F(VplPlacementTest, SeedDecidesEverything) {
    on_each_device([](Device& device) {
        Placer placer(device, Surface(random_areas(100, 5)));
        const auto positions = [&](uint seed) {
            std::vector<float> xs;
            for (const SurfaceSample& sample : placer.place(500, seed)) {
                xs.push_back(sample.position.x);
            }
            return xs;
        };
        EXPECT_EQ(positions(1), positions(1));
        EXPECT_NE(positions(1), positions(2));
    });
}

TEST_F(VplPlacementTest, NoSampleIsWrittenBeyondTheLast) {
    on_each_device([](Device& device) {
        const Surface surface(random_areas(10, 6));
        VplPlacement placement(device);
        const PlacementSurface on_device =
            placement.surface_of(Buffer<float>(device, surface.areas), Buffer<uint>(device, surface.ids),
                                 surface.ids.size(), area_units_per_square_metre(surface.total()));
        SurfaceSample guard{};
        guard.triangle = 0xabadcafe;
        for (const std::size_t count : {1u, 7u, 8u, 9u, 63u, 65u, 1025u}) {
            Buffer<SurfaceSample> samples(device, std::vector<SurfaceSample>(count + 64, guard));
            placement.place(on_device, Buffer<Vertex>(device, surface.vertices),
                            Buffer<Triangle>(device, surface.triangles),
                            Buffer<CloseRange>(device, std::vector<CloseRange>(1)), true, count, 1, samples);
            const std::vector<SurfaceSample> result = samples.download();
            for (std::size_t i = 0; i < result.size(); ++i) {
                EXPECT_EQ(result[i].triangle == guard.triangle, i >= count) << i << " of " << count;
            }
        }
    });
}

TEST(AreaUnits, ArePowersOfTwoThatFit) {
    for (const double total : {1e-20, 1e-3, 1.0, 2.0, 3.7, 1e6, 1e18}) {
        const double units = area_units_per_square_metre(total);
        int exponent = 0;
        EXPECT_EQ(std::frexp(units, &exponent), 0.5) << total;
        EXPECT_LT(total * units, 0x1p62) << total;
        if (total > 1e-10) {
            EXPECT_GE(total * units, 0x1p61) << total;
        }
    }
    EXPECT_GT(area_units_per_square_metre(0.0), 0.0f);
}

/// Points on the parts of huge triangles lie between the planes of the close range, evenly.
TEST_F(VplPlacementTest, PartsOfTrianglesGetAllThePoints) {
    SceneCamera camera;
    camera.to_world = look_at({5, 0, 0}, {5, 0, 1}, {0, 1, 0});
    camera.fov_x_degrees = 90;
    const CloseRange region = make_close_range(make_camera(camera, 100, 100), 3.0f);
    on_each_device([&](Device& device) {
        std::vector<Vertex> corners;
        for (const Vec3 p : {Vec3{-85, -1, -90}, Vec3{95, -1, -90}, Vec3{5, -1, 180}}) {
            corners.push_back({.position = p, .u = 0, .normal = {}, .v = 0});
        }
        const Buffer<Vertex> vertices(device, corners);
        const Buffer<Triangle> triangles(device, std::vector<Triangle>{{0, 1, 2, 0}});
        const Buffer<CloseRange> range(device, std::span(&region, 1));
        VplPlacement placement(device);
        const PlacementSurface surface =
            placement.surface_of(Buffer<float>(device, std::vector<float>{8.0f}),
                                 Buffer<uint>(device, std::vector<uint>{0}), 1, 1024.0f);
        constexpr std::size_t kPlaced = 10'000;
        Buffer<SurfaceSample> samples(device, kPlaced);
        placement.place(surface, vertices, triangles, range, false, kPlaced, 5, samples);
        // The trapezium |x − 5| ≤ z, 1 ≤ z ≤ 3 has the area 8, of which 3 lies before z = 2.
        std::size_t near = 0;
        std::size_t left = 0;
        for (const SurfaceSample& sample : samples.download()) {
            ASSERT_NEAR(sample.position.y, -1, 1e-4);
            ASSERT_GT(sample.position.z, 0.998f);
            ASSERT_LT(sample.position.z, 3.002f);
            ASSERT_LT(std::abs(sample.position.x - 5), sample.position.z + 2e-3f);
            near += sample.position.z < 2 ? 1 : 0;
            left += sample.position.x < 5 ? 1 : 0;
        }
        EXPECT_NEAR(static_cast<double>(near), 3.0 / 8 * kPlaced, 100);
        EXPECT_NEAR(static_cast<double>(left), 0.5 * kPlaced, 100);
    });
}

}  // namespace
}  // namespace nearlight::core
