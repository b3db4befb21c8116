// SPDX-License-Identifier: Apache-2.0
// Embree's trees of both qualities. Like embree.h, it is for .cpp files.
#pragma once

#include <span>

#include "host/bench/embree_modes.h"
#include "host/reference/embree_tree.h"

namespace nearlight::core {

/// Embree's trees of medium and high quality over the same triangles, without robust edges.
class EmbreeTreePair {
  public:
    /// Builds both trees over the triangles `ids`. Throws Error: ErrorKind::out_of_memory or
    /// ErrorKind::failure.
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
