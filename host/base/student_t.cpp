// SPDX-License-Identifier: Apache-2.0
#include "host/base/student_t.h"

#include <cmath>
#include <initializer_list>
#include <limits>

namespace nearlight::core {
namespace {

/// The continued fraction of the incomplete beta function [NIST Digital Library of Mathematical Functions,
/// 8.17.22], by Lentz's method as Thompson and Barnett modified it. It converges fast for x < (a + 1)/(a + b
/// + 2).
double beta_fraction(double x, double a, double b) {
    constexpr double kTiny = std::numeric_limits<double>::min();
    constexpr int kMaxTerms = 100'000;
    const auto nonzero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
    double c = 1.0;
    double d = 1.0 / nonzero(1.0 - (a + b) * x / (a + 1.0));
    double fraction = d;
    for (int m = 1; m < kMaxTerms; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
        double change = 1.0;
        for (const double term : {even, odd}) {
            d = 1.0 / nonzero(1.0 + term * d);
            c = nonzero(1.0 + term / c);
            change = c * d;
            fraction *= change;
        }
        if (std::abs(change - 1.0) < std::numeric_limits<double>::epsilon()) {
            break;
        }
    }
    return fraction;
}

/// The regularised incomplete beta function I_x(a, b). The caller passes y = 1 − x, because a subtraction
/// would lose digits.
double regularized_beta(double x, double y, double a, double b) {
    if (x <= 0.0 || y <= 0.0) {
        return x <= 0.0 ? 0.0 : 1.0;
    }
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(y));
    return x < (a + 1.0) / (a + b + 2.0) ? front * beta_fraction(x, a, b) / a
                                         : 1.0 - front * beta_fraction(y, b, a) / b;
}

}  // namespace

double student_t_tail(double t, double freedom) {
    const double sum = freedom + t * t;
    return regularized_beta(freedom / sum, t * t / sum, 0.5 * freedom, 0.5);
}

double student_t_quantile(double probability, double freedom) {
    double low = 0.0;
    double high = 1.0;
    while (student_t_tail(high, freedom) > probability) {
        low = high;
        high *= 2.0;
    }
    for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high)) {
        (student_t_tail(middle, freedom) > probability ? low : high) = middle;
    }
    return high;
}

}  // namespace nearlight::core
