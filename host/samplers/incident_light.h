// SPDX-License-Identifier: Apache-2.0
// The light that arrives at points that are to become VPLs: direct light and light of all further bounces.
#pragma once

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// A sparse set: VPLs of light walks over the whole scene that light other VPLs, but not the picture.
struct SparseSet {
    VplBuffer vpls;
    float clamp_radius = 0.0f;  ///< for gathering `vpls`, m; short paths supply what it takes away
};

/// Draws about `wanted` VPLs of up to task.bounce_count − 1 bounces among deposits of light walks, which are
/// in their order along the Morton curve, in proportion to `weights`. The set is empty if task.bounce_count
/// allows no further bounce. Where most light falls outside what the camera sees, as on the grounds around a
/// house, hardly any VPL would otherwise be where the picture is, and that one would stand for all light
/// there.
SparseSet draw_sparse_set(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> deposits,
                          std::span<const float> weights, std::size_t wanted, uint seed);

/// Draws a set as draw_sparse_set() does, but among deposits that it traces itself, and in proportion to what
/// these bring to the camera.
SparseSet trace_sparse_set(SamplerStages& stages, const SamplingTask& task, uint wanted, uint seed);

/// How many samples each point takes.
struct IncidentQuality {
    uint direct_samples = 64;  ///< samples per point for area and environment lights
    uint paths = 4;  ///< paths per point for light that the clamp radius takes away; 0 leaves it out
};

/// The sources of incident light: the emitters of the scene, and VPLs of up to `bounce_count` bounces.
struct IncidentSources {
    const DeviceScene& scene;
    uint bounce_count = 0;
    const VplBuffer& vpls;
    float clamp_radius = 0.0f;  ///< for gathering `vpls`, m
};

/// Writes the irradiance (W/m²) of receivers from light of up to sources.bounce_count bounces. It is unbiased
/// if quality.paths is above 0.
void gather_incident_light(SamplerStages& stages, const IncidentSources& sources,
                           const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                           const IncidentQuality& quality, uint seed, Buffer<IrradiancePacket>& irradiance);

/// Returns the irradiance (W/m²) at each of `points` that VPLs of depth up to task.bounce_count reflect
/// there. It is the factor for the power of a VPL that was made for an irradiance of 1 W/m².
std::vector<Vec3> incident_light_at(SamplerStages& stages, const SamplingTask& task, const SparseSet& sparse,
                                    std::span<const Vpl> points, const IncidentQuality& quality, uint seed);
/// Multiplies the power of each VPL by its irradiance.
void illuminate(std::span<Vpl> vpls, std::span<const Vec3> irradiance);
/// Returns the values of the first `count` lanes.
std::vector<Vec3> unpack(const Buffer<IrradiancePacket>& packets, std::size_t count);
std::vector<Vec3> unpack(const Buffer<ImportancePacket>& packets, std::size_t count);

}  // namespace nearlight::core
