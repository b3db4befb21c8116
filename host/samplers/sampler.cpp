// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/sampler.h"

namespace nearlight {

std::string to_string(SamplerKind kind) {
    return kind == SamplerKind::close_range ? "close-range" : "instant-radiosity";
}

std::string to_string(Policy policy) { return policy == Policy::paper ? "paper" : "partition"; }

VplSet sample_vpls(SamplerStages& stages, const SamplingTask& task) {
    if (task.vpl_count == 0 || task.bounce_count == 0 || task.scene.host_info.emitter_count == 0) {
        return {};
    }
    switch (task.sampler) {
        case SamplerKind::instant_radiosity:
            return sample_instant_radiosity(stages, task);
        case SamplerKind::close_range:
            return sample_close_range(stages, task);
    }
    return {};
}

}  // namespace nearlight
