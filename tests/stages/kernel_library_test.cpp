// SPDX-License-Identifier: Apache-2.0
// Functions of kernels/lib/ that several stages share, called on the device.
#include <array>
#include <cmath>
#include <set>

#include "host/base/math.h"
#include "host/base/packed_direction.h"
#include "host/base/random.h"
#include "host/image/color.h"
#include "host/scene/camera.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"

namespace nearlight::core {
namespace {

using test::KernelProbe;

class KernelLibraryTest : public test::DeviceTest {};

TEST_F(KernelLibraryTest, PointPredicateMeansSeenAndNearerThanRange) {
    SceneCamera camera;
    camera.to_world = look_at({3, -2, 5}, {-1, 4, 0.5}, {0.3, 1, 0.2});
    camera.fov_x_degrees = 71;
    constexpr float kNear = 0.8f;
    camera.near_clip = kNear;
    const Camera pinhole = make_camera(camera, 640, 200);
    constexpr float kRange = 2.5f;
    constexpr std::size_t kCount = 10'000;
    std::vector<Vec3> points(kCount);
    std::vector<uint> expected(kCount);
    Pcg32 random(5);
    for (std::size_t i = 0; i < kCount; ++i) {
        // Film positions and distances differ from the borders by more than rounding.
        const auto off_border = [&](bool& inside) {
            inside = random.uniform() < 0.8f;
            return inside ? 0.001f + 0.998f * random.uniform() : 1.001f + random.uniform();
        };
        std::array<bool, 3> inside{};
        const float x = off_border(inside[0]);
        const float y = off_border(inside[1]);
        const float distance = kRange * off_border(inside[2]);
        const Vec3 direction = pinhole.corner + pinhole.step_x * (x * 640) + pinhole.step_y * (y * 200);
        const Vec3 way = normalize(direction) * distance;
        const float depth = dot(way, pinhole.forward);
        // What would be too near to the plane goes behind the camera.
        const bool is_on_border = std::abs(depth - kNear) < 0.001f;
        points[i] = pinhole.origin + (is_on_border ? -way : way);
        expected[i] = inside[0] && inside[1] && inside[2] && depth > kNear && !is_on_border;
    }
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/close_range.cl\"\n"
                          "kernel void probe(const global CloseRange* region, const global Vec3* points,\n"
                          "                  global uint* flags) {\n"
                          "    const uint i = get_global_id(0);\n"
                          "    flags[i] = in_close_range(region, load3(points[i]));\n"
                          "}\n");
        const Buffer<CloseRange> region(probe.device(),
                                        std::vector<CloseRange>{make_close_range(pinhole, kRange)});
        Buffer<uint> flags(probe.device(), kCount);
        probe.kernel().launch(kCount, 8, region, Buffer<Vec3>(probe.device(), points), flags);
        EXPECT_EQ(flags.download(), expected);
    });
}

/// Unit vectors of all octants, along the axes, and next to the poles, where formulas for frames and
/// octahedra have their seams.
std::vector<Vec3> unit_vectors() {
    std::vector<Vec3> result{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const float z : {1.0f, -1.0f}) {
        result.push_back(normalize({1e-4f, -2e-4f, z}));
        result.push_back(normalize({-0.3f, 0.2f, 1e-6f * z}));
    }
    Pcg32 random(9);
    const auto signed_number = [&] { return 2.0f * random.uniform() - 1.0f; };
    while (result.size() < 1000) {
        const Vec3 v{signed_number(), signed_number(), signed_number()};
        if (length(v) > 0.1f) {
            result.push_back(normalize(v));
        }
    }
    return result;
}

