// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/selftest.h"

#include "host/selftest/gather_checks.h"
#include "host/selftest/light_checks.h"
#include "host/selftest/placement_checks.h"
#include "host/selftest/primitive_checks.h"
#include "host/selftest/ray_checks.h"

namespace nearlight {
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
            {"placement", check_placement},
            {"closest hit", check_closest_hit},
            {"any hit", check_any_hit},
            {"gather packets", [](Device& d, CheckResult& r) { check_gather(d, GatherKernel::packets, r); }},
            {"gather rays", [](Device& d, CheckResult& r) { check_gather(d, GatherKernel::rays, r); }},
            {"direct light", check_direct_light},
            {"light tracing", check_light_tracing},
            {"metropolis chains", check_metropolis_chains},
            {"camera pass", check_camera_pass}};
}

}  // namespace

std::vector<CheckResult> run_selftest(Device& device, const std::function<void(const CheckResult&)>& done) {
    std::vector<CheckResult> results;
    for (const NamedCheck& check : all_checks()) {
        CheckResult& result = results.emplace_back();
        result.name = check.name;
        try {
            check.run(device, result);
        } catch (const Error& error) {  // of one kernel; the report is what this is for
            result.problem = error.what();
        }
        done(result);
    }
    return results;
}

}  // namespace nearlight
