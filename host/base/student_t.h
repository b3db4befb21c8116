// SPDX-License-Identifier: Apache-2.0
// Tails and quantiles of Student's t distribution, two-sided.
#pragma once

namespace nearlight::core {

/// P(|T| > |t|), where T has Student's distribution with `freedom` > 0 degrees of freedom.
double student_t_tail(double t, double freedom);

/// The t ≥ 0 with student_t_tail(t, freedom) = `probability`, which lies between 0 and 1. For a 95 %
/// confidence interval pass 0.05.
double student_t_quantile(double probability, double freedom);

}  // namespace nearlight::core