TEST_F(KernelLibraryTest, FramesAreOrthonormalAndRightHanded) {
    const std::vector<Vec3> normals = unit_vectors();
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/math.cl\"\n"
                          "kernel void probe(const global Vec3* normals, global Vec3* axes) {\n"
                          "    const uint i = get_global_id(0);\n"
                          "    const Frame frame = make_frame(load3(normals[i]));\n"
                          "    axes[3 * i] = store3(frame_to_world(&frame, (float3)(1, 0, 0)));\n"
                          "    axes[3 * i + 1] = store3(frame.bitangent);\n"
                          "    axes[3 * i + 2] = store3(world_to_frame(&frame, load3(normals[i])));\n"
                          "}\n");
        Buffer<Vec3> axes(probe.device(), 3 * normals.size());
        probe.kernel().launch(normals.size(), 8, Buffer<Vec3>(probe.device(), normals), axes);
        const std::vector<Vec3> found = axes.download();
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const Vec3 n = normals[i];
            const Vec3 tangent = found[3 * i];
            SCOPED_TRACE(testing::Message() << "normal " << n.x << " " << n.y << " " << n.z);
            EXPECT_NEAR(dot(tangent, tangent), 1.0f, 1e-5f);
            EXPECT_NEAR(dot(tangent, n), 0.0f, 1e-5f);
            EXPECT_LT(length(cross(n, tangent) - found[3 * i + 1]), 1e-5f);
            EXPECT_LT(length(found[3 * i + 2] - Vec3{0, 0, 1}), 1e-5f);
        }
    });
}

TEST_F(KernelLibraryTest, PackedDirectionsComeBackAndAreThoseOfTheHost) {
    const std::vector<Vec3> directions = unit_vectors();
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/math.cl\"\n"
                          "kernel void probe(const global Vec3* directions, global uint* packed,\n"
                          "                  global Vec3* back) {\n"
                          "    const uint i = get_global_id(0);\n"
                          "    packed[i] = pack_direction(load3(directions[i]));\n"
                          "    back[i] = store3(unpack_direction(packed[i]));\n"
                          "}\n");
        Buffer<uint> packed(probe.device(), directions.size());
        Buffer<Vec3> back(probe.device(), directions.size());
        probe.kernel().launch(directions.size(), 8, Buffer<Vec3>(probe.device(), directions), packed, back);
        const std::vector<uint> codes = packed.download();
        const std::vector<Vec3> found = back.download();
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const Vec3 d = directions[i];
            SCOPED_TRACE(testing::Message() << "direction " << d.x << " " << d.y << " " << d.z);
            EXPECT_LT(length(found[i] - d), 1e-4f);
            EXPECT_LT(length(found[i] - unpack_direction(codes[i])), 1e-6f);
            // A number that lies between two codes may be rounded to either.
            const uint of_host = pack_direction(d);
            EXPECT_LE(std::abs(int(codes[i] & 0xffffu) - int(of_host & 0xffffu)), 1);
            EXPECT_LE(std::abs(int(codes[i] >> 16u) - int(of_host >> 16u)), 1);
        }
    });
}

TEST_F(KernelLibraryTest, SrgbTableIsThatOfTheHost) {
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/srgb_table.cl\"\n"
                          "kernel void probe(global float* linear) {\n"
                          "    linear[get_global_id(0)] = kSrgbToLinear[get_global_id(0)];\n"
                          "}\n");
        Buffer<float> linear(probe.device(), 256);
        probe.kernel().launch(256, 8, linear);
        const std::vector<float> found = linear.download();
        for (int code = 0; code < 256; ++code) {
            const float expected = srgb_to_linear(static_cast<float>(code) / 255.0f);
            EXPECT_NEAR(found[static_cast<std::size_t>(code)], expected, 1e-6f * expected) << code;
        }
    });
}

/// The hash pcg4d as in its paper [Jarzynski & Olano 2020].
std::array<uint, 4> pcg4d(std::array<uint, 4> v) {
    for (uint& x : v) {
        x = x * 1664525u + 1013904223u;
    }
    const auto mix = [&] {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
    };
    mix();
    for (uint& x : v) {
        x ^= x >> 16u;
    }
    mix();
    return v;
}

TEST_F(KernelLibraryTest, RandomWordsAreTheHashOfTheirKeyOnEveryDevice) {
    constexpr uint kCount = 4096;
    on_each_device([](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/random.cl\"\n"
                          "kernel void probe(global uint4* words) {\n"
                          "    const uint i = get_global_id(0);\n"
                          "    words[i] = random_uint4((uint4)(i, i / 7, ~i, 5));\n"
                          "}\n");
        Buffer<std::array<uint, 4>> words(probe.device(), kCount);
        probe.kernel().launch(kCount, 8, words);
        const std::vector<std::array<uint, 4>> found = words.download();
        for (uint i = 0; i < kCount; ++i) {
            EXPECT_EQ(found[i], pcg4d({i, i / 7, ~i, 5})) << "key " << i;
        }
    });
}

