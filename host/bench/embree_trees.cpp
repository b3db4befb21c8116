// SPDX-License-Identifier: Apache-2.0
#include "host/bench/embree_trees.h"

#include <algorithm>
#include <bit>
#include <new>
#include <string>

#include "host/bvh/flatten.h"
#include "host/bvh/reference.h"
#include "host/bvh/sah_builder.h"
#include "host/bvh/spatial_split.h"
#include "host/reference/embree.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

using EmbreeBvh = std::unique_ptr<std::remove_pointer_t<RTCBVH>, EmbreeRelease<rtcReleaseBVH>>;

constexpr float kEmbreeReplication = 1.2f;  // max_spatial_split_replications of Embree 3.13
/// Maximum depth for Embree, which falls back to halving near it, so that a tree may be a few levels deeper.
/// Our limit is therefore not reached.
constexpr unsigned kMaxTreeDepth = NEARLIGHT_MAX_BVH_DEPTH - 4;

EmbreeDevice new_device() {
    EmbreeDevice device(rtcNewDevice(nullptr));
    if (device == nullptr) {
        throw Error(ErrorKind::failure,
                    "Embree does not start: error " + std::to_string(rtcGetDeviceError(nullptr)));
    }
    return device;
}

void check(RTCDevice device, std::size_t triangles) {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        throw Error(ErrorKind::failure, "Embree could not build a tree over " + std::to_string(triangles) +
                                            " triangles: error " + std::to_string(error));
    }
}

RTCBuildQuality to_embree(EmbreeQuality quality) {
    return quality == EmbreeQuality::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
}

/// A node of the tree that Embree's builder makes: an inner node, or a leaf of up to four triangles.
struct Item {
    Item* children[2] = {nullptr, nullptr};
    RTCBounds boxes[2] = {};
    uint count = 0;  ///< number of triangles; 0: an inner node
    uint triangles[NEARLIGHT_LEAF_MAX_TRIANGLES] = {};
};

Item* new_item(RTCThreadLocalAllocator allocator) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(Item), alignof(Item))) Item;
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
    return new_item(allocator);
}
void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) {
        static_cast<Item*>(node)->children[i] = static_cast<Item*>(children[i]);
    }
}
void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) {
        static_cast<Item*>(node)->boxes[i] = *bounds[i];
    }
}
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                  void*) {
    Item* leaf = new_item(allocator);
    leaf->count = static_cast<uint>(count);
    for (size_t i = 0; i < count; ++i) {
        leaf->triangles[i] = primitives[i].primID;
    }
    return leaf;
}

RTCBounds to_bounds(const Box4& box) {
    return {box.low[0], box.low[1], box.low[2], 0.0f, box.high[0], box.high[1], box.high[2], 0.0f};
}

/// Cuts a triangle with our own splitter, which `user` points to, so that Embree's tree and ours cut
/// triangles alike.
void split_primitive(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left,
                     RTCBounds* right, void* user) {
    Reference reference{{{primitive->lower_x, primitive->lower_y, primitive->lower_z, 0.0f},
                         {primitive->upper_x, primitive->upper_y, primitive->upper_z, 0.0f}}};
    reference.set_id(primitive->primID);
    const auto cut =
        static_cast<const SpatialSplitter*>(user)->cut(reference, static_cast<int>(axis), position);
    *left = to_bounds(cut.left);
    *right = to_bounds(cut.right);
}

/// Copies Embree's tree into the arrays of our layout.
class Converter {
  public:
    explicit Converter(SahTree& tree) : tree_(tree) {}

