// SPDX-License-Identifier: Apache-2.0
#include "host/compare/report_figures.h"

#include <fmt/format.h>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/compare/inline_svg.h"
#include "host/compare/pictures.h"

namespace nearlight::core {
namespace {

constexpr const char* kPng = "image/png";

std::string css_color(Vec3 encoded) {
    return fmt::format("rgb({:.0f},{:.0f},{:.0f})", 255.0f * encoded.x, 255.0f * encoded.y,
                       255.0f * encoded.z);
}

void write_crops(HtmlWriter& html, const std::vector<std::filesystem::path>& crops,
                 const std::vector<double>& rmse, const std::string& whose) {
    html.open("div", {{"class", "crops"}});
    for (std::size_t i = 0; i < crops.size(); ++i) {
        html.open("figure");
        html.image(crops[i], kPng, fmt::format("crop {} of {}", i + 1, whose), {{"class", "crop"}});
        html.element("figcaption",
                     i < rmse.size() ? fmt::format("RMSE {:.3g}", rmse[i]) : fmt::format("crop {}", i + 1));
        html.close();
    }
    html.close();
}

void write_scale_bar(HtmlWriter& html) {
    const std::string gradient = "background:linear-gradient(to right," + css_color(error_color(-1)) + "," +
                                 css_color(error_color(0)) + "," + css_color(error_color(1)) + ")";
    html.open("div", {{"class", "scale"}});
    html.element("span", fmt::format("−{:.0f} % light missing", 100.0f * kErrorMapLimit));
    html.element("span", "", {{"class", "bar"}, {"style", gradient}});
    html.element("span", fmt::format("+{:.0f} % too much", 100.0f * kErrorMapLimit));
    html.close();
}

void write_reference_column(HtmlWriter& html, const SceneFigures& figures) {
    html.open("td").image(figures.reference.small, kPng, "reference", {{"class", "picture"}});
    write_crops(html, figures.reference_crops, {}, "the reference");
    html.close();
}

void write_method_column(HtmlWriter& html, const MethodFigure& figure, double rmse) {
    const std::string whose = fmt::format("{} with {} VPLs", to_string(figure.method), figure.vpls);
    html.open("td").image(figure.picture.small, kPng, whose, {{"class", "picture"}});
    html.image(figure.error_map.small, kPng, "signed error of " + whose, {{"class", "picture"}});
    html.element("div", fmt::format("RMSE {:.3g}", rmse), {{"class", "caption"}});
    write_crops(html, figure.crops, figure.crop_rmse, whose);
    html.close();
}

}  // namespace

void write_plots(HtmlWriter& html, const SceneComparison& scene) {
    html.open("div", {{"class", "plots"}});
    for (const Plot& plot : scene.plots) {
        if (plot.svg.empty()) {
            const std::string script =
                plot.script.empty()
                    ? ""
                    : "; its script is " + plot.script.filename().string() + " in the folder plots";
            html.element("p",
                         plot.title + ": the plot is missing because " + plot.missing_because + script + ".");
        } else {
            html.open("div", {{"class", "plot"}})
                .markup(inline_svg(read_bytes(plot.svg), plot.title,
                                   "plot-" + hex_digits(hash64(plot.script.stem().string()))))
                .close();
        }
    }
    html.close();
}

void write_vpl_figures(HtmlWriter& html, const SceneComparison& scene) {
    html.open("div", {{"class", "figures"}});
    for (const VplFigure& figure : scene.figures.vpls) {
        html.open("figure").image(figure.file.small, kPng, "VPLs of " + to_string(figure.method),
                                  {{"class", "dots"}});
        html.element("figcaption",
                     fmt::format("{}: {} VPLs, {} in the picture, {} of them not hidden",
                                 to_string(figure.method), figure.vpls, figure.in_picture, figure.visible));
        html.close();
    }
    html.close();
}

void write_method_figures(HtmlWriter& html, const SceneComparison& scene, const CompareSettings& settings) {
    write_scale_bar(html);
    html.open("div", {{"class", "scroll"}}).open("table", {{"class", "pictures"}});
    const HtmlAttributes of_column{{"scope", "col"}};
    html.open("thead").open("tr").element("th", "VPLs", of_column).element("th", "reference", of_column);
    for (const Method& method : settings.methods) {
        html.element("th", to_string(method), of_column);
    }
    html.close().close().open("tbody");
    const std::size_t methods = settings.methods.size();
    for (std::size_t i = 0; i < scene.figures.methods.size(); ++i) {
        if (i % methods == 0) {
            html.open("tr").element("th", std::to_string(scene.figures.methods[i].vpls), {{"scope", "row"}});
            write_reference_column(html, scene.figures);
        }
        write_method_column(html, scene.figures.methods[i], scene.equal_vpls[i].rmse.value);
        if (i % methods == methods - 1) {
            html.close();
        }
    }
    html.close().close().close();
}

}  // namespace nearlight::core
