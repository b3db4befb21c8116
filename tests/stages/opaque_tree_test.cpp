// SPDX-License-Identifier: Apache-2.0
#include "host/stages/opaque_tree.h"

#include <gtest/gtest.h>

#include <cstring>

#include "host/bvh/wide_bvh.h"
#include "host/stages/device_scene.h"
#include "host/stages/gatherer.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::test {
namespace {

class OpaqueTreeTest : public DeviceTest {
  protected:
    const GatherCase data_ = room_of_boxes(20, 10, 1, 1);
};

template <typename T>
bool holds(const Buffer<T>& buffer, const std::vector<T>& expected) {
    const std::vector<T> found = buffer.download();
    return found.size() == expected.size() &&
           std::memcmp(found.data(), expected.data(), found.size() * sizeof(T)) == 0;
}

TEST_F(OpaqueTreeTest, IsWidenedForPackets) {
    const WideBvh wide = widen(data_.bvh);
    on_each_device([&](Device& device) {
        const OpaqueTree tree = upload_tree(device, data_.bvh, GatherKernel::packets);
        EXPECT_TRUE(tree.is_wide());
        EXPECT_TRUE(holds(tree.nodes, data_.bvh.nodes));
        EXPECT_TRUE(holds(tree.triangles, data_.bvh.triangles));
        EXPECT_TRUE(holds(tree.wide_nodes, wide.nodes));
        EXPECT_TRUE(holds(tree.blocks, wide.blocks));
    });
}

TEST_F(OpaqueTreeTest, IsBinaryAloneForRays) {
    on_each_device([&](Device& device) {
        const OpaqueTree tree = upload_tree(device, data_.bvh, GatherKernel::rays);
        EXPECT_FALSE(tree.is_wide());
        EXPECT_EQ(tree.wide_nodes.count(), 0u);
        EXPECT_EQ(tree.blocks.count(), 0u);
        EXPECT_TRUE(holds(tree.nodes, data_.bvh.nodes));
        EXPECT_TRUE(holds(tree.triangles, data_.bvh.triangles));
    });
}

TEST_F(OpaqueTreeTest, TheDeviceDecidesWhereTheCallerDoesNot) {
    on_each_device([&](Device& device) {
        EXPECT_EQ(upload_tree(device, data_.bvh).is_wide(), device.is_cpu());
        EXPECT_EQ(Gatherer(device).kernel(), choose_kernel(GatherKernel::automatic, device));
        Scene scene = data_.scene;
        scene.materials.push_back(small_scenes::lambertian({0.5f, 0.5f, 0.5f}));
        const SceneBvhs bvhs = build_scene_bvhs(scene);
        EXPECT_EQ(upload_scene(device, scene, bvhs).tree.is_wide(), device.is_cpu());
        EXPECT_FALSE(upload_scene(device, scene, bvhs, GatherKernel::rays).tree.is_wide());
    });
}

TEST_F(OpaqueTreeTest, PacketsRefuseOneThatIsNotWide) {
    on_each_device([&](Device& device) {
        const OpaqueTree tree = upload_tree(device, data_.bvh, GatherKernel::rays);
        const Buffer<Vpl> vpls(device, data_.vpls);
        const Buffer<ReceiverPacket> receivers(device, data_.receivers);
        Buffer<IrradiancePacket> irradiance(device, data_.receivers.size());
        const GatherInput input{tree, vpls, vpls.count(), receivers, receivers.count(), data_.clamp_radius};
        EXPECT_THROW(Gatherer(device, {GatherKernel::packets}).gather(input, irradiance), Error);
        EXPECT_TRUE(Gatherer(device, {GatherKernel::rays}).gather(input, irradiance));
    });
}

}  // namespace
}  // namespace nearlight::test
