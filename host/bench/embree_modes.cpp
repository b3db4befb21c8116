// SPDX-License-Identifier: Apache-2.0
#include "host/bench/embree_modes.h"

namespace nearlight::core {

std::vector<EmbreeMode> all_embree_modes() {
    std::vector<EmbreeMode> modes;
    for (const int width : {1, 16}) {
        for (const bool coherent : {false, true}) {
            for (const bool high_quality : {false, true}) {
                modes.push_back({width, coherent, high_quality});
            }
        }
    }
    return modes;
}

std::string to_string(const EmbreeMode& mode, const std::string& call) {
    return call + std::to_string(mode.width) + (mode.coherent ? " coherent" : " incoherent") +
           (mode.high_quality ? ", quality high" : ", quality medium");
}

}  // namespace nearlight::core
