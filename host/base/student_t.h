// SPDX-License-Identifier: Apache-2.0
// Student's t distribution, from both sides.
#pragma once

namespace nearlight::core {

/// P(|T| > |t|), where T has Student's distribution with `freedom` > 0 degrees of freedom.
double student_t_tail(double t, double freedom);

/// The t ≥ 0 with P(|T| > t) = `probability`, which lies between 0 and 1: for an interval of confidence 95 %
/// pass 0.05.
double student_t_quantile(double probability, double freedom);

}  // namespace nearlight::core
