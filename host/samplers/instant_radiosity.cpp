// SPDX-License-Identifier: Apache-2.0
// Instant radiosity [Keller, SIGGRAPH 1997]: every VPL comes from quasi-random walks over the whole scene.
// Unlike in the original, sequences are randomised (Owen scrambling), and the number of walks that go on to a
// depth is a real number that is met in expectation. So each depth is unbiased and not only consistent.
#include "host/samplers/sampler.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {

VplSet sample_instant_radiosity(SamplerStages& stages, const SamplingTask& task) {
    VplSet set;
    set.vpls = stages.vpl_order.sort(
        trace_about(stages, task, empty_region(stages, task.scene), KeepDeposits::all, task.vpl_count).vpls);
    set.distant_count = set.vpls.count();
    return set;
}

}  // namespace nearlight::core
