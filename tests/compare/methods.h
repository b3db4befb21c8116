// SPDX-License-Identifier: Apache-2.0
// Methods that tests compare.
#pragma once

#include "host/compare/method.h"

namespace nearlight::core {

inline const Method kWalks{SamplerKind::instant_radiosity, std::nullopt};

}  // namespace nearlight::core
