// SPDX-License-Identifier: Apache-2.0
#include "host/compare/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/median.h"

namespace nearlight::core {
namespace {

constexpr double kBiasThatCounts = 0.02;
/// Maximum noise of a reliable reference, as a fraction of the RMSE that is measured with it.
constexpr double kNoiseThatCounts = 1.0 / 3.0;

template <typename Value>
std::vector<double> column(std::span<const Cell* const> cells, Value&& value) {
    std::vector<double> values;
    for (const Cell* cell : cells) {
        values.push_back(static_cast<double>(value(*cell)));
    }
    return values;
}

double bias_floor(std::span<const Cell* const> cells) {
    double squares = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const Interval error =
            mean_interval(column(cells, [c](const Cell& cell) { return cell.error.mean_error[c]; }));
        const double min_error = std::isnan(error.half_width) ? 0.0 : std::abs(error.mean) - error.half_width;
        squares += std::pow(std::max(0.0, min_error), 2) / 3.0;
    }
    return std::sqrt(squares);
}

EqualVplsRow row_of(const Method& method, uint vpls, std::span<const Cell> all) {
    std::vector<const Cell*> cells;
    for (const Cell& cell : all) {
        if (cell.id.method == method && cell.id.vpls == vpls) {
            cells.push_back(&cell);
        }
    }
    EqualVplsRow row{.method = method, .vpls = vpls};
    row.gathered_vpls =
        mean_interval(column(cells, [](const Cell& cell) { return cell.gathered_vpls(); })).mean;
    row.sparse_vpls = mean_interval(column(cells, [](const Cell& cell) { return cell.sparse_vpls; })).mean;
    row.rmse = rmse_estimate(column(cells, [](const Cell& cell) { return cell.error.squared_error; }));
    row.relative_mse = mean_interval(column(cells, [](const Cell& cell) { return cell.error.relative_mse; }));
    row.mean_ratio = mean_interval(column(cells, [](const Cell& cell) { return cell.error.mean_ratio; }));
    row.flip = mean_interval(column(cells, [](const Cell& cell) { return cell.error.flip; }));
    row.bias_floor = bias_floor(cells);
    row.generate_seconds = median(column(cells, [](const Cell& cell) { return cell.generate_seconds; }));
    row.gather_seconds = median(column(cells, [](const Cell& cell) { return cell.gather_seconds; }));
    return row;
}

bool is_biased(const EqualVplsRow& row) {
    const double off = std::abs(row.mean_ratio.mean - 1.0);
    return row.method.policy == Policy::paper || off - row.mean_ratio.half_width > kBiasThatCounts;
}

}  // namespace

std::string noise_remark(const Reference& reference, std::span<const EqualVplsRow> rows) {
    if (!reference.noise.known) {
        return "the noise of the reference is unknown, so it is not subtracted from the errors";
    }
    const double noise = std::sqrt(reference.noise.mean_variance);
    const EqualVplsRow& best =
        *std::ranges::min_element(rows, {}, [](const EqualVplsRow& row) { return row.rmse.value; });
    if (noise <= kNoiseThatCounts * best.rmse.value) {
        return "";
    }
    std::string text = fmt::format(
        "the noise of the reference ({:.3g}) is more than a third of the smallest RMSE ({:.3g}, {})", noise,
        best.rmse.value, to_string(best.method));
    if (best.rmse.value > 0.0) {
        const double more = std::pow(noise / (kNoiseThatCounts * best.rmse.value), 2);
        text += fmt::format(
            "; about {:.0f} {} would be enough", more * static_cast<double>(reference.samples),
            reference.path_traced ? "samples per pixel of the reference" : "VPLs of the reference");
    } else {
        text += reference.path_traced ? "; give the reference more samples per pixel"
                                      : "; give the reference more VPLs";
    }
    return text +
           (reference.path_traced ? ", or use a reference of VPLs, whose noise is spread more evenly" : "");
}

std::size_t baseline_index(const CompareSettings& settings) {
    return static_cast<std::size_t>(std::ranges::find(settings.methods, settings.baseline) -
                                    settings.methods.begin());
}

std::vector<EqualVplsRow> equal_vpls_rows(const CompareSettings& settings, std::span<const Cell> cells) {
    std::vector<EqualVplsRow> rows;
    for (const uint vpls : settings.vpl_counts) {
        const std::size_t first = rows.size();
        for (const Method& method : settings.methods) {
            rows.push_back(row_of(method, vpls, cells));
        }
        const double standard = rows[first + baseline_index(settings)].rmse.value;
        for (std::size_t i = first; i < rows.size(); ++i) {
            rows[i].rmse_ratio =
                standard > 0.0 ? rows[i].rmse.value / standard : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return rows;
}

std::vector<Curve> curves_of(const CompareSettings& settings, std::span<const EqualVplsRow> rows) {
    std::vector<Curve> curves(settings.methods.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        Curve& curve = curves[i % curves.size()];
        const EqualVplsRow& row = rows[i];
        curve.points.push_back(
            {row.gathered_vpls, row.rmse.value, row.generate_seconds + row.gather_seconds});
        curve.biased = is_biased(row);  // the last row, with the largest count, decides
        curve.floor = row.bias_floor;
    }
    return curves;
}

}  // namespace nearlight::core
