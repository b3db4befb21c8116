// SPDX-License-Identifier: Apache-2.0
// Host and device see the same structs: sizes and offsets as kernels/layout_probe.cl finds them.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "host/cl/kernel.h"
#include "kernels/shared/types.h"
#include "tests/support/device_fixture.h"

namespace nearlight {
namespace {

struct Fact {
    std::string name;
    std::size_t value;
};

#define SIZE(Type) \
    { #Type " size", sizeof(Type) }
#define OFFSET(Type, member) \
    { #Type "." #member, offsetof(Type, member) }

/// In the order of the probe.
std::vector<Fact> host_facts() {
    return {
        SIZE(BvhNode),
        OFFSET(BvhNode, left),
        OFFSET(BvhNode, right_max),
        SIZE(BvhTriangle),
        OFFSET(BvhTriangle, normal),
        SIZE(Vertex),
        OFFSET(Vertex, v),
        SIZE(Triangle),
        OFFSET(Triangle, material),
        SIZE(Material),
        OFFSET(Material, eta),
        OFFSET(Material, transmission),
        OFFSET(Material, base_saturation),
        SIZE(Texture),
        OFFSET(Texture, v_offset),
        OFFSET(Texture, color1),
        SIZE(Emitter),
        OFFSET(Emitter, radiance),
        OFFSET(Emitter, cutoff_angle),
        SIZE(Environment),
        OFFSET(Environment, scene_center),
        SIZE(PinholeCamera),
        OFFSET(PinholeCamera, step_y),
        SIZE(Vpl),
        OFFSET(Vpl, power),
        SIZE(SurfaceSample),
        OFFSET(SurfaceSample, v),
        SIZE(ReceiverPacket),
        OFFSET(ReceiverPacket, nz),
        SIZE(IrradiancePacket),
        OFFSET(IrradiancePacket, b),
        SIZE(CameraVertex),
        OFFSET(CameraVertex, emitted),
        SIZE(CloseRange),
        OFFSET(CloseRange, range),
        SIZE(SceneInfo),
        OFFSET(SceneInfo, extent),
    };
}

class LayoutTest : public test::DeviceTest {};

TEST_F(LayoutTest, DeviceAgreesWithHostOnEveryFact) {
    constexpr uint kUnwritten = 0xdeadbeef;
    const std::vector<Fact> facts = host_facts();
    on_each_device([&](Device& device) {
        Kernel probe(Program(device, "layout_probe.cl"), "layout_probe");
        Buffer<uint> out(device, std::vector<uint>(facts.size() + 64, kUnwritten));
        probe.launch(1, 1, out);
        const std::vector<uint> found = out.download();
        for (std::size_t i = 0; i < facts.size(); ++i) {
            EXPECT_EQ(found[i], facts[i].value) << facts[i].name;
        }
        EXPECT_EQ(found[facts.size()], kUnwritten) << "the probe knows more facts than this test";
    });
}

}  // namespace
}  // namespace nearlight
