// SPDX-License-Identifier: Apache-2.0
#include "host/compare/report_markdown.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>

#include "host/compare/number_text.h"

namespace nearlight::core {
namespace {

std::string row(std::initializer_list<std::string> cells) {
    std::string text = "|";
    for (const std::string& cell : cells) {
        text += " " + cell + " |";
    }
    return text + "\n";
}

/// The header of a table whose first column has names, aligned left, and whose other columns have numbers,
/// aligned right.
std::string header(std::initializer_list<std::string> cells) {
    std::string rule = "| --- |";
    for (std::size_t i = 1; i < cells.size(); ++i) {
        rule += " ---: |";
    }
    return row(cells) + rule + "\n";
}

/// The picture in its small size, with its path relative to the report's folder.
std::string image(const PictureFile& file, const std::string& title) {
    return fmt::format("![{}](pictures/{})", title, file.small.filename().string());
}

std::string conditions(const SceneComparison& scene, const CompareSettings& settings) {
    const SceneFacts& facts = scene.facts;
    std::string text = fmt::format(
        "{} triangles, {}×{} pixels, {} seed{}, depth {}, close range up to {:.4g} m, clamp radius {:.4g} m. "
        "Reference: {}, {}",
        facts.triangles, settings.width, settings.height, settings.seed_count,
        settings.seed_count == 1 ? "" : "s", facts.max_depth, facts.range, facts.clamp_radius,
        scene.reference.method, samples_text(scene.reference));
    if (scene.reference.noise.known) {
        text += fmt::format("; its own noise, {:.2g}, is subtracted from the errors",
                            std::sqrt(scene.reference.noise.mean_variance));
    }
    const std::string remark = noise_remark(scene.reference, scene.equal_vpls);
    return text + ".\n" + (remark.empty() ? "" : "\n*Beware: " + remark + ".*\n");
}

std::string equal_vpls_table(const SceneComparison& scene) {
    std::string text = header({"equal VPLs", "requested", "gathered", "sparse", "RMSE ± 95 %", "÷ baseline",
                               "mean ratio ± 95 %", "FLIP", "generate, s", "gather, s"});
    for (const EqualVplsRow& entry : scene.equal_vpls) {
        text +=
            row({to_string(entry.method), std::to_string(entry.vpls), fixed_text(entry.gathered_vpls, 0),
                 fixed_text(entry.sparse_vpls, 0), interval_text(entry.rmse.value, entry.rmse.half_width, 3),
                 fixed_text(entry.rmse_ratio, 2),
                 interval_text(entry.mean_ratio.mean, entry.mean_ratio.half_width, 4),
                 number_text(entry.flip.mean, 2), fixed_text(entry.generate_seconds, 2),
                 fixed_text(entry.gather_seconds, 2)});
    }
    return text;
}

std::string equal_rmse_table(const SceneComparison& scene, const CompareSettings& settings) {
    if (scene.equal_rmse.empty()) {
        return {};
    }
    std::string text =
        header({"equal RMSE", "RMSE", "VPLs", "seconds", "VPLs ÷ baseline", "time ÷ baseline", "basis"});
    for (const EqualRmse& group : scene.equal_rmse) {
        for (const EqualRmseRow& entry : group.rows) {
            text +=
                row({to_string(settings.methods[entry.curve]), number_text(group.rmse),
                     fixed_text(entry.vpls, 0), fixed_text(entry.seconds, 2), fixed_text(entry.vpls_ratio, 1),
                     fixed_text(entry.time_ratio, 1), to_string(entry.reach)});
        }
    }
    return text + "\n";
}

std::string vpl_pictures(const SceneComparison& scene, const CompareSettings& settings) {
    std::string text = fmt::format(
        "Positions of {} VPLs (orange: placed on the close range, blue: left by light walks):\n\n",
        settings.vpl_counts.front());
    for (const VplFigure& figure : scene.figures.vpls) {
        text += image(figure.file, to_string(figure.method)) + "\n";
    }
    return text + "\n";
}

std::string method_pictures(const SceneComparison& scene, const CompareSettings& settings) {
    const uint count = settings.vpl_counts.front();
    std::string text = fmt::format(
        "Indirect light with {} VPLs, and its error relative to the reference (red: too bright, blue: too "
        "dark):\n\n",
        count);
    text += "| | picture | error |\n| --- | --- | --- |\n";
    text += row({"reference", image(scene.figures.reference, "reference"), ""});
    for (const MethodFigure& figure : scene.figures.methods) {
        if (figure.vpls == count) {
            const std::string name = to_string(figure.method);
            text += row({name, image(figure.picture, name), image(figure.error_map, "error of " + name)});
        }
    }
    return text + "\n";
}

}  // namespace

std::string comparison_markdown(const Comparison& comparison, const CompareSettings& settings) {
    std::string text = fmt::format("Device: {}. Baseline: {}. Seconds are medians over seeds.\n\n",
                                   comparison.device, to_string(settings.baseline));
    for (const SceneComparison& scene : comparison.scenes) {
        text += "## " + scene.facts.name + "\n\n" + conditions(scene, settings) + "\n";
        text += equal_vpls_table(scene) + "\n" + equal_rmse_table(scene, settings);
        text += vpl_pictures(scene, settings) + method_pictures(scene, settings);
    }
    return text;
}

}  // namespace nearlight::core
