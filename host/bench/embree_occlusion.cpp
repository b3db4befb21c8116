// SPDX-License-Identifier: Apache-2.0
#include "host/bench/embree_occlusion.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <thread>
#include <vector>

#include "host/bench/embree_tree_pair.h"

namespace nearlight::core {
namespace {

/// VPLs whose rays are laid out at a time: with the 64 receivers of a packet 4096 rays at most, 200 kB.
constexpr std::size_t kBlockVpls = 64;

/// The rays of one packet and some VPLs.
struct Block {
    std::vector<RTCRay16> packets;
    std::vector<int> counts;  ///< rays in each of `packets`
    std::vector<RTCRay> singles;
    std::vector<std::size_t> pairs;  ///< of each ray: word of the mask · 64 + lane
};

RTCRay make_ray(const Vpl& vpl, const ReceiverPacket& packet, std::size_t lane) {
    RTCRay ray{};
    ray.org_x = vpl.position.x;
    ray.org_y = vpl.position.y;
    ray.org_z = vpl.position.z;
    ray.dir_x = packet.px[lane] - vpl.position.x;
    ray.dir_y = packet.py[lane] - vpl.position.y;
    ray.dir_z = packet.pz[lane] - vpl.position.z;
    ray.tnear = NEARLIGHT_SEGMENT_T_MIN;
    ray.tfar = NEARLIGHT_SEGMENT_T_MAX;
    ray.mask = ~0u;
    return ray;
}

void set_lane(RTCRay16& packet, int lane, const RTCRay& ray) {
    packet.org_x[lane] = ray.org_x;
    packet.org_y[lane] = ray.org_y;
    packet.org_z[lane] = ray.org_z;
    packet.dir_x[lane] = ray.dir_x;
    packet.dir_y[lane] = ray.dir_y;
    packet.dir_z[lane] = ray.dir_z;
    packet.tnear[lane] = ray.tnear;
    packet.tfar[lane] = ray.tfar;
    packet.time[lane] = 0.0f;
    packet.mask[lane] = ray.mask;
    packet.id[lane] = 0;
    packet.flags[lane] = 0;
}

void add_ray16(Block& block, int& lanes, const RTCRay& ray) {
    if (lanes == 16) {
        block.packets.emplace_back();
        block.counts.push_back(0);
        lanes = 0;
    }
    set_lane(block.packets.back(), lanes++, ray);
    block.counts.back() = lanes;
}

void add_rays(Block& block, const GatherSegments& segments, std::size_t packet, std::size_t vpl, int width) {
    const std::size_t word = segments.word(packet, vpl);
    int lanes = 16;  // used in the last of block.packets; a VPL begins a new one
    for (std::uint64_t rays = segments.rays[word]; rays != 0; rays &= rays - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rays));
        const RTCRay ray = make_ray(segments.vpls[vpl], segments.receivers[packet], lane);
        block.pairs.push_back(word * NEARLIGHT_PACKET_SIZE + lane);
        if (width == 1) {
            block.singles.push_back(ray);
        } else {
            add_ray16(block, lanes, ray);
        }
    }
}

void fill(Block& block, const GatherSegments& segments, std::size_t packet, std::size_t first_vpl,
          int width) {
    block.packets.clear();
    block.counts.clear();
    block.singles.clear();
    block.pairs.clear();
    const std::size_t end = std::min(segments.vpls.size(), first_vpl + kBlockVpls);
    for (std::size_t vpl = first_vpl; vpl < end; ++vpl) {
        add_rays(block, segments, packet, vpl, width);
    }
}

void trace_block(Block& block, RTCScene tree, EmbreeQuery& query) {
    alignas(64) int valid[32];
    for (int i = 0; i < 32; ++i) {
        valid[i] = i < 16 ? -1 : 0;
    }
    alignas(64) int partial[16];
    for (std::size_t i = 0; i < block.packets.size(); ++i) {
        const int* mask = valid;
        if (block.counts[i] < 16) {
            std::copy_n(valid + 16 - block.counts[i], 16, partial);
            mask = partial;
        }
        query.occluded(mask, tree, block.packets[i]);
    }
    for (RTCRay& ray : block.singles) {
        query.occluded(tree, ray);
    }
}

/// Sets the bits of the rays that are occluded. Words are never shared by blocks, so threads do not meet.
void keep(const Block& block, PairMask& occluded) {
    std::size_t ray = 0;
    const auto set = [&](bool hit) {
        const std::size_t pair = block.pairs[ray++];
        occluded[pair / NEARLIGHT_PACKET_SIZE] |= std::uint64_t{hit ? 1u : 0u}
                                                  << (pair % NEARLIGHT_PACKET_SIZE);
    };
    for (const RTCRay& single : block.singles) {
        set(single.tfar < 0.0f);
    }
    for (std::size_t i = 0; i < block.packets.size(); ++i) {
        for (int lane = 0; lane < block.counts[i]; ++lane) {
            set(block.packets[i].tfar[lane] < 0.0f);
        }
    }
}

}  // namespace

struct EmbreeOcclusion::State {
    State(const Scene& scene, std::span<const uint> ids) : trees(scene, ids) {}
    EmbreeTreePair trees;
};

EmbreeOcclusion::EmbreeOcclusion(const Scene& geometry) {
    std::vector<uint> ids(geometry.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    state_ = std::make_unique<State>(geometry, ids);
}
EmbreeOcclusion::~EmbreeOcclusion() = default;
EmbreeOcclusion::EmbreeOcclusion(EmbreeOcclusion&&) noexcept = default;
EmbreeOcclusion& EmbreeOcclusion::operator=(EmbreeOcclusion&&) noexcept = default;

OcclusionResult EmbreeOcclusion::trace(const GatherSegments& segments, const EmbreeMode& mode, int threads,
                                       bool keep_answers) const {
    RTCScene tree = state_->trees.tree(mode);
    std::vector<OcclusionResult> results(static_cast<std::size_t>(threads));
    PairMask answers(keep_answers ? segments.rays.size() : 0);
    std::atomic<std::size_t> next_packet = 0;
    const auto run = [&](OcclusionResult& result) {
        EmbreeQuery query(mode.coherent);
        Block block;
        for (std::size_t packet = next_packet++; packet < segments.receivers.size(); packet = next_packet++) {
            for (std::size_t vpl = 0; vpl < segments.vpls.size(); vpl += kBlockVpls) {
                fill(block, segments, packet, vpl, mode.width);
                const TwoClocks clocks(TwoClocks::Of::thread);
                trace_block(block, tree, query);
                const Seconds seconds = clocks.seconds();
                result.seconds.wall += seconds.wall;
                result.seconds.processor += seconds.processor;
                result.rays += block.pairs.size();
                if (keep_answers) {
                    keep(block, answers);
                }
            }
        }
    };
    std::vector<std::thread> workers;
    for (OcclusionResult& result : results) {
        workers.emplace_back(run, std::ref(result));
    }
    OcclusionResult sum;
    for (std::size_t i = 0; i < workers.size(); ++i) {
        workers[i].join();
        sum.seconds.wall += results[i].seconds.wall / threads;
        sum.seconds.processor += results[i].seconds.processor;
        sum.rays += results[i].rays;
    }
    sum.occluded = std::move(answers);
    return sum;
}

}  // namespace nearlight::core
