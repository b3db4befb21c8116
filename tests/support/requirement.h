// SPDX-License-Identifier: Apache-2.0
// Whether tests may be skipped where there is no device.
#pragma once

#include <cstdlib>
#include <string_view>

namespace nearlight::core::test {

/// Whether a missing device is a failure: NEARLIGHT_REQUIRE_DEVICE=1, which CI sets.
inline bool device_is_required() {
    const char* const required = std::getenv("NEARLIGHT_REQUIRE_DEVICE");
    return required != nullptr && std::string_view(required) == "1";
}

}  // namespace nearlight::core::test
