// SPDX-License-Identifier: Apache-2.0
// The checks: each kernel is compared with its own oracle. A check counts cases and mismatches in `result`,
// and throws Error if it cannot run.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {

// primitive_checks.cpp: parallel primitives against the standard library.

/// A case is the size of a shared struct or the offset of a member.
void check_layout(Device& device, CheckResult& result);
/// A case is a prefix sum of 32 or 64 bits, in arrays of awkward sizes.
void check_scan(Device& device, CheckResult& result);
/// A case is the index of a flag that is set.
void check_compaction(Device& device, CheckResult& result);
/// A case is a sorted pair, which must be in its place.
void check_sort(Device& device, CheckResult& result);
/// A case is the Morton code of a point, which must be that of its cell, or of a neighbouring cell where
/// rounding decides.
void check_morton(Device& device, CheckResult& result);

// placement_checks.cpp: close-range placement: classification against a quadratic program, placement against
// its specification.

/// A case is a triangle, which must be selected if it certainly reaches into the close range, and must not be
/// selected if it certainly does not.
void check_classifier(Device& device, CheckResult& result);
/// A case is a triangle. It must be selected if by Embree's rays a light reaches all of it, and must not be
/// selected if no light reaches any of it or if it was not asked about.
void check_light_visibility(Device& device, CheckResult& result);
/// A case is the sample k of K, which must lie on a triangle in the k-th part of the area.
void check_placement(Device& device, CheckResult& result);

// vpl_checks.cpp: stages that make VPLs, light them and compute what they bring to the camera.

/// A case is a lane: a VPL as receiver, a power times its irradiance, or a sum of irradiance.
void check_vpl_light(Device& device, CheckResult& result);
/// A case is a side of a sample. It must become a VPL if it reflects and lies in the close range, with the
/// power albedo times area.
void check_patch_vpls(Device& device, CheckResult& result);
/// A case is the contribution of a VPL in one of the two norms, which must be the sum over what the camera
/// sees, by Embree's rays.
void check_vpl_contribution(Device& device, CheckResult& result);
/// A case is a ray, which must land where Embree's ray does with the albedo there, or the density around that
/// place.
void check_reverse_vpls(Device& device, CheckResult& result);

// ray_checks.cpp: the kernels' traversal against brute force and Embree.

/// A case is a ray compared with one of the two oracles; ties at edges (ray_comparison.h) count as right.
void check_closest_hit(Device& device, CheckResult& result);
/// A case is a ray, which must be occluded if and only if it has a closest hit.
void check_any_hit(Device& device, CheckResult& result);

// gather_checks.cpp: the gather against Embree, pair by pair and sum by sum.

/// A case is a shadow ray, whose visibility must be Embree's unless it touches an edge, or the irradiance of
/// a receiver whose rays all agree.
void check_gather(Device& device, GatherKernel kernel, CheckResult& result);

// roulette_checks.cpp: the roulette against probabilities and the full gather.

/// A case is a VPL of a bundle over many seeds, which must be chosen as often as its bound says, with the
/// reciprocal of that probability as its weight; or the mean of a packet's light over those seeds, which must
/// be the light of all VPLs.
void check_roulette(Device& device, CheckResult& result);

// cut_checks.cpp: cuts through a tree of VPLs.

/// A case is a VPL and a node above it, which must hold it; the power of a node; or the mean of a packet's
/// light over many evenly spaced shifts of the draws, which must be the light of all VPLs.
void check_light_cuts(Device& device, CheckResult& result);

// bsdf_checks.cpp: models of surfaces against those of the path tracer, in double precision.

/// A case is the value of D or of S of a material for two directions, or the value along a direction that the
/// kernel drew, which must be the sample's weight times its density.
void check_bsdfs(Device& device, CheckResult& result);

// light_checks.cpp: stages that need a whole scene: direct light, light tracing, Metropolis chains and camera
// pass.

/// A case is a receiver under point and spot lights, whose irradiance must be Embree's unless a shadow ray
/// touches an edge.
void check_direct_light(Device& device, CheckResult& result);
/// A case is the power in a colour channel at a depth: in a closed room of albedo ρ, walks deposit Φ·ρ^depth.
void check_light_tracing(Device& device, CheckResult& result);
/// A case is a landing of a walk over a flat mirror, which must lie on the line from the mirror image of the
/// lamp through its target.
void check_caustic_walks(Device& device, CheckResult& result);
/// A case is a depth. The share of chains at a depth must converge to the share of power there if the chains
/// follow power alone, whatever the depths of their seeds.
void check_metropolis_chains(Device& device, CheckResult& result);
/// A case is a lane: a receiver that must agree with Embree's, or one that must be absent.
void check_camera_pass(Device& device, CheckResult& result);
/// A case is a pixel, in whose middle the triangle must be Embree's unless the ray touches an edge.
void check_first_surfaces(Device& device, CheckResult& result);

// path_checks.cpp: stages that follow paths from receivers: receiver paths and local lights.

/// A case is a receiver on the inside of a sphere, where the indirect light of each depth is known, and the
/// part of it that a clamp radius takes away.
void check_receiver_paths(Device& device, CheckResult& result);
/// A case is a local light, whose power and receivers must be those of Embree's rays, or the irradiance of a
/// receiver from all lights of its packet.
void check_local_lights(Device& device, CheckResult& result);

// shared_light_checks.cpp: lights that a bundle shares.

/// A case is a receiver, whose irradiance from the lights of its bundle must be that of Embree's rays, by
/// packets and by single rays.
void check_shared_lights(Device& device, CheckResult& result);
/// As check_shared_lights(), for light of the sky.
void check_shared_sky(Device& device, CheckResult& result);
/// As check_shared_lights(), for light of places behind masks.
void check_shared_veiled(Device& device, CheckResult& result);
/// As check_shared_lights(), for light that metal reflects.
void check_shared_reflections(Device& device, CheckResult& result);

// film_checks.cpp: the film, and the light of camera paths, against sums in double precision.

/// A case is the value of a channel of a pixel.
void check_film(Device& device, CheckResult& result);
/// A case is a half of the light that the camera paths of a pixel bring, the rounds of further paths that the
/// pixel gets, or its light after one of them.
void check_camera_lights(Device& device, CheckResult& result);
/// A case is a channel of the light of a pixel, direct or indirect, or its coverage.
void check_splats(Device& device, CheckResult& result);

}  // namespace nearlight::core
