// SPDX-License-Identifier: Apache-2.0
// Decides whether pictures of several seeds have the expectation that a path-traced picture shows. The
// function returns a verdict, so that tests can also check that it refuses wrong pictures.
//
// One render is one observation. Its pixels share their VPLs and depend on each other, but renders of
// different seeds do not. Therefore only means over renders are tested, against Student's distribution with
// Welch's degrees of freedom (the path tracer's variance is estimated, too), Bonferroni-corrected for the
// number of means:
//  1. the mean over the whole picture, for each colour channel, shows a wrong normalisation;
//  2. means over 4 × 4 and 8 × 8 blocks show light lost in a corner;
//  3. each pixel shows a wrong edge. Pixels that few paths light have a long-tailed distribution, whose
//     sample variance is mostly too small, so a pixel's variance counts as at least the mean of its block of
//     4 × 4;
//  4. the mean over all pixels and channels of z², which is 1 without bias, shows a small bias everywhere
//     that no single pixel shows. Its spread is not that of χ², because pixels depend on each other; it is
//     estimated from the products of pairs of renders [Chen and Qin, A two-sample test for high-dimensional
//     data with applications to gene-set testing, 2010]. The bound is that of the worst dependence, in which
//     all pixels change together.
// The five tests share the probability of a false alarm, kFalseAlarm for each verdict, evenly.
#pragma once

#include <span>
#include <string>

#include "host/image/image.h"

namespace nearlight::core::test {

inline constexpr double kFalseAlarm = 1e-4;

struct Verdict {
    bool agrees = true;
    std::string reason;  ///< what differs most, and by how much
    /// The standard error of the whole picture's mean ÷ mean, which says what can be told at all.
    double relative_error = 0;
    double bias = 0;  ///< whole mean ÷ expected − 1, of the channels' sum
};

/// Compares `layer` ("indirect" or "direct") of renders with that of trace_paths()'s `truth`. Pictures are of
/// one size, width and height multiples of 8; there are 8 renders or more.
Verdict judge_convergence(std::span<const Image> renders, const Image& truth, const std::string& layer);

}  // namespace nearlight::core::test
