// SPDX-License-Identifier: Apache-2.0
#include "host/reference/roulette_oracle.h"

#include <numeric>

#include "host/base/receivers.h"

namespace nearlight::core {
namespace {

double dot64(Vec3 a, Vec3 b) {
    return static_cast<double>(a.x) * b.x + static_cast<double>(a.y) * b.y + static_cast<double>(a.z) * b.z;
}

/// The geometry term without visibility: max0(cosθx)·max0(cosθy) / max(r², R²).
double open_term(const Vpl& vpl, const ReceiverPoint& receiver, double clamp_radius) {
    const Vec3 segment = receiver.position - vpl.position;
    const double r2 = dot64(segment, segment);
    const double from_vpl = dot64(vpl.normal, segment);
    const double to_receiver = -dot64(receiver.normal, segment);
    return r2 > 0 && from_vpl > 0 && to_receiver > 0
               ? from_vpl * to_receiver / (r2 * std::max(r2, clamp_radius * clamp_radius))
               : 0.0;
}

double bound(const Vpl& vpl, std::span<const ReceiverPacket> receivers, const BundleLayout::Bundle& bundle,
             float clamp_radius) {
    double squares = 0;
    for (uint i = 0; i < bundle.count; ++i) {
        const ReceiverPacket& packet = receivers[bundle.first + i];
        for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            const double term = open_term(vpl, receiver_at(packet, lane), clamp_radius);
            squares += term * term;
        }
    }
    return std::sqrt(squares / (bundle.count * NEARLIGHT_PACKET_SIZE)) * max_component(vpl.power) /
           static_cast<double>(kPi);
}

}  // namespace

std::vector<double> roulette_probabilities(std::span<const Vpl> vpls,
                                           std::span<const ReceiverPacket> receivers,
                                           const BundleLayout::Bundle& bundle, float clamp_radius,
                                           float threshold) {
    std::vector<double> result;
    for (const Vpl& vpl : vpls) {
        result.push_back(bound(vpl, receivers, bundle, clamp_radius));
    }
    const double mean =
        std::accumulate(result.begin(), result.end(), 0.0) / static_cast<double>(result.size());
    for (double& value : result) {
        value = mean > 0 ? std::min(1.0, value / (threshold * mean)) : 0.0;
    }
    return result;
}

}  // namespace nearlight::core
