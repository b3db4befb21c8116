// SPDX-License-Identifier: Apache-2.0
// What Embree is asked with. For .cpp files only, as embree.h.
#pragma once

#include <span>

#include "host/bench/embree_modes.h"
#include "host/reference/embree_tree.h"

namespace nearlight::core {

/// Trees of both qualities, without robust edges.
class EmbreeTreePair {
  public:
    /// Over the triangles `ids`. Throws Error: out_of_memory, or runtime.
    EmbreeTreePair(const Scene& scene, std::span<const uint> ids);

    [[nodiscard]] RTCScene tree(const EmbreeMode& mode) const {
        return (mode.high_quality ? high_ : medium_).get();
    }

  private:
    EmbreeReport report_;
    EmbreeDevice device_;
    EmbreeTree medium_;
    EmbreeTree high_;
};

}  // namespace nearlight::core
