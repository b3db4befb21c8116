// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_light.h"

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"

namespace nearlight::core {
namespace {

class VplLightTest : public test::DeviceTest {};

std::vector<Vpl> random_vpls(std::size_t count) {
    Pcg32 random(8);
    const auto vector = [&] {
        const float x = random.uniform();
        const float y = random.uniform();
        return Vec3{x, y, random.uniform()};
    };
    std::vector<Vpl> vpls(count);
    for (Vpl& vpl : vpls) {
        vpl = {
            .position = vector(), .depth = 2, .normal = vector(), .flags = 1, .power = vector(), .pad0 = 0};
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
            Buffer<ReceiverPacket> receivers(device, packets);
            VplLight(device).make_receivers(Buffer<Vpl>(device, vpls), count, receivers);
            const std::vector<ReceiverPacket> found = receivers.download();
            for (std::size_t i = 0; i < packets * NEARLIGHT_PACKET_SIZE; ++i) {
                const auto [position, normal] = receiver_at(found, i);
                EXPECT_EQ(position, i < count ? vpls[i].position : Vec3{});
                EXPECT_EQ(normal, i < count ? vpls[i].normal : Vec3{});
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
