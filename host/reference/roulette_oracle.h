// SPDX-License-Identifier: Apache-2.0
// The oracle of the roulette, in double precision: the probability with which a bundle of receivers asks
// about each VPL.
#pragma once

#include <span>
#include <vector>

#include "host/base/math.h"
#include "host/base/receiver_bundles.h"

namespace nearlight::core {

/// The probability min(1, b / (threshold · mean of b)) of each VPL; b is the root mean square, over the
/// receivers of the bundle, of what the VPL could bring to them in its strongest channel if nothing were in
/// the way.
std::vector<double> roulette_probabilities(std::span<const Vpl> vpls,
                                           std::span<const ReceiverPacket> receivers,
                                           const BundleLayout::Bundle& bundle, float clamp_radius,
                                           float threshold);

}  // namespace nearlight::core
