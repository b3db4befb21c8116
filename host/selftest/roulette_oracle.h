// SPDX-License-Identifier: Apache-2.0
// With which probability a packet of receivers must ask about each VPL, in double precision.
#pragma once

#include <span>
#include <vector>

#include "host/base/math.h"

namespace nearlight {

/// min(1, b / (threshold · mean of b)), one for each VPL; b is the root mean square, over the receivers, of
/// what the VPL could bring to them in its strongest channel if nothing were in the way.
std::vector<double> roulette_probabilities(std::span<const Vpl> vpls, const ReceiverPacket& receivers,
                                           float clamp_radius, float threshold);

}  // namespace nearlight
