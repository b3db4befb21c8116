// SPDX-License-Identifier: Apache-2.0
// Whether tracers agree, hit by hit, and whether single precision excuses disagreements.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/bench/gather_segments.h"

namespace nearlight::core {

/// The answers of a tracer.
struct TracerAnswer {
    PairMask rays;      ///< pairs that it traced
    PairMask occluded;  ///< those of `rays` that are occluded
};

/// A pair about which a tracer and the reference differ.
struct Disagreement {
    std::string tracer;
    std::size_t packet = 0, lane = 0, vpl = 0;
    Vec3 from{}, to{};  ///< VPL, receiver
    /// One traces the pair and the other culls it; otherwise they differ about a hit.
    bool is_culling = false;
    bool tracer_says = false;  ///< the tracer found a hit; if is_culling: it traced the pair
    double distance = 0.0;  ///< from the segment to the nearest edge, m; if is_culling: the smaller |cosine|
    /// The segment meets a triangle where its margin begins (distance_to_margins()).
    bool is_at_margin = false;
    bool excused = false;  ///< single precision explains it: the distance is small enough, or is_at_margin
};

/// How one tracer compares with the reference.
struct AgreementVerdict {
    std::uint64_t differences = 0;
    bool is_rare = true;  ///< fewer than 10⁻⁵ of the rays, or a single one
    bool is_good = true;  ///< is_rare, and every difference is excused
};

/// Compares tracers with one reference.
class Agreement {
  public:
    /// Segments that pass near an edge of the triangles, or meet one of them where their margin begins, are
    /// excused. Both arguments must outlive this object.
    Agreement(const GatherSegments& segments, std::span<const BvhTriangle> triangles);

    /// Adds the differences: occlusion of rays that both traced, and pairs that `answer` culls or traces
    /// contrary to the set of segments. `may_skip` allows culling, for tracers that leave rays out at random.
    AgreementVerdict compare(const std::string& tracer, const TracerAnswer& answer, const PairMask& reference,
                             bool may_skip = false);

    /// Distance (m) from an edge within which both answers about a segment are right: 10⁻⁵ of the scene's
    /// extent.
    [[nodiscard]] double edge_tolerance() const { return edge_tolerance_; }
    /// The first hundred disagreements of each tracer.
    [[nodiscard]] const std::vector<Disagreement>& items() const { return items_; }

  private:
    [[nodiscard]] bool is_excused(Disagreement& item) const;

    const GatherSegments* segments_;
    std::span<const BvhTriangle> triangles_;
    double edge_tolerance_;
    std::vector<Disagreement> items_;
};

}  // namespace nearlight::core
