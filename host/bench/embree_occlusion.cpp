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

/// Number of VPLs whose rays are laid out at a time: with the 64 receivers of a packet at most 4096 rays, or
/// 200 kB.
constexpr std::size_t kVplsAtOnce = 64;

/// The rays between one packet and some VPLs, laid out for Embree.
struct RaysAtOnce {
    std::vector<RTCRay16> sixteens;
    std::vector<int> counts;  ///< number of rays in each of `sixteens`
    std::vector<RTCRay> singles;
    std::vector<std::size_t> pairs;  ///< place of each ray in the mask: word · 64 + lane
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

void add_ray16(RaysAtOnce& rays_at_once, int& lanes, const RTCRay& ray) {
    if (lanes == 16) {
        rays_at_once.sixteens.emplace_back();
        rays_at_once.counts.push_back(0);
        lanes = 0;
    }
    set_lane(rays_at_once.sixteens.back(), lanes++, ray);
    rays_at_once.counts.back() = lanes;
}

void add_rays(RaysAtOnce& rays_at_once, const GatherSegments& segments, std::size_t packet, std::size_t vpl,
              int width) {
    const std::size_t word = segments.word(packet, vpl);
    int lanes = 16;  // in use in the last of rays_at_once.sixteens; each VPL begins a new one
    for (std::uint64_t rays = segments.rays[word]; rays != 0; rays &= rays - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rays));
        const RTCRay ray = make_ray(segments.vpls[vpl], segments.receivers[packet], lane);
        rays_at_once.pairs.push_back(word * NEARLIGHT_PACKET_SIZE + lane);
        if (width == 1) {
            rays_at_once.singles.push_back(ray);
        } else {
            add_ray16(rays_at_once, lanes, ray);
        }
    }
}

void fill(RaysAtOnce& rays_at_once, const GatherSegments& segments, std::size_t packet, std::size_t first_vpl,
          int width) {
    rays_at_once.sixteens.clear();
    rays_at_once.counts.clear();
    rays_at_once.singles.clear();
    rays_at_once.pairs.clear();
    const std::size_t end = std::min(segments.vpls.size(), first_vpl + kVplsAtOnce);
    for (std::size_t vpl = first_vpl; vpl < end; ++vpl) {
        add_rays(rays_at_once, segments, packet, vpl, width);
    }
}

void trace_rays(RaysAtOnce& rays_at_once, RTCScene tree, EmbreeQuery& query) {
    alignas(64) int valid[32];
    for (int i = 0; i < 32; ++i) {
        valid[i] = i < 16 ? -1 : 0;
    }
    alignas(64) int partial[16];
    for (std::size_t i = 0; i < rays_at_once.sixteens.size(); ++i) {
        const int* mask = valid;
        if (rays_at_once.counts[i] < 16) {
            std::copy_n(valid + 16 - rays_at_once.counts[i], 16, partial);
            mask = partial;
        }
        query.occluded(mask, tree, rays_at_once.sixteens[i]);
    }
    for (RTCRay& ray : rays_at_once.singles) {
        query.occluded(tree, ray);
    }
}

/// Sets the bits of the rays that are occluded. Each word of the mask belongs to one packet and one VPL, so
/// no two threads write to the same word.
void keep(const RaysAtOnce& rays_at_once, PairMask& occluded) {
    std::size_t ray = 0;
    const auto set = [&](bool hit) {
        const std::size_t pair = rays_at_once.pairs[ray++];
        occluded[pair / NEARLIGHT_PACKET_SIZE] |= std::uint64_t{hit ? 1u : 0u}
                                                  << (pair % NEARLIGHT_PACKET_SIZE);
    };
    for (const RTCRay& single : rays_at_once.singles) {
        set(single.tfar < 0.0f);
    }
    for (std::size_t i = 0; i < rays_at_once.sixteens.size(); ++i) {
        for (int lane = 0; lane < rays_at_once.counts[i]; ++lane) {
            set(rays_at_once.sixteens[i].tfar[lane] < 0.0f);
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
        RaysAtOnce rays_at_once;
        for (std::size_t packet = next_packet++; packet < segments.receivers.size(); packet = next_packet++) {
            for (std::size_t vpl = 0; vpl < segments.vpls.size(); vpl += kVplsAtOnce) {
                fill(rays_at_once, segments, packet, vpl, mode.width);
                const TwoClocks clocks(TwoClocks::Of::thread);
                trace_rays(rays_at_once, tree, query);
                const Seconds seconds = clocks.seconds();
                result.seconds.wall += seconds.wall;
                result.seconds.processor += seconds.processor;
                result.rays += rays_at_once.pairs.size();
                if (keep_answers) {
                    keep(rays_at_once, answers);
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
