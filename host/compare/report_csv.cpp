// SPDX-License-Identifier: Apache-2.0
#include "host/compare/report_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>

namespace nearlight::core {
namespace {

/// The fields that name scene and method. They contain neither commas nor quotes, because unique_names()
/// makes scene names usable for files.
std::string names_of(const SceneComparison& scene, const Method& method) {
    return fmt::format("{},{},{}", scene.facts.name, to_string(method.sampler),
                       method.policy ? to_string(*method.policy) : "");
}

std::string fields(std::initializer_list<double> numbers) {
    std::string text;
    for (const double number : numbers) {
        text += std::isfinite(number) ? fmt::format(",{:.9g}", number) : ",";
    }
    return text;
}

}  // namespace

std::string equal_vpls_csv(const Comparison& comparison) {
    std::string csv =
        "scene,sampler,policy,vpls,gathered_vpls,sparse_vpls,rmse,rmse_ci95,rmse_low,rmse_high,rmse_ratio,"
        "relative_mse,"
        "relative_mse_ci95,mean_ratio,mean_ratio_ci95,flip,flip_ci95,generate_s,gather_s\n";
    for (const SceneComparison& scene : comparison.scenes) {
        for (const EqualVplsRow& row : scene.equal_vpls) {
            csv += names_of(scene, row.method) +
                   fields({static_cast<double>(row.vpls), row.gathered_vpls, row.sparse_vpls, row.rmse.value,
                           row.rmse.half_width, row.rmse.low, row.rmse.high, row.rmse_ratio,
                           row.relative_mse.mean, row.relative_mse.half_width, row.mean_ratio.mean,
                           row.mean_ratio.half_width, row.flip.mean, row.flip.half_width,
                           row.generate_seconds, row.gather_seconds}) +
                   "\n";
        }
    }
    return csv;
}

std::string equal_rmse_csv(const Comparison& comparison, const CompareSettings& settings) {
    std::string csv = "scene,sampler,policy,rmse,vpls,seconds,vpls_ratio,time_ratio,reach\n";
    for (const SceneComparison& scene : comparison.scenes) {
        for (const EqualRmse& group : scene.equal_rmse) {
            for (const EqualRmseRow& row : group.rows) {
                csv += names_of(scene, settings.methods[row.curve]) +
                       fields({group.rmse, row.vpls, row.seconds, row.vpls_ratio, row.time_ratio}) + "," +
                       to_string(row.reach) + "\n";
            }
        }
    }
    return csv;
}

}  // namespace nearlight::core