    uint convert(const Item& item, int depth) {
        if (item.count > 0) {
            const auto first = static_cast<uint>(tree_.order.size());
            tree_.order.insert(tree_.order.end(), item.triangles, item.triangles + item.count);
            tree_.depth = std::max(tree_.depth, depth);
            return leaf_reference(first, item.count);
        }
        if (depth >= NEARLIGHT_MAX_BVH_DEPTH) {
            throw Error(ErrorKind::failure, "Embree's tree is too deep to be traced; use another scene");
        }
        const auto index = static_cast<uint>(tree_.slots.size());
        tree_.slots.emplace_back();
        ++tree_.inner_count;
        const uint left = convert(*item.children[0], depth + 1);
        const uint right = convert(*item.children[1], depth + 1);
        const auto low = [&](int i) {
            return Vec3{item.boxes[i].lower_x, item.boxes[i].lower_y, item.boxes[i].lower_z};
        };
        const auto high = [&](int i) {
            return Vec3{item.boxes[i].upper_x, item.boxes[i].upper_y, item.boxes[i].upper_z};
        };
        tree_.slots[index] = {low(0), left, high(0), right, low(1), 0, high(1), 0};
        return index;
    }

  private:
    SahTree& tree_;
};

RTCBuildArguments arguments_for(std::vector<RTCBuildPrimitive>& primitives, std::size_t count,
                                EmbreeQuality quality, const BvhConfig& config,
                                const SpatialSplitter& splitter) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = to_embree(quality);
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = kMaxTreeDepth;
    arguments.maxLeafSize = std::clamp<uint>(config.max_leaf_triangles, 1, NEARLIGHT_LEAF_MAX_TRIANGLES);
    arguments.traversalCost = config.traversal_cost;
    arguments.intersectionCost = config.intersection_cost;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = count;
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    arguments.splitPrimitive = quality == EmbreeQuality::high ? split_primitive : nullptr;
    arguments.userPtr = const_cast<SpatialSplitter*>(&splitter);
    return arguments;
}

}  // namespace

Seconds seconds_of_embree_build(const Scene& scene, std::span<const uint> ids, EmbreeQuality quality) {
    const EmbreeDevice device = new_device();
    const EmbreeTree tree(rtcNewScene(device.get()));
    rtcSetSceneBuildQuality(tree.get(), to_embree(quality));
    const EmbreeGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               scene.vertices.data(), offsetof(Vertex, position), sizeof(Vertex),
                               scene.vertices.size());
    auto* indices = static_cast<uint*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint), ids.size()));
    check(device.get(), ids.size());
    for (const uint id : ids) {
        const Triangle& triangle = scene.triangles[id];
        *indices++ = triangle.v0;
        *indices++ = triangle.v1;
        *indices++ = triangle.v2;
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(tree.get(), geometry.get());
    const TwoClocks clocks(TwoClocks::Of::process);
    rtcCommitScene(tree.get());
    const Seconds seconds = clocks.seconds();
    check(device.get(), ids.size());
    return seconds;
}

Bvh build_embree_bvh(const Scene& scene, std::span<const uint> ids, EmbreeQuality quality,
                     const BvhConfig& config) {
    if (ids.empty()) {
        return empty_bvh();
    }
    const float room = quality == EmbreeQuality::high ? kEmbreeReplication : 1.0f;
    std::vector<RTCBuildPrimitive> primitives(
        static_cast<std::size_t>(static_cast<double>(ids.size()) * static_cast<double>(room)));
    Box4 box = Box4::empty();
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const Reference r = make_reference(scene, ids[i]);
        box.extend(r);
        primitives[i] = {r.low[0], r.low[1], r.low[2], 0, r.high[0], r.high[1], r.high[2], ids[i]};
    }
    const SpatialSplitter splitter(scene, box);
    const EmbreeDevice device = new_device();
    const EmbreeBvh bvh(rtcNewBVH(device.get()));
    RTCBuildArguments arguments = arguments_for(primitives, ids.size(), quality, config, splitter);
    arguments.bvh = bvh.get();
    const auto* root = static_cast<const Item*>(rtcBuildBVH(&arguments));
    check(device.get(), ids.size());
    SahTree tree;
    tree.root_box = {box.min(), box.max()};
    tree.root = Converter(tree).convert(*root, 0);
    return flatten(std::move(tree), scene, config);
}

}  // namespace nearlight::core
