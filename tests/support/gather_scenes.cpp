// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gather_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "host/base/packed_direction.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/base/seen_normal.h"

namespace nearlight::core::test {
namespace {

using MakePoint = std::function<ReceiverPoint()>;

float symmetric(Pcg32& random) {
    return 2.0f * random.uniform() - 1.0f;
}

Vec3 point_in_cube(Pcg32& random) {
    const float x = symmetric(random);
    const float y = symmetric(random);
    return {x, y, symmetric(random)};
}

Vec3 any_direction(Pcg32& random) {
    for (;;) {
        const Vec3 v = point_in_cube(random);
        if (const float l = length(v); l > 0.1f && l < 1.0f) {
            return v / l;
        }
    }
}

void add_triangle(Scene& scene, Vec3 a, Vec3 b, Vec3 c) {
    const auto first = static_cast<uint>(scene.vertices.size());
    for (const Vec3 p : {a, b, c}) {
        Vertex vertex{};
        vertex.position = p;
        scene.vertices.push_back(vertex);
    }
    scene.triangles.push_back({first, first + 1, first + 2, 0});
}

/// The six faces of a box, as two triangles each.
void add_box(Scene& scene, Vec3 low, Vec3 high) {
    const auto corner = [&](int i) {
        return Vec3{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                    (i & 4) != 0 ? high.z : low.z};
    };
    for (const auto& [a, b, c, d] :
         {std::array{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
        add_triangle(scene, corner(a), corner(b), corner(c));
        add_triangle(scene, corner(a), corner(c), corner(d));
    }
}

void finish(GatherCase& data, std::size_t vpls, std::size_t packets, Pcg32& random,
            const MakePoint& make_point) {
    std::vector<uint> ids(data.scene.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    data.bvh = build_bvh(data.scene, ids);
    for (std::size_t i = 0; i < vpls; ++i) {
        const ReceiverPoint point = make_point();
        const float power = random.uniform();
        data.vpls.push_back({point.position, 1, point.normal, 0, {power, 0.5f * power, 1.0f - power}, 0});
        if (i % 3 == 0) {
            data.vpls.back().flags = NEARLIGHT_VPL_TILTED;
            data.vpls.back().shading = pack_direction(normalize(point.normal + 0.8f * any_direction(random)));
        }
    }
    for (std::size_t p = 0; p < packets; ++p) {
        ReceiverPacket& packet = data.receivers.emplace_back();
        for (std::size_t i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            set_receiver(packet, i, make_point());
        }
    }
}

}  // namespace

GatherCase random_triangles(std::size_t triangles, std::size_t vpls, std::size_t packets,
                            std::uint64_t seed) {
    Pcg32 random(seed);
    GatherCase data;
    data.name = std::to_string(triangles) + " random triangles, " + std::to_string(vpls) + " VPLs";
    for (std::size_t i = 0; i < triangles; ++i) {
        const Vec3 a = point_in_cube(random);
        const Vec3 b = a + 0.2f * point_in_cube(random);
        add_triangle(data.scene, a, b, a + 0.2f * point_in_cube(random));
    }
    finish(data, vpls, packets, random, [&] {
        const Vec3 position = point_in_cube(random);
        return ReceiverPoint{position, any_direction(random)};
    });
    return data;
}

GatherCase room_of_boxes(std::size_t boxes, std::size_t vpls, std::size_t packets, std::uint64_t seed) {
    Pcg32 random(seed);
    GatherCase data;
    data.name = "room of " + std::to_string(boxes) + " boxes";
    add_box(data.scene, {-1, -1, -1}, {1, 1, 1});
    for (std::size_t i = 0; i < boxes; ++i) {
        const Vec3 low = 0.8f * point_in_cube(random);
        // Every fourth box is flat: a sheet in an axis-aligned plane.
        const float height = i % 4 == 0 ? 0.0f : 0.2f * random.uniform();
        const float width = 0.02f + 0.15f * random.uniform();
        add_box(data.scene, low, low + Vec3{width, height, 0.02f + 0.15f * random.uniform()});
    }
    finish(data, vpls, packets, random, [&] {
        // The point is where a random ray hits a surface.
        for (;;) {
            const Vec3 origin = 0.95f * point_in_cube(random);
            const Vec3 direction = any_direction(random);
            const BvhHit hit = closest_hit(data.bvh, origin, direction, 0.0f, 10.0f);
            if (hit.triangle == ~0u) {
                continue;
            }
            const Triangle& triangle = data.scene.triangles[hit.triangle];
            const Vec3 v0 = data.scene.vertices[triangle.v0].position;
            const Vec3 normal = normalize(cross(data.scene.vertices[triangle.v1].position - v0,
                                                data.scene.vertices[triangle.v2].position - v0));
            const Vec3 facing = dot(normal, direction) < 0.0f ? normal : -normal;
            return ReceiverPoint{origin + direction * hit.t + facing * 1e-4f, facing};
        }
    });
    return data;
}

GatherCase points_on_grid(std::size_t vpls, std::size_t packets, std::uint64_t seed) {
    Pcg32 random(seed);
    GatherCase data;
    data.name = "points on a grid";
    const auto grid_point = [&random] {
        const auto cell = [&random] { return 0.25f * static_cast<float>(random.next() % 9u) - 1.0f; };
        const float x = cell();
        const float y = cell();
        return Vec3{x, y, cell()};
    };
    for (int i = 0; i < 100; ++i) {
        const Vec3 a = grid_point();
        const Vec3 b = grid_point();
        add_triangle(data.scene, a, b, grid_point());
    }
    finish(data, vpls, packets, random, [&] {
        const Vec3 position = grid_point();
        return ReceiverPoint{position, any_direction(random)};
    });
    return data;
}

GatherCase needles(std::size_t triangles, std::size_t vpls, std::size_t packets, std::uint64_t seed) {
    Pcg32 random(seed);
    GatherCase data;
    data.name = "needles";
    for (std::size_t i = 0; i < triangles; ++i) {
        const Vec3 a = point_in_cube(random);
        const Vec3 b = point_in_cube(random);
        const Vec3 middle = (a + b) * 0.5f;
        switch (i % 4) {
            case 0:
                add_triangle(data.scene, a, a, a);
                break;
            case 1:
                add_triangle(data.scene, a, middle, b);
                break;
            default:
                add_triangle(data.scene, a, b, middle + 0.01f * point_in_cube(random));
        }
    }
    finish(data, vpls, packets, random, [&] {
        const Vec3 position = point_in_cube(random);
        return ReceiverPoint{position, any_direction(random)};
    });
    return data;
}

GatherCase sheet_above_receivers(float gap, float distance, std::size_t vpls, std::size_t packets) {
    Pcg32 random(18);
    GatherCase data;
    data.name = "sheet above receivers";
    data.extent = 2 * distance;
    add_triangle(data.scene, {-9, -9, gap}, {9, -9, gap}, {9, 9, gap});
    add_triangle(data.scene, {-9, -9, gap}, {9, 9, gap}, {-9, 9, gap});
    std::size_t made = 0;
    finish(data, vpls, packets, random, [&] {
        const bool is_vpl = made++ < vpls;
        const Vec3 place{symmetric(random), symmetric(random), is_vpl ? distance : 0.0f};
        return ReceiverPoint{place, {0, 0, is_vpl ? -1.0f : 1.0f}};
    });
    return data;
}

PairTerm pair_term(const Vpl& vpl, const ReceiverPoint& receiver, float clamp_radius) {
    const auto dot64 = [](Vec3 a, Vec3 b) {
        return static_cast<double>(a.x) * b.x + static_cast<double>(a.y) * b.y +
               static_cast<double>(a.z) * b.z;
    };
    const Vec3 segment = receiver.position - vpl.position;
    const double r2 = dot64(segment, segment);
    if (!(r2 > 0.0)) {
        return {};
    }
    const double cos_vpl = dot64(vpl.normal, segment) / std::sqrt(r2);
    const double cos_seen = dot64(seen_normal(vpl), segment) / std::sqrt(r2);
    const double cos_receiver = -dot64(receiver.normal, segment) / std::sqrt(r2);
    PairTerm term;
    term.min_cosine = std::min({std::abs(cos_vpl), std::abs(cos_seen), std::abs(cos_receiver)});
    if (cos_vpl > 0.0 && cos_seen > 0.0 && cos_receiver > 0.0) {
        term.value = cos_vpl * cos_receiver / std::max(r2, static_cast<double>(clamp_radius) * clamp_radius);
    }
    return term;
}

}  // namespace nearlight::core::test
