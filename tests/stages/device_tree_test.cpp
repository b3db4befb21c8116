// SPDX-License-Identifier: Apache-2.0
#include "host/stages/device_tree.h"

#include <gtest/gtest.h>

#include <cstring>

#include "host/bvh/wide_bvh.h"
#include "host/stages/device_scene.h"
#include "host/stages/gatherer.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

class DeviceTreeTest : public DeviceTest {
  protected:
    const GatherCase data_ = room_of_boxes(20, 10, 1, 1);
};

template <typename T>
bool holds(const Buffer<T>& buffer, const std::vector<T>& expected) {
    const std::vector<T> found = buffer.download();
    return found.size() == expected.size() &&
           (found.empty() || std::memcmp(found.data(), expected.data(), found.size() * sizeof(T)) == 0);
}

/// A tree that was not asked for is empty.
void expect_tree(const DeviceTree& tree, const Bvh& bvh, bool binary, bool wide) {
    const WideBvh widened = widen(bvh);
    EXPECT_EQ(tree.is_wide(), wide);
    EXPECT_TRUE(holds(tree.nodes, binary ? bvh.nodes : std::vector<BvhNode>{}));
    EXPECT_TRUE(holds(tree.triangles, binary ? bvh.triangles : std::vector<BvhTriangle>{}));
    EXPECT_TRUE(holds(tree.wide_nodes, wide ? widened.nodes : std::vector<WideNode>{}));
    EXPECT_TRUE(holds(tree.blocks, wide ? widened.blocks : std::vector<TriangleBlock>{}));
    EXPECT_TRUE(holds(tree.triangle_ids, tree.has_wide_rays ? widened.triangle_ids : bvh.triangle_ids));
}

TEST_F(DeviceTreeTest, HasTheShapesThatWereAskedFor) {
    on_each_ray_tree([&](Device& device) {
        const bool wide_rays = device.has_wide_rays();
        expect_tree(upload_ray_tree(device, data_.bvh), data_.bvh, !wide_rays, wide_rays);
        expect_tree(upload_tree(device, data_.bvh, GatherKernel::packets), data_.bvh, !wide_rays, true);
        expect_tree(upload_tree(device, data_.bvh, GatherKernel::rays), data_.bvh, true, wide_rays);
        expect_tree(upload_both_trees(device, data_.bvh), data_.bvh, true, true);
    });
}

TEST_F(DeviceTreeTest, TheDeviceDecidesWhereTheCallerDoesNot) {
    Scene scene = data_.scene;
    scene.materials.push_back(small_scenes::lambertian({0.5f, 0.5f, 0.5f}));
    const Bvh bvh = build_scene_bvh(scene);
    on_each_device([&](Device& device) {
        const bool cpu = device.is_cpu();
        EXPECT_EQ(device.has_wide_rays(), cpu);
        EXPECT_EQ(Gatherer(device).kernel(), choose_kernel(GatherKernel::automatic, device));
        expect_tree(upload_tree(device, data_.bvh), data_.bvh, !cpu, cpu);
        const DeviceScene on_device = upload_scene(device, scene, bvh);
        expect_tree(on_device.tree, bvh, !cpu, cpu);
        expect_tree(upload_scene(device, scene, bvh, GatherKernel::rays).tree, bvh, true, cpu);
        const ShapedBvh tree = build_scene_tree(scene, {}, tree_shapes(device, GatherKernel::automatic));
        expect_tree(upload_scene(device, scene, tree).tree, bvh, !cpu, cpu);
    });
}

TEST_F(DeviceTreeTest, KernelsRefuseOneOfTheOtherShape) {
    on_each_device([&](Device& device) {
        DeviceTree tree = upload_both_trees(device, data_.bvh);
        tree.wide_nodes = {};
        const Buffer<Vpl> vpls(device, data_.vpls);
        const Buffer<ReceiverPacket> receivers(device, data_.receivers);
        GatherSums<Vpl> sums(device, data_.receivers.size());
        const GatherInput<Vpl> input{
            tree, vpls, vpls.count(), receivers, receivers.count(), data_.clamp_radius};
        EXPECT_THROW(Gatherer(device, {GatherKernel::packets}).gather(input, sums), Error);
        EXPECT_TRUE(Gatherer(device, {GatherKernel::rays}).gather(input, sums));
        tree.nodes = {};
        EXPECT_THROW(Gatherer(device, {GatherKernel::rays}).gather(input, sums), Error);
    });
}

}  // namespace
}  // namespace nearlight::core::test
