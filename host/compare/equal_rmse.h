// SPDX-License-Identifier: Apache-2.0
// The paper's table of equal RMSE: the VPLs and seconds that each method needs to be as good as the baseline.
//
// log RMSE and log seconds (generate + gather) are fitted by straight lines over log VPLs, for each method.
// For each RMSE that the baseline reached at a measured count, the lines give the VPLs and seconds that a
// method needs. The baseline's own row has the measured values.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nearlight::core {

struct CurvePoint {
    double vpls = 0;  ///< gathered VPLs
    double rmse = 0;
    double seconds = 0;  ///< generate + gather
};
struct Curve {
    std::vector<CurvePoint> points;  ///< in ascending order of VPLs
    bool biased = false;             ///< whether it does not converge to the reference
    double floor = 0;  ///< its RMSE stays above this, whatever the number of VPLs; 0: no floor is known
};

enum class Reach {
    measured,      ///< the baseline itself at one of its counts
    fitted,        ///< between half the smallest and twice the largest measured count
    extrapolated,  ///< beyond the range of `fitted`: an order of magnitude only
    /// The RMSE does not fall with the count, has a floor above the RMSE asked for, falls so slowly that a
    /// hundred times the largest measured count would not suffice, or lies beyond the range of `fitted` for a
    /// biased method, whose line does not go on.
    never,
};
const char* to_string(Reach reach);

struct EqualRmseRow {
    std::size_t curve = 0;  ///< index of the method
    Reach reach = Reach::never;
    double vpls = 0;  ///< VPLs needed; all numbers of the row are NaN for Reach::never
    double seconds = 0;
    double vpls_ratio = 0;  ///< ÷ the baseline's
    double time_ratio = 0;
};
struct EqualRmse {
    double rmse = 0;
    std::vector<EqualRmseRow> rows;  ///< one per curve, in their order
};

/// One entry for each point of the baseline with a positive RMSE, in falling order of RMSE. Empty if the
/// baseline has fewer than two points, because nothing can be fitted then.
std::vector<EqualRmse> equal_rmse(std::span<const Curve> curves, std::size_t baseline);

}  // namespace nearlight::core