TEST_F(KernelLibraryTest, UnitFloatsStayBelowOne) {
    on_each_device([](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/random.cl\"\n"
                          "kernel void probe(global float* out) {\n"
                          "    out[0] = to_unit_float(0);\n"
                          "    out[1] = to_unit_float(1u << 31);\n"
                          "    out[2] = to_unit_float(~0u);\n"
                          "}\n");
        Buffer<float> out(probe.device(), 3);
        probe.kernel().launch(1, 1, out);
        EXPECT_EQ(out.download(), (std::vector<float>{0.0f, 0.5f, 1.0f - 0x1p-24f}));
    });
}

/// What is left of a random number after a decision decides further: it may not reach 1.
TEST_F(KernelLibraryTest, DecisionsLeaveNumbersBelowOne) {
    on_each_device([](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/bsdf/surface.cl\"\n"
                          "kernel void probe(global float* out) {\n"
                          "    const uint i = (uint)get_global_id(0);\n"
                          "    const float p = ((float)i + 0.37f) / 4097.0f;\n"
                          "    float below = 0.5f * p, above = 0.5f + 0.5f * p, high = 0x1.fffffep-1f;\n"
                          "    out[6 * i] = decide(&below, p);\n"
                          "    out[6 * i + 1] = decide(&above, p);\n"
                          "    out[6 * i + 2] = decide(&high, p);\n"
                          "    out[6 * i + 3] = below;\n"
                          "    out[6 * i + 4] = above;\n"
                          "    out[6 * i + 5] = high;\n"
                          "}\n");
        constexpr uint kCount = 4096;
        Buffer<float> out(probe.device(), 6 * kCount);
        probe.kernel().launch(kCount, 8, out);
        const std::vector<float> found = out.download();
        for (uint i = 1; i < kCount; ++i) {
            const float* const at = &found[std::size_t{6} * i];
            ASSERT_EQ(at[0], 1.0f) << i;
            ASSERT_EQ(at[1], 0.0f) << i;
            ASSERT_EQ(at[2], 0.0f) << i;
            ASSERT_NEAR(at[3], 0.5f, 1e-6f) << i;
            ASSERT_NEAR(at[4], 0.5f, 1e-3f) << i;
            ASSERT_LT(at[5], 1.0f) << i;
        }
    });
}

/// Every way to cut the unit square into 256 equal boxes of power-of-two sides gives each box one point.
void expect_net(const std::vector<std::array<float, 2>>& points) {
    for (uint columns = 1; columns <= 256; columns *= 2) {
        const uint rows = 256 / columns;
        std::set<uint> boxes;
        for (const auto& [x, y] : points) {
            ASSERT_GE(std::min(x, y), 0.0f);
            ASSERT_LT(std::max(x, y), 1.0f);
            boxes.insert(static_cast<uint>(x * static_cast<float>(columns)) * rows +
                         static_cast<uint>(y * static_cast<float>(rows)));
        }
        EXPECT_EQ(boxes.size(), 256u) << columns << " columns";
    }
}

TEST_F(KernelLibraryTest, AlignedRunsOfSamplesAreNets) {
    on_each_device([](Device& device) {
        KernelProbe probe(
            device,
            "#include \"lib/random.cl\"\n"
            "kernel void probe(global float2* points, uint first, uint dimension, uint seed) {\n"
            "    const uint i = get_global_id(0);\n"
            "    points[i] = sample_2d(first + i, dimension, seed);\n"
            "}\n");
        Buffer<std::array<float, 2>> points(probe.device(), 256);
        std::set<float> firsts;
        for (uint run = 0; run < 24; ++run) {
            probe.kernel().launch(256, 8, points, 256 * run, run / 2, run / 4);
            expect_net(points.download());
            firsts.insert(points.download_one(0)[0]);
        }
        EXPECT_GT(firsts.size(), 20u) << "runs, dimensions and seeds give the same points";
    });
}

}  // namespace
}  // namespace nearlight::core
