// SPDX-License-Identifier: Apache-2.0
#include "host/bench/tree_steps.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <thread>
#include <vector>

#include "host/base/math.h"
#include "host/bvh/ray_tests.h"
#include "host/bvh/sah_builder.h"

namespace nearlight::core {
namespace {

struct Counts {
    std::uint64_t rays = 0;
    std::uint64_t occluded = 0;
    std::uint64_t nodes = 0;
    std::uint64_t triangles = 0;
    std::uint64_t packets = 0;
    std::uint64_t packet_nodes = 0;
    std::uint64_t packet_triangles = 0;

    void add(const Counts& other) {
        rays += other.rays;
        occluded += other.occluded;
        nodes += other.nodes;
        triangles += other.triangles;
        packets += other.packets;
        packet_nodes += other.packet_nodes;
        packet_triangles += other.packet_triangles;
    }
};

bool meets(const BvhTriangle& triangle, const TestRay& segment) {
    BvhHit hit;
    hit.t = NEARLIGHT_SEGMENT_T_MAX;
    return intersect(triangle, segment, hit);
}

float enter(const TestRay& segment, Vec3 low, Vec3 high) {
    return enter_box(segment, NEARLIGHT_SEGMENT_T_MAX, low, high);
}

/// Counts the steps of one ray that visits the nearer child first.
void count_ray(const Bvh& bvh, const TestRay& segment, Counts& counts) {
    std::array<uint, NEARLIGHT_MAX_BVH_DEPTH + 1> stack;
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
        uint child = stack[--top];
        while (!is_leaf(child)) {
            ++counts.nodes;
            const BvhNode& node = bvh.nodes[child];
            const float left = enter(segment, node.left_min, node.left_max);
            const float right = enter(segment, node.right_min, node.right_max);
            if (left == kInfinity && right == kInfinity) {
                break;
            }
            if (left != kInfinity && right != kInfinity) {
                stack[top++] = left <= right ? node.right : node.left;
            }
            child = left <= right ? node.left : node.right;
        }
        if (!is_leaf(child)) {
            continue;
        }
        for (uint i = leaf_first(child); i < leaf_first(child) + leaf_count(child); ++i) {
            ++counts.triangles;
            if (meets(bvh.triangles[i], segment)) {
                ++counts.occluded;
                return;
            }
        }
    }
}

/// The rays between one VPL and one packet of receivers, which go through the tree together.
class Packet {
  public:
    void add(const TestRay& segment) { segments_[count_++] = segment; }
    [[nodiscard]] std::span<const TestRay> segments() const { return {segments_.data(), count_}; }

    void count(const Bvh& bvh, Counts& counts) const {
        struct Entry {
            uint child;
            std::uint64_t lanes;
        };
        std::array<Entry, NEARLIGHT_MAX_BVH_DEPTH + 1> stack;
        std::size_t top = 0;
        std::uint64_t active = count_ == 64 ? ~0ull : (1ull << count_) - 1;
        stack[top++] = {0, active};
        while (top > 0) {
            const Entry entry = stack[--top];
            const std::uint64_t lanes = entry.lanes & active;
            if (lanes == 0) {
                continue;
            }
            if (is_leaf(entry.child)) {
                count_leaf(bvh, entry.child, lanes, active, counts);
                continue;
            }
            ++counts.packet_nodes;
            const BvhNode& node = bvh.nodes[entry.child];
            const std::uint64_t right = lanes_in_box(lanes, node.right_min, node.right_max);
            const std::uint64_t left = lanes_in_box(lanes, node.left_min, node.left_max);
            if (right != 0) {
                stack[top++] = {node.right, right};
            }
            if (left != 0) {
                stack[top++] = {node.left, left};
            }
        }
    }

  private:
    [[nodiscard]] std::uint64_t lanes_in_box(std::uint64_t lanes, Vec3 low, Vec3 high) const {
        std::uint64_t result = 0;
        for (std::uint64_t rest = lanes; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            result |= enter(segments_[lane], low, high) != kInfinity ? 1ull << lane : 0;
        }
        return result;
    }

    void count_leaf(const Bvh& bvh, uint leaf, std::uint64_t lanes, std::uint64_t& active,
                    Counts& counts) const {
        for (uint i = leaf_first(leaf); i < leaf_first(leaf) + leaf_count(leaf) && lanes != 0; ++i) {
            ++counts.packet_triangles;
            for (std::uint64_t rest = lanes; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                if (meets(bvh.triangles[i], segments_[lane])) {
                    active &= ~(1ull << lane);
                    lanes &= ~(1ull << lane);
                }
            }
        }
    }

    std::array<TestRay, NEARLIGHT_PACKET_SIZE> segments_;
    std::size_t count_ = 0;
};

Packet make_packet(const Vpl& vpl, const ReceiverPacket& receivers) {
    Packet packet;
    for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
        const Vec3 position{receivers.px[i], receivers.py[i], receivers.pz[i]};
        const Vec3 normal{receivers.nx[i], receivers.ny[i], receivers.nz[i]};
        const Vec3 d = position - vpl.position;
        if (dot(d, vpl.normal) > 0.0f && dot(d, normal) < 0.0f) {
            packet.add(make_test_ray(vpl.position, d, NEARLIGHT_SEGMENT_T_MIN));
        }
    }
    return packet;
}

Counts count_receivers(const Bvh& bvh, std::span<const Vpl> vpls, const ReceiverPacket& receivers) {
    Counts counts;
    for (const Vpl& vpl : vpls) {
        const Packet packet = make_packet(vpl, receivers);
        if (packet.segments().empty()) {
            continue;
        }
        ++counts.packets;
        counts.rays += packet.segments().size();
        packet.count(bvh, counts);
        for (const TestRay& segment : packet.segments()) {
            count_ray(bvh, segment, counts);
        }
    }
    return counts;
}

double per(std::uint64_t steps, std::uint64_t many) {
    return static_cast<double>(steps) / std::max(1.0, static_cast<double>(many));
}

}  // namespace

TreeSteps count_steps(const Bvh& bvh, std::span<const Vpl> vpls, std::span<const ReceiverPacket> receivers,
                      int threads) {
    std::vector<Counts> parts(static_cast<std::size_t>(std::max(1, threads)));
    std::atomic<std::size_t> next = 0;
    std::vector<std::thread> workers;
    for (Counts& part : parts) {
        workers.emplace_back([&] {
            for (std::size_t i = next++; i < receivers.size(); i = next++) {
                part.add(count_receivers(bvh, vpls, receivers[i]));
            }
        });
    }
    Counts sum;
    for (std::size_t i = 0; i < workers.size(); ++i) {
        workers[i].join();
        sum.add(parts[i]);
    }
    return {sum.rays,
            sum.occluded,
            per(sum.nodes, sum.rays),
            per(sum.triangles, sum.rays),
            sum.packets,
            per(sum.packet_nodes, sum.packets),
            per(sum.packet_triangles, sum.packets)};
}

}  // namespace nearlight::core
