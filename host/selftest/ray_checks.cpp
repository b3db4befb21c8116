// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include <numeric>

#include "host/reference/ray_comparison.h"
#include "host/reference/test_rays.h"
#include "host/stages/ray_caster.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kRayTriangles = 600;
constexpr std::size_t kRays = 2000;

struct RayBench {
    Scene scene = make_triangle_soup(kRayTriangles, 31);
    Bvh bvh = build_scene_bvh(scene);
    std::vector<RayFamily> families = make_ray_families(scene, kRays, 32);
};

void add(const RayComparison& comparison, CheckResult& result) {
    result.cases += comparison.rays;
    result.mismatches += comparison.mismatches();
}

}  // namespace

void check_closest_hit(Device& device, CheckResult& result) {
    const RayBench bench;
    RayCaster caster(device);
    for (const RayFamily& family : bench.families) {
        const std::vector<BvhHit> found = caster.closest_hits(bench.bvh, family.rays);
        add(compare_hits(bench.scene, family.rays, brute_force_hits(bench.scene, family.rays), found),
            result);
        add(compare_hits(bench.scene, family.rays, embree_hits(bench.scene, family.rays), found), result);
    }
    for (const BvhHit& hit : caster.closest_hits(bench.bvh, make_broken_rays())) {
        result.expect(hit.triangle == ~0u);
    }
}

void check_any_hit(Device& device, CheckResult& result) {
    const RayBench bench;
    RayCaster caster(device);
    for (const RayFamily& family : bench.families) {
        const std::vector<BvhHit> closest = caster.closest_hits(bench.bvh, family.rays);
        const std::vector<uint> any = caster.any_hits(bench.bvh, family.rays);
        for (std::size_t i = 0; i < any.size(); ++i) {
            result.expect((any[i] != 0) == (closest[i].triangle != ~0u));
        }
    }
    for (const uint hit : caster.any_hits(bench.bvh, make_broken_rays())) {
        result.expect(hit == 0);
    }
}

}  // namespace nearlight::core
