// SPDX-License-Identifier: Apache-2.0
#include "host/bench/embree_occlusion.h"

#include <embree3/rtcore.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <type_traits>

#include "host/base/error.h"
#include "host/reference/embree_handles.h"

namespace nearlight {
namespace {

EmbreeTree build_tree(RTCDevice device, const Scene& scene, std::span<const uint> ids,
                      RTCBuildQuality quality) {
    EmbreeTree tree(rtcNewScene(device));
    rtcSetSceneBuildQuality(tree.get(), quality);
    const EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* positions = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), scene.vertices.size()));
    auto* indices = static_cast<uint*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint), ids.size()));
    if (positions == nullptr || indices == nullptr) {
        throw Error(ExitCode::out_of_memory, "Embree has no memory for " + std::to_string(ids.size()) +
                                                 " triangles; use a smaller scene");
    }
    for (const Vertex& vertex : scene.vertices) {
        *positions++ = vertex.position;
    }
    for (const uint id : ids) {
        const Triangle& triangle = scene.triangles[id];
        *indices++ = triangle.v0;
        *indices++ = triangle.v1;
        *indices++ = triangle.v2;
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(tree.get(), geometry.get());
    rtcCommitScene(tree.get());
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        throw Error(ExitCode::runtime, "Embree could not build a tree over " + std::to_string(ids.size()) +
                                           " triangles: error " + std::to_string(error));
    }
    return tree;
}

/// VPLs whose rays are laid out at a time: with the 64 receivers of a packet 4096 rays at most, 200 kB.
constexpr std::size_t kBlockVpls = 64;

/// The rays of one packet and some VPLs.
struct Block {
    struct Source {
        std::size_t pair;  ///< index into is_ray
    };
    std::vector<RTCRay16> packets;
    std::vector<int> counts;  ///< rays in each of `packets`
    std::vector<RTCRay> singles;
    std::vector<std::size_t> pairs;  ///< of each ray, its index into is_ray
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

void add_rays(Block& block, const OcclusionWork& work, std::size_t packet, std::size_t vpl, int width) {
    const std::size_t first = (packet * work.vpls.size() + vpl) * NEARLIGHT_PACKET_SIZE;
    int lanes = 16;  // used in the last of block.packets; a VPL begins a new one
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        if (work.is_ray[first + lane] == 0) {
            continue;
        }
        const RTCRay ray = make_ray(work.vpls[vpl], work.receivers[packet], lane);
        block.pairs.push_back(first + lane);
        if (width == 1) {
            block.singles.push_back(ray);
            continue;
        }
        if (lanes == 16) {
            block.packets.emplace_back();
            block.counts.push_back(0);
            lanes = 0;
        }
        set_lane(block.packets.back(), lanes++, ray);
        block.counts.back() = lanes;
    }
}

void fill(Block& block, const OcclusionWork& work, std::size_t packet, std::size_t first_vpl, int width) {
    block.packets.clear();
    block.counts.clear();
    block.singles.clear();
    block.pairs.clear();
    const std::size_t end = std::min(work.vpls.size(), first_vpl + kBlockVpls);
    for (std::size_t vpl = first_vpl; vpl < end; ++vpl) {
        add_rays(block, work, packet, vpl, width);
    }
}

void trace_block(Block& block, RTCScene tree, RTCIntersectContext& context) {
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
        rtcOccluded16(mask, tree, &context, &block.packets[i]);
    }
    for (RTCRay& ray : block.singles) {
        rtcOccluded1(tree, &context, &ray);
    }
}

/// Calls visit(pair, occluded) for each ray.
template <typename Visit>
void visit_results(const Block& block, Visit&& visit) {
    std::size_t ray = 0;
    for (const RTCRay& single : block.singles) {
        visit(block.pairs[ray++], single.tfar < 0.0f);
    }
    for (std::size_t i = 0; i < block.packets.size(); ++i) {
        for (int lane = 0; lane < block.counts[i]; ++lane) {
            visit(block.pairs[ray++], block.packets[i].tfar[lane] < 0.0f);
        }
    }
}

}  // namespace

std::string to_string(const EmbreeMode& mode) {
    return "rtcOccluded" + std::to_string(mode.width) + (mode.coherent ? " coherent" : " incoherent") +
           (mode.high_quality ? ", quality high" : ", quality medium");
}

struct EmbreeOcclusion::State {
    EmbreeDevice device;
    EmbreeTree medium;
    EmbreeTree high;
};

EmbreeOcclusion::EmbreeOcclusion(const Scene& scene, std::span<const uint> ids)
    : state_(std::make_unique<State>()) {
    state_->device.reset(rtcNewDevice(nullptr));
    if (state_->device == nullptr) {
        throw Error(ExitCode::runtime,
                    "Embree does not start: error " + std::to_string(rtcGetDeviceError(nullptr)));
    }
    state_->medium = build_tree(state_->device.get(), scene, ids, RTC_BUILD_QUALITY_MEDIUM);
    state_->high = build_tree(state_->device.get(), scene, ids, RTC_BUILD_QUALITY_HIGH);
}
EmbreeOcclusion::~EmbreeOcclusion() = default;
EmbreeOcclusion::EmbreeOcclusion(EmbreeOcclusion&&) noexcept = default;
EmbreeOcclusion& EmbreeOcclusion::operator=(EmbreeOcclusion&&) noexcept = default;

OcclusionResult EmbreeOcclusion::trace(const OcclusionWork& work, const EmbreeMode& mode, int threads,
                                       bool keep_pairs) const {
    using Clock = std::chrono::steady_clock;
    RTCScene tree = (mode.high_quality ? state_->high : state_->medium).get();
    std::vector<OcclusionResult> results(static_cast<std::size_t>(threads));
    std::vector<std::uint8_t> occluded_pairs(keep_pairs ? work.is_ray.size() : 0);
    std::atomic<std::size_t> next_packet = 0;
    const auto run = [&](OcclusionResult& result) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            mode.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        Block block;
        for (std::size_t packet = next_packet++; packet < work.receivers.size(); packet = next_packet++) {
            for (std::size_t vpl = 0; vpl < work.vpls.size(); vpl += kBlockVpls) {
                fill(block, work, packet, vpl, mode.width);
                const auto start = Clock::now();
                trace_block(block, tree, context);
                result.seconds += std::chrono::duration<double>(Clock::now() - start).count();
                result.rays += block.pairs.size();
                visit_results(block, [&](std::size_t pair, bool occluded) {
                    result.occluded += occluded ? 1 : 0;
                    if (keep_pairs) {
                        occluded_pairs[pair] = occluded ? 1 : 0;
                    }
                });
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
        sum.seconds += results[i].seconds / threads;
        sum.rays += results[i].rays;
        sum.occluded += results[i].occluded;
    }
    sum.occluded_pairs = std::move(occluded_pairs);
    return sum;
}

}  // namespace nearlight
