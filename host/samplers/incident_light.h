// SPDX-License-Identifier: Apache-2.0
// The light that arrives at points which are to become VPLs: direct light, and light of all further bounces.
#pragma once

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// VPLs of light walks over the whole scene that light other VPLs, not the picture.
struct SparseSet {
    VplBuffer vpls;
    float clamp_radius = 0.0f;  ///< to gather them with, m; short paths supply what that leaves out
};

/// About `wanted` VPLs of up to task.bounce_count − 1 bounces; none where there are no further bounces.
SparseSet trace_sparse_set(SamplerStages& stages, const SamplingTask& task, uint wanted, uint seed);

/// How much is spent on each point.
struct IncidentQuality {
    uint direct_samples = 64;  ///< for area and environment lights
    uint paths = 4;            ///< for what the clamp radius of the sparse set leaves out; 0: leave it out
};

/// Where the light comes from: the emitters of the scene, and VPLs of up to `bounce_count` bounces.
struct IncidentSources {
    const DeviceScene& scene;
    uint bounce_count = 0;
    const VplBuffer& vpls;
    float clamp_radius = 0.0f;  ///< to gather them with, m
};

/// Irradiance of the receivers (W/m²) by light of up to `bounce_count` bounces, without bias if paths > 0.
void gather_incident_light(SamplerStages& stages, const IncidentSources& sources,
                           const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                           const IncidentQuality& quality, uint seed, Buffer<IrradiancePacket>& irradiance);

/// Irradiance at each of `points`, by what a VPL of depth up to task.bounce_count there reflects: multiplies
/// the power of a VPL that was made for an irradiance of 1 W/m².
std::vector<Vec3> incident_light_at(SamplerStages& stages, const SamplingTask& task, const SparseSet& sparse,
                                    std::span<const Vpl> points, const IncidentQuality& quality, uint seed);
/// Multiplies powers by the light that arrives.
void illuminate(std::span<Vpl> vpls, std::span<const Vec3> irradiance);
/// The first `count` lanes.
std::vector<Vec3> unpack(const Buffer<IrradiancePacket>& packets, std::size_t count);
std::vector<Vec3> unpack(const Buffer<ImportancePacket>& packets, std::size_t count);

}  // namespace nearlight::core
