// SPDX-License-Identifier: Apache-2.0
#include "host/bench/agreement.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/base/receivers.h"
#include "host/bvh/segment_distance.h"
#include "host/reference/edge_excuse.h"

namespace nearlight::core {
namespace {

constexpr double kCosineTolerance = 1e-5;  // below it, rounding decides the sign of a cosine
constexpr double kMarginTolerance = 1e-6;  // rounding errors of coordinates, as a part of a segment's length
constexpr double kMaxShare = 1e-5;         // maximum of the fraction of rays that may differ
constexpr std::uint64_t kMaxItems = 100;   // of each tracer, because each item costs a look at every edge

double cosine(Vec3 normal, Vec3 direction) {
    return std::abs(double{normal.x} * direction.x + double{normal.y} * direction.y +
                    double{normal.z} * direction.z) /
           std::max(1e-300, double{length(normal)} * length(direction));
}

}  // namespace

Agreement::Agreement(const GatherSegments& segments, std::span<const BvhTriangle> triangles)
    : segments_(&segments),
      triangles_(triangles),
      edge_tolerance_(kSegmentEdgeTolerance * max_component(bounds(segments.geometry).size())) {}

/// Fills in the position of the pair and how close a call it was, and decides whether that excuses it.
bool Agreement::is_excused(Disagreement& item) const {
    const Vpl& vpl = segments_->vpls[item.vpl];
    const ReceiverPoint receiver = receiver_at(segments_->receivers[item.packet], item.lane);
    item.from = vpl.position;
    item.to = receiver.position;
    const Vec3 segment = item.to - item.from;
    if (item.is_culling) {
        item.distance = std::min(cosine(vpl.normal, segment), cosine(receiver.normal, segment));
        item.excused = item.distance <= kCosineTolerance;
    } else {
        item.distance = distance_to_edges(triangles_, item.from, item.to);
        item.is_at_margin = distance_to_margins(triangles_, item.from, item.to) <= kMarginTolerance;
        item.excused = item.distance <= edge_tolerance_ || item.is_at_margin;
    }
    return item.excused;
}

AgreementVerdict Agreement::compare(const std::string& tracer, const TracerAnswer& answer,
                                    const PairMask& reference, bool may_skip) {
    AgreementVerdict verdict;
    for (std::size_t word = 0; word < segments_->rays.size(); ++word) {
        const std::uint64_t both = answer.rays[word] & segments_->rays[word];
        const std::uint64_t hits = (answer.occluded[word] ^ reference[word]) & both;
        const std::uint64_t culls = (answer.rays[word] & ~segments_->rays[word]) |
                                    (may_skip ? 0 : segments_->rays[word] & ~answer.rays[word]);
        for (std::uint64_t lanes = hits | culls; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            const bool is_culling = ((culls >> lane) & 1u) != 0;
            const PairMask& says = is_culling ? answer.rays : answer.occluded;
            if (verdict.differences++ >= kMaxItems) {
                verdict.is_good = false;
                continue;
            }
            Disagreement item{.tracer = tracer,
                              .packet = word / segments_->vpls.size(),
                              .lane = lane,
                              .vpl = word % segments_->vpls.size(),
                              .is_culling = is_culling,
                              .tracer_says = ((says[word] >> lane) & 1u) != 0};
            verdict.is_good = is_excused(item) && verdict.is_good;
            items_.push_back(std::move(item));
        }
    }
    const auto rays = static_cast<double>(count_bits(segments_->rays));
    verdict.is_rare = verdict.differences <= 1 || static_cast<double>(verdict.differences) < kMaxShare * rays;
    verdict.is_good = verdict.is_good && verdict.is_rare;
    return verdict;
}

}  // namespace nearlight::core
