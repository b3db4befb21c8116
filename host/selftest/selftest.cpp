// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/selftest.h"

#include "host/selftest/checks.h"

namespace nearlight::core {
namespace {

struct NamedCheck {
    const char* name;
    std::function<void(Device&, CheckResult&)> run;
};

std::vector<NamedCheck> all_checks() {
    return {{"layout", check_layout},
            {"scan", check_scan},
            {"compaction", check_compaction},
            {"sort", check_sort},
            {"morton", check_morton},
            {"classify", check_classifier},
            {"light visibility", check_light_visibility},
            {"placement", check_placement},
            {"patch VPLs", check_patch_vpls},
            {"VPL light", check_vpl_light},
            {"closest hit", check_closest_hit},
            {"any hit", check_any_hit},
            {"gather packets", [](Device& d, CheckResult& r) { check_gather(d, GatherKernel::packets, r); }},
            {"gather rays", [](Device& d, CheckResult& r) { check_gather(d, GatherKernel::rays, r); }},
            {"roulette", check_roulette},
            {"light cuts", check_light_cuts},
            {"BSDFs", check_bsdfs},
            {"direct light", check_direct_light},
            {"paths of receivers", check_receiver_paths},
            {"shared lights", check_shared_lights},
            {"shared sky", check_shared_sky},
            {"shared veiled", check_shared_veiled},
            {"shared reflections", check_shared_reflections},
            {"light tracing", check_light_tracing},
            {"caustic walks", check_caustic_walks},
            {"VPL contribution", check_vpl_contribution},
            {"reverse VPLs", check_reverse_vpls},
            {"metropolis chains", check_metropolis_chains},
            {"local lights", check_local_lights},
            {"camera pass", check_camera_pass},
            {"first surfaces", check_first_surfaces},
            {"camera lights", check_camera_lights},
            {"film", check_film},
            {"splats", check_splats}};
}

}  // namespace

std::vector<CheckResult> run_selftest(Device& device, const std::function<void(const CheckResult&)>& done) {
    std::vector<CheckResult> results;
    for (const NamedCheck& check : all_checks()) {
        CheckResult& result = results.emplace_back();
        result.name = check.name;
        try {
            check.run(device, result);
        } catch (const Error& error) {  // one check failed; the report names it
            result.problem = error.what();
        }
        done(result);
    }
    return results;
}

}  // namespace nearlight::core
