// SPDX-License-Identifier: Apache-2.0
// What is checked: each kernel against an oracle of its own. A check counts cases and mismatches in `result`,
// and throws Error where it cannot run.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {

// primitive_checks.cpp: parallel primitives against the standard library.

/// Sizes and offsets of the shared structs; a case is a fact.
void check_layout(Device& device, CheckResult& result);
/// Prefix sums of 32 and 64 bits, at awkward sizes; a case is a sum.
void check_scan(Device& device, CheckResult& result);
/// A case is an index of a set flag.
void check_compaction(Device& device, CheckResult& result);
/// A case is a pair in its place.
void check_sort(Device& device, CheckResult& result);
/// A case is the code of a point: the cell that it lies in, or its neighbour where rounding decides.
void check_morton(Device& device, CheckResult& result);

// placement_checks.cpp: close-range placement: classification against a quadratic programme, placement
// against its promise.

/// A case is a triangle, which must be selected if it reaches into the close range for sure, and must not if
/// it surely does not.
void check_classifier(Device& device, CheckResult& result);
/// A case is a triangle that by Embree's rays some light reaches everywhere, and must be selected, or that
/// none reaches anywhere, and must not; or one that was not asked about.
void check_light_visibility(Device& device, CheckResult& result);
/// A case is a sample k of K: on a triangle of the k-th part of the area, and on the triangle.
void check_placement(Device& device, CheckResult& result);

// vpl_checks.cpp: stages that make VPLs, light them and tell what they bring to the camera.

/// A case is a lane: VPLs as receivers, powers times irradiance, sums of irradiance.
void check_vpl_light(Device& device, CheckResult& result);
/// A case is a side of a sample: a VPL where it reflects and lies in the close range, albedo times area its
/// power.
void check_patch_vpls(Device& device, CheckResult& result);
/// A case is a VPL in one of both norms: its sum over what the camera sees, by Embree's rays.
void check_vpl_contribution(Device& device, CheckResult& result);
/// A case is a ray, which must land where Embree's does and take the albedo there, or the density around that
/// place.
void check_reverse_vpls(Device& device, CheckResult& result);

// ray_checks.cpp: the kernels' traversal against brute force and Embree.

/// A case is a ray and one of both oracles; ties at edges (ray_comparison.h) count as right.
void check_closest_hit(Device& device, CheckResult& result);
/// A case is a ray: occluded where it has a closest hit.
void check_any_hit(Device& device, CheckResult& result);

// gather_checks.cpp: the gather against Embree, pair by pair and sum by sum.

/// A case is a shadow ray, whose visibility must be Embree's unless it touches an edge, or the irradiance of
/// a receiver all of whose rays agree.
void check_gather(Device& device, GatherKernel kernel, CheckResult& result);

// roulette_checks.cpp: the roulette against probabilities and the full gather.

/// A case is a VPL of a packet over many seeds, which must be asked about as often as its bound says and then
/// count the reciprocal; or the mean over those seeds of a packet's light, which must be that of all VPLs.
void check_roulette(Device& device, CheckResult& result);

// light_checks.cpp: stages that need a whole scene: direct light, light tracing, Metropolis chains and camera
// pass.

/// A case is a receiver under point and spot lights, whose irradiance must be Embree's unless a shadow ray
/// touches an edge.
void check_direct_light(Device& device, CheckResult& result);
/// A case is a colour channel at a depth: in a closed room of albedo ρ walks deposit Φ·ρ^depth.
void check_light_tracing(Device& device, CheckResult& result);
/// A case is a depth: chains that follow power alone must come to have depths in proportion to the power
/// there, whatever the depths of their seeds.
void check_metropolis_chains(Device& device, CheckResult& result);
/// A case is a receiver, or a lane that must be absent.
void check_camera_pass(Device& device, CheckResult& result);

// path_checks.cpp: stages that follow paths from receivers: bounce tracer and local lights.

/// A case is a receiver on the inside of a sphere, where indirect light of each depth, and the part of it
/// that a clamp radius takes away, are known.
void check_bounce_tracer(Device& device, CheckResult& result);
/// A case is a local light, whose power and receivers must be those of Embree's rays, or what a receiver gets
/// from all of its packet's lights.
void check_local_lights(Device& device, CheckResult& result);

// film_checks.cpp: the film against sums in double precision.

/// A case is a channel of a pixel.
void check_film(Device& device, CheckResult& result);

}  // namespace nearlight::core
