// SPDX-License-Identifier: Apache-2.0
// The ways to ask Embree about rays.
#pragma once

#include <string>
#include <vector>

namespace nearlight::core {

/// One way to ask.
struct EmbreeMode {
    int width = 16;             ///< rays a call: 1 or 16
    bool coherent = false;      ///< Embree is told that successive rays are alike
    bool high_quality = false;  ///< RTC_BUILD_QUALITY_HIGH (spatial splits) instead of MEDIUM
};

/// Single rays first, and of them incoherent ones in the tree of medium quality.
std::vector<EmbreeMode> all_embree_modes();

/// "rtcOccluded16 coherent, quality high", where `call` is "rtcOccluded".
std::string to_string(const EmbreeMode& mode, const std::string& call);

}  // namespace nearlight::core
