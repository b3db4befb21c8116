// SPDX-License-Identifier: Apache-2.0
// Sums that do not depend on the order of their terms.
#pragma once

#include <cmath>

namespace nearlight::core {

/// A number of 106 bits: the sum of two doubles. `low` is at most half a unit in the last place of `high`.
/// Terms that are multiples of q add up without any rounding as long as no sum reaches 2¹⁰⁴ q, so the result
/// is then the same in every order. The steps are those of Dekker (A Floating-Point Technique for Extending
/// the Available Precision, 1971) and Knuth (The Art of Computer Programming, volume 2, 4.2.2).
struct DoubleSum {
    double high = 0.0;
    double low = 0.0;

    [[nodiscard]] double value() const { return high; }
    friend bool operator==(const DoubleSum&, const DoubleSum&) = default;
};

/// a + b without an error. An infinite or undefined sum has no lower part.
inline DoubleSum exact_sum(double a, double b) {
    const double sum = a + b;
    const double of_b = sum - a;
    const double error = (a - (sum - of_b)) + (b - of_b);
    return {sum, std::isfinite(sum) ? error : 0.0};
}

/// a · b without an error, unless it is too small for a double.
inline DoubleSum exact_product(double a, double b) {
    const double product = a * b;
    return {product, std::isfinite(product) ? std::fma(a, b, -product) : 0.0};
}

inline DoubleSum operator+(const DoubleSum& a, const DoubleSum& b) {
    const DoubleSum high = exact_sum(a.high, b.high);
    const DoubleSum low = exact_sum(a.low, b.low);
    const DoubleSum middle = exact_sum(high.high, high.low + low.high);
    return exact_sum(middle.high, middle.low + low.low);
}

inline DoubleSum operator-(const DoubleSum& a) {
    return {-a.high, -a.low};
}

}  // namespace nearlight::core
