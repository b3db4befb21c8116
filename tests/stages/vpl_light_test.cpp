// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_light.h"

#include <cmath>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"

namespace nearlight::core {
namespace {

class VplLightTest : public test::DeviceTest {};

/// The octahedral map: (x, y) of the point of |x| + |y| + |z| = 1 in this direction, the lower half folded
/// out, in 16 bits each.
uint packed(Vec3 direction) {
    const Vec3 p = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    const float x = p.z < 0 ? std::copysign(1 - std::abs(p.y), p.x) : p.x;
    const float y = p.z < 0 ? std::copysign(1 - std::abs(p.x), p.y) : p.y;
    const auto bits = [](float value) { return static_cast<uint>(std::lround((value + 1) / 2 * 65535)); };
    return bits(x) | bits(y) << 16u;
}

/// A shading normal of its own for each VPL, on all sides.
Vec3 shading_normal(std::size_t index) {
    const auto i = static_cast<float>(index);
    return normalize(Vec3{std::sin(2 * i), std::sin(3 * i + 1), std::sin(5 * i + 2)});
}

std::vector<Vpl> random_vpls(std::size_t count) {
    Pcg32 random(8);
    const auto vector = [&] {
        const float x = random.uniform();
        const float y = random.uniform();
        return Vec3{x, y, random.uniform()};
    };
    std::vector<Vpl> vpls(count);
    for (std::size_t i = 0; i < count; ++i) {
        vpls[i] = {.position = vector(),
                   .depth = 2,
                   .normal = vector(),
                   .flags = NEARLIGHT_VPL_CLOSE | (i % 3 == 0 ? NEARLIGHT_VPL_MAPPED : 0) |
                            static_cast<uint>(i % 5) << NEARLIGHT_VPL_CURVE_SHIFT,
                   .power = vector(),
                   .shading = packed(shading_normal(i))};
    }
    return vpls;
}

/// Packets in which the irradiance of lane i is (i, 2i, 1).
std::vector<IrradiancePacket> ramp(std::size_t packets) {
    std::vector<IrradiancePacket> light(packets);
    for (std::size_t i = 0; i < packets * NEARLIGHT_PACKET_SIZE; ++i) {
        IrradiancePacket& packet = light[i / NEARLIGHT_PACKET_SIZE];
        packet.r[i % NEARLIGHT_PACKET_SIZE] = static_cast<float>(i);
        packet.g[i % NEARLIGHT_PACKET_SIZE] = 2 * static_cast<float>(i);
        packet.b[i % NEARLIGHT_PACKET_SIZE] = 1;
    }
    return light;
}

TEST_F(VplLightTest, ReceiversAreTheVplsThenNothing) {
    on_each_device([](Device& device) {
        for (const std::size_t count : {1, 63, 64, 65, 200}) {
            const std::vector<Vpl> vpls = random_vpls(count);
            const std::size_t packets = receiver_packet_count(count);
            ASSERT_EQ(packets, (count + 63) / 64);
            for (const VplSide side : {VplSide::emits, VplSide::receives}) {
                Buffer<ReceiverPacket> receivers(device, packets);
                VplLight(device).make_receivers(Buffer<Vpl>(device, vpls), count, side, receivers);
                const std::vector<ReceiverPacket> found = receivers.download();
                for (std::size_t i = 0; i < packets * NEARLIGHT_PACKET_SIZE; ++i) {
                    const auto [position, normal] = receiver_at(found, i);
                    EXPECT_EQ(position, i < count ? vpls[i].position : Vec3{});
                    if (i < count && side == VplSide::receives) {
                        EXPECT_LT(length(normal - shading_normal(i)), 1e-4f);
                    } else {
                        EXPECT_EQ(normal, i < count ? vpls[i].normal : Vec3{});
                    }
                    EXPECT_EQ(found[i / NEARLIGHT_PACKET_SIZE].surface[i % NEARLIGHT_PACKET_SIZE],
                              i < count ? i % 5 : 0);
                    const uint mesh_normal =
                        found[i / NEARLIGHT_PACKET_SIZE].mesh_normal[i % NEARLIGHT_PACKET_SIZE];
                    if (i < count && side == VplSide::receives && i % 3 == 0) {
                        const uint expected = packed(vpls[i].normal);
                        EXPECT_NEAR(mesh_normal & 0xffffu, expected & 0xffffu, 1.0);
                        EXPECT_NEAR(mesh_normal >> 16u, expected >> 16u, 1.0);
                    } else {
                        EXPECT_EQ(mesh_normal, 0u);
                    }
                }
            }
        }
    });
}

TEST_F(VplLightTest, PowerIsMultipliedByIrradianceOfTheLane) {
    on_each_device([](Device& device) {
        const std::vector<Vpl> vpls = random_vpls(100);
        Buffer<Vpl> buffer(device, vpls);
        VplLight(device).apply(Buffer<IrradiancePacket>(device, ramp(2)), 99, buffer);
        const std::vector<Vpl> found = buffer.download();
        for (std::size_t i = 0; i < 99; ++i) {
            const Vec3 irradiance{float(i), 2 * float(i), 1};
            EXPECT_EQ(found[i].power, vpls[i].power * irradiance);
            EXPECT_EQ(found[i].position, vpls[i].position);
        }
        EXPECT_EQ(found[99].power, vpls[99].power) << "beyond the last";
    });
}

TEST_F(VplLightTest, IrradianceAddsUp) {
    on_each_device([](Device& device) {
        Buffer<IrradiancePacket> sum(device, ramp(3));
        VplLight(device).add(Buffer<IrradiancePacket>(device, ramp(3)), 2, sum);
        const std::vector<IrradiancePacket> found = sum.download();
        EXPECT_EQ(found[1].r[5], 2 * 69.0f);
        EXPECT_EQ(found[1].g[5], 4 * 69.0f);
        EXPECT_EQ(found[0].b[63], 2.0f);
        EXPECT_EQ(found[2].b[0], 1.0f) << "beyond the last";
    });
}

}  // namespace
}  // namespace nearlight::core
