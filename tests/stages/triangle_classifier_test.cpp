// SPDX-License-Identifier: Apache-2.0
#include "host/stages/triangle_classifier.h"

#include <array>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/scene/pinhole_camera.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"

namespace nearlight {
namespace {

class TriangleClassifierTest : public test::DeviceTest {};

struct Corners {
    Vec3 a, b, c;
};

struct Result {
    std::vector<uint> flags;
    std::vector<float> areas;
};

Result classify(Device& device, const std::vector<Corners>& corners, const CloseRange& region,
                const Material& material = {}) {
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;
    for (const Corners& t : corners) {
        const uint first = static_cast<uint>(vertices.size());
        for (const Vec3 p : {t.a, t.b, t.c}) {
            vertices.push_back({.position = p, .u = 0, .normal = {}, .v = 0});
        }
        triangles.push_back({first, first + 1, first + 2, 0});
    }
    test::GuardedBuffer<uint> flags(device, corners.size());
    test::GuardedBuffer<float> areas(device, corners.size());
    TriangleClassifier(device).classify(Buffer<Vertex>(device, vertices), Buffer<Triangle>(device, triangles),
                                        Buffer<Material>(device, std::vector<Material>{material}),
                                        Buffer<CloseRange>(device, std::vector<CloseRange>{region}),
                                        corners.size(), flags.buffer(), areas.buffer());
    return {flags.download(), areas.download()};
}

/// At the origin, looking along +Z, 90° × 90°: inside where |x| ≤ z and |y| ≤ z.
CloseRange square_region(float range) {
    SceneCamera camera;
    camera.fov_x_degrees = 90;
    return make_close_range(make_pinhole_camera(camera, 100, 100), range);
}

TEST_F(TriangleClassifierTest, NearestPointInsideTheFrustumDecides) {
    on_each_device([](Device& device) {
        const std::vector<Corners> corners{
            {{-0.5f, 0, 2}, {0.5f, 0, 2}, {0, 0.5f, 2}},         // wholly inside
            {{-0.5f, 0, 4}, {0.5f, 0, 4}, {0, 0.5f, 4}},         // beyond the range
            {{-0.5f, 0, -2}, {0.5f, 0, -2}, {0, 0.5f, -2}},      // behind the camera
            {{5, 0, 2}, {6, 0, 2}, {5, 1, 2}},                   // beside the frustum
            {{-900, -1, -900}, {900, -1, -900}, {0, -1, 1800}},  // a floor; its centroid is inside, nearest
                                                                 // visible point at distance √2
            {{-100, -1, 0}, {0, -1, 0}, {-1, -1, 1e4f}},         // a floor whose centroid is far away
            {{-100, -100, 1}, {100, -100, 1}, {0, 200, 1}},      // covers the view: no corner is in it
            {{-100, -100, 3.5f}, {100, -100, 3.5f}, {0, 200, 3.5f}},  // the same beyond the range
            // Near the camera outside the frustum only; what is inside begins at distance 4·√2.
            {{1, -0.1f, 0}, {1, 0.1f, 0}, {5, 0, 5}},
            {{0, 0, 2.999f}, {0.1f, 0, 9}, {0, 0.1f, 9}},   // only its tip is near enough
            {{0, 0, 3.001f}, {0.1f, 0, 9}, {0, 0.1f, 9}},   // not even its tip
            {{0.1f, -1, -1}, {0.1f, 1, -1}, {0.1f, 0, 1}},  // crosses the camera's plane
        };
        const std::vector<uint> expected{1, 0, 0, 0, 1, 1, 1, 0, 0, 1, 0, 1};
        EXPECT_EQ(classify(device, corners, square_region(3.0f)).flags, expected);
    });
}

TEST_F(TriangleClassifierTest, AreaIsThatOfTheWholeTriangle) {
    on_each_device([](Device& device) {
        const Result result = classify(device,
                                       {{{0, 0, 2}, {3, 0, 2}, {0, 4, 2}},
                                        {{0, 0, 2}, {1e-3f, 0, 2}, {0, 1e-3f, 2}},
                                        {{0, 0, 2}, {1, 1, 2}, {2, 2, 2}},
                                        {{1, 2, 2}, {1, 2, 2}, {1, 2, 2}}},
                                       square_region(3.0f));
        EXPECT_FLOAT_EQ(result.areas[0], 6.0f);
        EXPECT_NEAR(result.areas[1], 0.5e-6f, 1e-12f);
        EXPECT_EQ(result.areas[2], 0.0f);
        EXPECT_EQ(result.areas[3], 0.0f);
        EXPECT_EQ(result.flags, (std::vector<uint>{1, 1, 0, 0}));
    });
}

TEST_F(TriangleClassifierTest, GlassIsLeftOut) {
    on_each_device([](Device& device) {
        const std::vector<Corners> corners{{{-0.5f, 0, 2}, {0.5f, 0, 2}, {0, 0.5f, 2}}};
        for (const uint lobe : {NEARLIGHT_LOBE_NONE, NEARLIGHT_LOBE_COAT, NEARLIGHT_LOBE_CONDUCTOR,
                                NEARLIGHT_LOBE_DIELECTRIC, NEARLIGHT_LOBE_THIN_DIELECTRIC}) {
            Material material{};
            material.lobe = lobe;
            const bool glass = lobe == NEARLIGHT_LOBE_DIELECTRIC || lobe == NEARLIGHT_LOBE_THIN_DIELECTRIC;
            EXPECT_EQ(classify(device, corners, square_region(3.0f), material).flags[0], glass ? 0u : 1u);
        }
    });
}

TEST_F(TriangleClassifierTest, NoTriangles) {
    on_each_device(
        [](Device& device) { EXPECT_TRUE(classify(device, {}, square_region(1.0f)).flags.empty()); });
}

// The oracle: the point of a triangle inside five half-spaces that is nearest to the camera, as a quadratic
// programme in the two barycentric weights, in double precision. The minimum lies inside, or on the line of
// some constraint.
struct Constraint {
    double a, b, c;  // a·u + b·v + c ≥ 0
};

using Double3 = std::array<double, 3>;
Double3 to_double(Vec3 v) {
    return {v.x, v.y, v.z};
}
Double3 minus(Double3 x, Double3 y) {
    return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
double dot3(Double3 x, Double3 y) {
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

bool satisfies(const std::vector<Constraint>& constraints, double u, double v, const Constraint* except) {
    return std::all_of(constraints.begin(), constraints.end(), [&](const Constraint& k) {
        return &k == except || k.a * u + k.b * v + k.c >= -1e-13;
    });
}

/// Squared distance of the nearest admissible point with the planes moved outwards by `slack`; none:
/// infinity.
double nearest_squared(const Corners& t, const CloseRange& region, double slack) {
    const Double3 origin = to_double(region.origin);
    const Double3 a = minus(to_double(t.a), origin);
    const Double3 e = minus(to_double(t.b), to_double(t.a));
    const Double3 f = minus(to_double(t.c), to_double(t.a));
    std::vector<Constraint> constraints{{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}};
    for (const auto& plane : region.planes) {
        const Double3 n{plane[0], plane[1], plane[2]};
        constraints.push_back({dot3(n, e), dot3(n, f), dot3(n, a) + slack});
    }
    const double ee = dot3(e, e), ef = dot3(e, f), ff = dot3(f, f), ae = dot3(a, e), af = dot3(a, f);
    const auto squared = [&](double u, double v) {
        return dot3(a, a) + u * u * ee + v * v * ff + 2 * (u * v * ef + u * ae + v * af);
    };
    double best = std::numeric_limits<double>::infinity();
    const double determinant = ee * ff - ef * ef;
    if (const double u = (ef * af - ff * ae) / determinant, v = (ef * ae - ee * af) / determinant;
        satisfies(constraints, u, v, nullptr)) {
        best = squared(u, v);
    }
    for (const Constraint& line : constraints) {
        const double norm = line.a * line.a + line.b * line.b;
        if (!(norm > 0)) {
            continue;
        }
        const double u0 = -line.a * line.c / norm, v0 = -line.b * line.c / norm;
        const double du = -line.b, dv = line.a;
        double low = -1e300, high = 1e300;
        for (const Constraint& k : constraints) {
            const double slope = k.a * du + k.b * dv;
            const double height = k.a * u0 + k.b * v0 + k.c;
            if (&k == &line) {
                continue;
            }
            if (std::abs(slope) < 1e-300) {
                high = height < 0 ? -2e300 : high;
            } else if (slope > 0) {
                low = std::max(low, -height / slope);
            } else {
                high = std::min(high, -height / slope);
            }
        }
        if (low <= high) {
            const double curvature = du * du * ee + dv * dv * ff + 2 * du * dv * ef;
            const double gradient =
                u0 * du * ee + v0 * dv * ff + (u0 * dv + v0 * du) * ef + du * ae + dv * af;
            const double s = std::clamp(curvature > 0 ? -gradient / curvature : low, low, high);
            best = std::min(best, squared(u0 + s * du, v0 + s * dv));
        }
    }
    return best;
}

TEST_F(TriangleClassifierTest, AgreesWithAQuadraticProgrammeOnRandomTriangles) {
    constexpr float kRange = 1.5f;
    SceneCamera camera;
    camera.to_world = look_at({0.3, -0.2, 0.5}, {-1, 0.4, 1.5}, {0.3, 1, 0.2});
    camera.fov_x_degrees = 55;
    const CloseRange region = make_close_range(make_pinhole_camera(camera, 320, 200), kRange);
    Pcg32 random(11);
    std::vector<Corners> corners(20'000);
    for (Corners& t : corners) {
        const auto point = [&](float size) {
            return Vec3{random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f} * size;
        };
        const Vec3 center = region.origin + point(4.0f);
        const float size = std::exp2(8.0f * random.uniform() - 5.0f);
        t = {center + point(size), center + point(size), center + point(size)};
    }
    on_each_device([&](Device& device) {
        const std::vector<uint> flags = classify(device, corners, region).flags;
        int selected = 0;
        int undecided = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            constexpr double kSlack = 5e-5;
            const bool surely = nearest_squared(corners[i], region, 0.0) < kRange * kRange;
            const bool perhaps =
                nearest_squared(corners[i], region, kSlack) < (kRange + kSlack) * (kRange + kSlack);
            EXPECT_TRUE(flags[i] || !surely) << "triangle " << i << " was left out";
            EXPECT_TRUE(!flags[i] || perhaps) << "triangle " << i << " does not reach into the close range";
            selected += static_cast<int>(flags[i]);
            undecided += perhaps && !surely;
        }
        EXPECT_GT(selected, 500);
        EXPECT_LT(selected, 19'000);
        EXPECT_LT(undecided, 20);
    });
}

TEST_F(TriangleClassifierTest, CentroidsOfSelectedTriangles) {
    on_each_device([](Device& device) {
        const std::vector<Vertex> vertices{
            {{0, 0, 0}, 0, {}, 0}, {{3, 0, 6}, 0, {}, 0}, {{0, 9, 0}, 0, {}, 0}, {{-3, 0, 0}, 0, {}, 0}};
        const std::vector<Triangle> triangles{{0, 1, 2, 0}, {0, 2, 3, 0}};
        Buffer<Vec3> centroids(device, 2);
        TriangleClassifier(device).centroids(Buffer<Vertex>(device, vertices),
                                             Buffer<Triangle>(device, triangles),
                                             Buffer<uint>(device, std::vector<uint>{1, 0}), 2, centroids);
        const std::vector<Vec3> result = centroids.download();
        EXPECT_NEAR(length(result[0] - Vec3{-1, 3, 0}), 0.0f, 1e-6f);
        EXPECT_NEAR(length(result[1] - Vec3{1, 3, 2}), 0.0f, 1e-6f);
    });
}

}  // namespace
}  // namespace nearlight
