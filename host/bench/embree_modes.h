// SPDX-License-Identifier: Apache-2.0
// The ways to trace rays with Embree.
#pragma once

#include <string>
#include <vector>

namespace nearlight::core {

/// One way to trace rays with Embree.
struct EmbreeMode {
    int width = 16;             ///< rays per call: 1 or 16
    bool coherent = false;      ///< Embree is told that successive rays are alike
    bool high_quality = false;  ///< RTC_BUILD_QUALITY_HIGH (spatial splits) instead of MEDIUM
};

/// All modes. The first is single incoherent rays in the tree of medium quality, and all modes of single rays
/// come first.
std::vector<EmbreeMode> all_embree_modes();

/// Name of the mode: with the call "rtcOccluded", for example "rtcOccluded16 coherent, quality high".
std::string to_string(const EmbreeMode& mode, const std::string& call);

}  // namespace nearlight::core
