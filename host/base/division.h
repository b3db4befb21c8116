// SPDX-License-Identifier: Apache-2.0
// Division of whole numbers that rounds up.
#pragma once

#include <concepts>
#include <type_traits>

namespace nearlight::core {

/// count ÷ by, rounded up, where `count` is not negative and `by` is above 0.
template <std::integral Count, std::integral By>
constexpr std::common_type_t<Count, By> divide_rounding_up(Count count, By by) {
    using Number = std::common_type_t<Count, By>;
    return (static_cast<Number>(count) + static_cast<Number>(by) - 1) / static_cast<Number>(by);
}

/// The smallest multiple of `unit` that is at least `count`.
template <std::integral Count, std::integral Unit>
constexpr std::common_type_t<Count, Unit> round_up_to_multiple(Count count, Unit unit) {
    return divide_rounding_up(count, unit) * static_cast<std::common_type_t<Count, Unit>>(unit);
}

}  // namespace nearlight::core
