// SPDX-License-Identifier: Apache-2.0
// Whether tracers agree, hit by hit, and what may excuse them where they do not.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/bench/gather_segments.h"

namespace nearlight::core {

/// What a tracer found.
struct TracerAnswer {
    PairMask rays;      ///< pairs that it traced
    PairMask occluded;  ///< of these
};

/// A pair about which a tracer and the reference differ.
struct Disagreement {
    std::string tracer;
    std::size_t packet = 0, lane = 0, vpl = 0;
    Vec3 from{}, to{};         ///< VPL, receiver
    bool is_culling = false;   ///< one traces and the other culls it; otherwise one hits, the other does not
    bool tracer_says = false;  ///< hit; of culling: traced
    double distance = 0.0;     ///< of the segment to the nearest edge, m; of culling: the least |cosine|
    bool excused = false;      ///< single precision explains it: the distance is small enough
};

/// How one tracer compares with the reference.
struct AgreementVerdict {
    std::uint64_t differences = 0;
    bool is_rare = true;  ///< fewer than 10⁻⁵ of the rays, or a single one
    bool is_good = true;  ///< that, and each excused
};

/// Compares tracers with one reference.
class Agreement {
  public:
    /// `edges` are the edges that excuse; both must outlive this.
    Agreement(const GatherSegments& segments, std::span<const BvhTriangle> edges);

    /// Adds what differs: occlusion of rays that both traced, and pairs that `answer` culls or traces against
    /// the set. A tracer that leaves rays out by chance may cull (`may_skip`).
    AgreementVerdict compare(const std::string& tracer, const TracerAnswer& answer, const PairMask& reference,
                             bool may_skip = false);

    /// ε, m: a segment that passes an edge within 10⁻⁵ of the scene's extent may go either way.
    [[nodiscard]] double edge_tolerance() const { return edge_tolerance_; }
    /// The first hundred of each tracer.
    [[nodiscard]] const std::vector<Disagreement>& items() const { return items_; }

  private:
    [[nodiscard]] bool is_excused(Disagreement& item) const;

    const GatherSegments* segments_;
    std::span<const BvhTriangle> edges_;
    double edge_tolerance_;
    std::vector<Disagreement> items_;
};

}  // namespace nearlight::core
