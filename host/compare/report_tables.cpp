// SPDX-License-Identifier: Apache-2.0
#include "host/compare/report_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "host/compare/number_text.h"

namespace nearlight::core {
namespace {

const HtmlAttributes kName{{"class", "name"}};
const HtmlAttributes kRowName{{"class", "name"}, {"scope", "row"}};

/// Opens a table, with its caption and the headers of its columns, as far as the body. Three elements are
/// then open.
void open_table(HtmlWriter& html, const std::string& caption, std::initializer_list<const char*> columns) {
    html.open("div", {{"class", "scroll"}}).open("table").element("caption", caption);
    html.open("thead").open("tr");
    for (const char* column : columns) {
        html.element("th", column, {{"scope", "col"}});
    }
    html.close().close().open("tbody");
}

/// Writes the sampler, which names the row, and its policy into two cells.
void write_method(HtmlWriter& html, const Method& method) {
    html.element("th", to_string(method.sampler), kRowName);
    html.element("td", method.policy ? to_string(*method.policy) : "–", kName);
}

void write_row(HtmlWriter& html, const EqualVplsRow& row, bool first_of_count, bool best) {
    html.open("tr", first_of_count ? HtmlAttributes{{"class", "first"}} : HtmlAttributes{});
    write_method(html, row.method);
    for (const double count : {static_cast<double>(row.vpls), row.gathered_vpls, row.sparse_vpls}) {
        html.element("td", fixed_text(count, 0));
    }
    html.element("td", interval_text(row.rmse.value, row.rmse.half_width),
                 best ? HtmlAttributes{{"class", "best"}} : HtmlAttributes{});
    html.element("td", fixed_text(row.rmse_ratio, 2));
    html.element("td", number_text(row.relative_mse.mean));
    html.element("td", interval_text(row.mean_ratio.mean, row.mean_ratio.half_width, 4));
    html.element("td", number_text(row.flip.mean));
    html.element("td", fixed_text(row.generate_seconds, 3)).element("td", fixed_text(row.gather_seconds, 3));
    html.close();
}

void write_row(HtmlWriter& html, const EqualRmse& group, const EqualRmseRow& row, const Method& method,
               bool first) {
    const bool never = row.reach == Reach::never;
    html.open("tr", first ? HtmlAttributes{{"class", "first"}} : HtmlAttributes{});
    html.element("td", first ? number_text(group.rmse) : "");
    write_method(html, method);
    for (const std::string& text : {fixed_text(row.vpls, 0), fixed_text(row.seconds, 3),
                                    fixed_text(row.vpls_ratio, 2), fixed_text(row.time_ratio, 2)}) {
        html.element("td", text);
    }
    html.element("td", to_string(row.reach), {{"class", never ? "name never" : "name"}});
    html.close();
}

/// The row whose RMSE is certainly the least: its interval lies below those of all others. None if there is
/// no other row, or if intervals overlap or are unknown.
const EqualVplsRow* best_of(std::span<const EqualVplsRow> rows) {
    const auto least =
        std::ranges::min_element(rows, {}, [](const EqualVplsRow& row) { return row.rmse.value; });
    const bool is_certain = std::ranges::all_of(
        rows, [&](const EqualVplsRow& row) { return &row == &*least || least->rmse.high < row.rmse.low; });
    return rows.size() > 1 && is_certain ? &*least : nullptr;
}

/// Geometric mean of the ratios of one method, and the number of ratios that do not exist.
class RatioMean {
  public:
    /// `missing` says what it means that a ratio does not exist.
    explicit RatioMean(const char* missing) : missing_text_(missing) {}
    void add(double ratio) {
        if (std::isfinite(ratio) && ratio > 0.0) {
            logarithms_ += std::log(ratio);
            ++count_;
        } else {
            ++missing_;
        }
    }
    [[nodiscard]] std::string text() const {
        const std::string mean = count_ > 0 ? fixed_text(std::exp(logarithms_ / count_), 2) : "";
        const std::string missing =
            missing_ > 0 ? fmt::format("{} in {} of {}", missing_text_, missing_, missing_ + count_) : "";
        return count_ + missing_ == 0 ? "–" : mean + (mean.empty() || missing.empty() ? "" : ", ") + missing;
    }

  private:
    const char* missing_text_;
    double logarithms_ = 0;
    int count_ = 0;
    int missing_ = 0;
};

void write_summary_row(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings,
                       std::size_t index) {
    RatioMean rmse("below the noise of the reference");
    RatioMean vpls("never");
    RatioMean time("never");
    for (std::size_t i = index; i < scene.equal_vpls.size(); i += settings.methods.size()) {
        rmse.add(scene.equal_vpls[i].rmse_ratio);
    }
    for (const EqualRmse& group : scene.equal_rmse) {
        vpls.add(group.rows[index].vpls_ratio);
        time.add(group.rows[index].time_ratio);
    }
    html.open("tr", index == 0 ? HtmlAttributes{{"class", "first"}} : HtmlAttributes{});
    html.element("td", index == 0 ? scene.facts.name : "", kName);
    write_method(html, settings.methods[index]);
    html.element("td", rmse.text()).element("td", vpls.text()).element("td", time.text()).close();
}

}  // namespace

void write_summary_table(HtmlWriter& html, const Comparison& comparison, const CompareSettings& settings) {
    open_table(html, "Geometric means over all numbers of VPLs; below 1 is better than the baseline.",
               {"scene", "sampler", "policy", "RMSE ÷ baseline, equal VPLs", "VPLs ÷ baseline, equal RMSE",
                "time ÷ baseline, equal RMSE"});
    for (const SceneComparison& scene : comparison.scenes) {
        for (std::size_t i = 0; i < settings.methods.size(); ++i) {
            write_summary_row(html, scene, settings, i);
        }
    }
    html.close().close().close();
}

void write_equal_vpls_table(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings) {
    open_table(html, "Green: certainly the best at this number of VPLs, by the intervals of RMSE.",
               {"sampler", "policy", "VPLs requested", "gathered", "sparse", "RMSE ± 95 %", "÷ baseline",
                "relative MSE", "mean ratio ± 95 %", "FLIP", "generate, s", "gather, s"});
    const std::size_t methods = settings.methods.size();
    for (std::size_t i = 0; i < scene.equal_vpls.size(); ++i) {
        const EqualVplsRow* const best =
            best_of(std::span(scene.equal_vpls).subspan(i / methods * methods, methods));
        const EqualVplsRow& row = scene.equal_vpls[i];
        write_row(html, row, i % methods == 0, &row == best);
    }
    html.close().close().close();
}

void write_equal_rmse_table(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings) {
    if (scene.equal_rmse.empty()) {
        html.element("p", "There is no table of equal RMSE: its fits need at least two counts of VPLs.");
        return;
    }
    open_table(
        html, "What each sampler needs for an RMSE that the baseline reached.",
        {"RMSE", "sampler", "policy", "VPLs", "seconds", "VPLs ÷ baseline", "time ÷ baseline", "basis"});
    for (const EqualRmse& group : scene.equal_rmse) {
        for (const EqualRmseRow& row : group.rows) {
            write_row(html, group, row, settings.methods[row.curve], row.curve == 0);
        }
    }
    html.close().close().close();
}

}  // namespace nearlight::core
