// SPDX-License-Identifier: Apache-2.0
// The paper's table of equal RMSE: what each method needs to be as good as the baseline.
//
// log RMSE and log seconds (generate + gather) are fitted by straight lines over log VPLs, for each method.
// For each RMSE that the baseline reached at a measured count, the lines tell how many VPLs and seconds a
// method needs. The baseline's own row is what was measured.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nearlight::core {

struct CurvePoint {
    double vpls = 0;  ///< gathered
    double rmse = 0;
    double seconds = 0;  ///< generate + gather
};
struct Curve {
    std::vector<CurvePoint> points;  ///< by ascending VPLs
    bool biased = false;             ///< does not converge to the reference
    double floor = 0;                ///< its RMSE stays above this, whatever the count; 0: not known to
};

enum class Reach {
    measured,      ///< the baseline at one of its counts
    fitted,        ///< between half the least and twice the largest measured count
    extrapolated,  ///< beyond that: an order of magnitude rather than a number
    never,  ///< the RMSE does not fall with the count, has a floor above what is asked for, or falls so
            ///< slowly that a hundred times the largest measured count would not do
};
const char* to_string(Reach reach);

struct EqualRmseRow {
    std::size_t curve = 0;  ///< index of the method
    Reach reach = Reach::never;
    double vpls = 0;  ///< NaN for never, as are the others
    double seconds = 0;
    double vpls_ratio = 0;  ///< ÷ the baseline's
    double time_ratio = 0;
};
struct EqualRmse {
    double rmse = 0;
    std::vector<EqualRmseRow> rows;  ///< one a curve, in order
};

/// One entry for each point of the baseline with a positive RMSE, by falling RMSE; nothing where it has fewer
/// than two points, for then there is nothing to fit.
std::vector<EqualRmse> equal_rmse(std::span<const Curve> curves, std::size_t baseline);

}  // namespace nearlight::core
