// SPDX-License-Identifier: Apache-2.0
#include "host/compare/equal_rmse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/compare/statistics.h"

namespace nearlight::core {
namespace {

/// Factor beyond the measured counts up to which the fits are trusted.
constexpr double kTrustedFactor = 2.0;
/// Factor beyond the largest measured count up to which the fits give at least an order of magnitude.
constexpr double kHopelessFactor = 100.0;

struct Fits {
    std::optional<PowerLaw> rmse;
    std::optional<PowerLaw> seconds;
};

Fits fit(const Curve& curve) {
    std::vector<double> vpls, rmse, seconds;
    for (const CurvePoint& point : curve.points) {
        vpls.push_back(point.vpls);
        rmse.push_back(point.rmse);
        seconds.push_back(point.seconds);
    }
    return {fit_power_law(vpls, rmse), fit_power_law(vpls, seconds)};
}

EqualRmseRow never(std::size_t index) {
    return {index, Reach::never, kNan, kNan, kNan, kNan};
}

EqualRmseRow needed(const Curve& curve, const Fits& fits, std::size_t index, double rmse,
                    const CurvePoint& baseline) {
    if (!fits.rmse || !fits.seconds || fits.rmse->slope >= 0.0 || rmse <= curve.floor) {
        return never(index);
    }
    const double vpls = fits.rmse->inverse(rmse);
    const bool beyond = vpls > kTrustedFactor * curve.points.back().vpls;
    const bool hopeless = !(vpls <= kHopelessFactor * curve.points.back().vpls);
    if (hopeless || (beyond && curve.biased)) {
        return never(index);
    }
    const bool before = vpls * kTrustedFactor < curve.points.front().vpls;
    const double seconds = fits.seconds->at(vpls);
    return {index,
            beyond || before ? Reach::extrapolated : Reach::fitted,
            vpls,
            seconds,
            vpls / baseline.vpls,
            seconds / baseline.seconds};
}

}  // namespace

const char* to_string(Reach reach) {
    switch (reach) {
        case Reach::measured:
            return "measured";
        case Reach::fitted:
            return "fitted";
        case Reach::extrapolated:
            return "extrapolated";
        case Reach::never:
            break;
    }
    return "never";
}

std::vector<EqualRmse> equal_rmse(std::span<const Curve> curves, std::size_t baseline) {
    const Curve& standard = curves[baseline];
    if (standard.points.size() < 2) {
        return {};
    }
    std::vector<Fits> fits;
    for (const Curve& curve : curves) {
        fits.push_back(fit(curve));
    }
    std::vector<EqualRmse> groups;
    for (const CurvePoint& point : standard.points) {
        if (!(point.rmse > 0.0)) {
            continue;
        }
        EqualRmse group{point.rmse, {}};
        for (std::size_t i = 0; i < curves.size(); ++i) {
            group.rows.push_back(i == baseline
                                     ? EqualRmseRow{i, Reach::measured, point.vpls, point.seconds, 1.0, 1.0}
                                     : needed(curves[i], fits[i], i, point.rmse, point));
        }
        groups.push_back(std::move(group));
    }
    std::ranges::stable_sort(groups, std::greater{}, &EqualRmse::rmse);
    return groups;
}

}  // namespace nearlight::core
