// SPDX-License-Identifier: Apache-2.0
// Tunables as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/cl/devices/tunables.h"

namespace nearlight::core {

/// The object {"source": "…", "is_tuned": …, "beam_width": …, …}.
nlohmann::ordered_json to_json(const ChosenTunables& chosen);
/// The object {"beam_width": …, …}.
nlohmann::ordered_json to_json(const Tunables& tunables);
/// The text "beam_width 256, local_size 8, …".
std::string to_text(const Tunables& tunables);

}  // namespace nearlight::core
