// SPDX-License-Identifier: Apache-2.0
#include "host/compare/report_html.h"

#include <fmt/format.h>

#include <cmath>

#include "host/compare/report_figures.h"
#include "host/compare/report_tables.h"

namespace nearlight::core {
namespace {

constexpr std::string_view kStyle =
    R"(:root { color-scheme: light dark; --line: #8886; --good: #0a7d3244; --bad: #c33; }
@media screen and (prefers-color-scheme: dark) { :root { --bad: #ff7b72; } }
body { font: clamp(15px, 0.6vw + 8px, 22px)/1.45 system-ui, sans-serif; max-width: 1500px; margin: 1.5em auto; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { margin-top: 2em; border-bottom: 1px solid var(--line); } h3 { margin-top: 1.6em; }
p, dl { max-width: 75em; }
dt { font-weight: 600; } dd { margin: 0 0 .5em 1.5em; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15em .6em; text-align: right; vertical-align: top; }
caption { text-align: left; font-size: .9em; padding-bottom: .3em; } tbody th { font-weight: inherit; }
thead th { border-bottom: 1px solid var(--line); vertical-align: bottom; }
tr.first td, tr.first th { border-top: 1px solid var(--line); }
td.name, th.name { text-align: left; } td.best { background: var(--good); font-weight: 600; } td.never { color: var(--bad); }
table.pictures td, table.pictures th { text-align: center; padding: .3em; border-bottom: 1px solid var(--line); }
img.picture { display: block; width: 200px; image-rendering: auto; margin-bottom: 3px; }
img.crop { width: 97px; image-rendering: pixelated; display: block; }
img.dots { width: 300px; } .plot { overflow-x: auto; max-width: 100%; } .plot svg { display: block; width: 46em; min-width: 560px; }
.crops, .figures, .plots { display: flex; flex-wrap: wrap; gap: 6px; } .figures, .plots { gap: 14px; }
.crops { width: 200px; }
figure { margin: 0; } .figures figure { width: 300px; }
.remark { color: var(--bad); }
figcaption, .caption { font-size: .8em; }
.scale { display: flex; gap: .6em; align-items: center; font-size: .85em; margin: .5em 0; }
.scale .bar { display: inline-block; width: 220px; height: 12px; border: 1px solid var(--line); }
@media print { body { max-width: none; font-size: 10px; } .scroll { overflow: visible; } figure, tr { break-inside: avoid; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)";

void write_pair(HtmlWriter& html, const std::string& term, const std::string& meaning) {
    html.element("dt", term).element("dd", meaning);
}

std::string reference_text(const Reference& reference) {
    const std::string noise =
        reference.noise.known
            ? fmt::format("its own noise is {:.3g} (RMS)", std::sqrt(reference.noise.mean_variance))
            : std::string("its own noise is unknown and not subtracted");
    return fmt::format("{}, {}{}; {}", reference.method, samples_text(reference),
                       reference.file.empty() ? "" : " (" + reference.file + ")", noise);
}

std::string scene_text(const SceneComparison& scene) {
    const SceneFacts& facts = scene.facts;
    return fmt::format(
        "{}, {} triangles; clamp radius {:.4g} m, depth {}, close range up to {:.4g} m; "
        "reference: {}",
        facts.source, facts.triangles, facts.clamp_radius, facts.max_depth, facts.range,
        reference_text(scene.reference));
}

/// The name of a scene's section, for links. Scenes may have any names, so their place in the list serves.
std::string section_name(std::size_t scene) {
    return "scene-" + std::to_string(scene + 1);
}

void write_contents(HtmlWriter& html, const Comparison& comparison) {
    html.open("nav", {{"aria-label", "contents"}}).open("ul");
    const auto link = [&html](const std::string& section, const std::string& title) {
        html.open("li").element("a", title, {{"href", "#" + section}}).close();
    };
    link("summary", "In short");
    for (std::size_t i = 0; i < comparison.scenes.size(); ++i) {
        link(section_name(i), comparison.scenes[i].facts.name);
    }
    link("meanings", "What the numbers mean");
    html.close().close();
}

void write_conditions(HtmlWriter& html, const Comparison& comparison, const CompareSettings& settings) {
    html.open("dl");
    write_pair(html, "Device", comparison.device + ", driver " + comparison.driver);
    write_pair(
        html, "Pictures",
        fmt::format("{}×{} pixels, {} sample{} per pixel{}; indirect light only", settings.width,
                    settings.height, settings.samples_per_pixel, settings.samples_per_pixel == 1 ? "" : "s",
                    settings.samples_per_pixel == 1 ? ", at its centre" : ""));
    write_pair(html, "Seeds",
               fmt::format("{}, starting at {}; the same for all methods", settings.seed_count,
                           settings.first_seed));
    write_pair(html, "Baseline",
               to_string(settings.baseline) + ": ratios are a method's number ÷ the baseline's");
    for (const SceneComparison& scene : comparison.scenes) {
        write_pair(html, "Scene " + scene.facts.name, scene_text(scene));
    }
    write_pair(html, "Program", "nearlight " + settings.program_version);
    write_pair(html, "Written", settings.date);
    html.element("dt", "Command").open("dd").element("code", settings.command_line).close();
    html.close();
}

void write_meanings(HtmlWriter& html) {
    html.element("h2", "What the numbers mean", {{"id", "meanings"}}).open("dl");
    write_pair(html, "RMSE",
               "Root of the mean squared difference from the reference over pixels and R, G, B, as in the "
               "paper; over seeds, the root of the mean of the squares. The mean variance of the reference's "
               "own noise is subtracted first.");
    write_pair(
        html, "± 95 %",
        "Half the width of the 95 % confidence interval over seeds (Student's t). Methods whose intervals "
        "do not overlap differ; where they overlap, that is not decided. More seeds make intervals "
        "narrower.");
    write_pair(html, "relative MSE",
               "Mean of squared difference ÷ (squared reference + 0.01), so that dark corners count as much "
               "as bright walls. The reference's noise is subtracted here too.");
    write_pair(
        html, "mean ratio",
        "All light in the picture ÷ all light in the reference. Without bias, 19 of 20 intervals contain 1, "
        "as far as the reference is exact; intervals that stay below 1 mean that light is lost.");
    write_pair(html, "FLIP",
               "How different the two pictures look when one flips between them, from 0 to 1, at 67 pixels "
               "per degree of visual angle, both with the same exposure. Lower is better.");
    write_pair(html, "VPLs",
               "Requested, gathered (every pixel sums over these) and sparse (these only light other VPLs). "
               "Gathered VPLs cost time at every pixel, sparse ones only once.");
    write_pair(html, "seconds",
               "Medians over seeds. Generate: view, pilots and VPLs; gather: camera rays, shadow rays and "
               "film. One-off costs of a scene (compiling, tree, upload) are excluded.");
    write_pair(html, "equal RMSE",
               "For each RMSE that the baseline reached: the VPLs and seconds that a method needs for it, "
               "from straight lines through log RMSE and log seconds over log VPLs gathered.");
    write_pair(html, "basis",
               "Measured; fitted, which is within twice the measured range; extrapolated, which is beyond it "
               "and gives an order of magnitude; never: the method's error does not fall, or not within a "
               "hundred times the measured range, or cannot fall to this RMSE because light is lost, or it "
               "is biased, and this RMSE lies beyond twice the measured range.");
    html.close();
}

void write_scene_facts(HtmlWriter& html, const SceneComparison& scene) {
    html.open("figure")
        .image(scene.figures.overview.small, "image/png", scene.facts.name, {{"class", "picture"}})
        .close();
    html.element("p", scene_text(scene) + ".");
    html.element("p", fmt::format("One-off cost, excluded below: {:.2f} s for the tree, "
                                  "{:.2f} s for compiling kernels.",
                                  scene.facts.setup.build_bvh, scene.facts.setup.compile));
    if (const std::string remark = noise_remark(scene.reference, scene.equal_vpls); !remark.empty()) {
        html.element("p", "Beware: " + remark + ".", {{"class", "remark"}});
    }
}

void write_scene(HtmlWriter& html, const SceneComparison& scene, const std::string& name,
                 const CompareSettings& settings) {
    html.open("section", {{"id", name}}).element("h2", scene.facts.name);
    write_scene_facts(html, scene);
    html.element("h3", "Equal numbers of VPLs");
    write_equal_vpls_table(html, scene, settings);
    html.element("h3", "Equal RMSE");
    write_equal_rmse_table(html, scene, settings);
    html.element("h3", "Convergence");
    write_plots(html, scene);
    html.element("h3", fmt::format("Positions of the VPLs, {} requested", settings.vpl_counts.front()));
    html.element("p",
                 "Orange dots are VPLs placed on surfaces of the close range, blue dots those left by light "
                 "walks. Dots behind something are small and faint. VPLs that are missing from the picture "
                 "lie beside or behind the camera.");
    write_vpl_figures(html, scene);
    html.element("h3", "Indirect light");
    html.element("p",
                 fmt::format("The first seed: the picture, below it the error relative to the reference, and "
                             "then {} of the picture enlarged. All pictures have the same exposure.",
                             scene.figures.crops.size() == 1 ? "a part" : "parts"));
    write_method_figures(html, scene, settings);
    html.close();
}

}  // namespace

std::string comparison_html(const Comparison& comparison, const CompareSettings& settings) {
    HtmlWriter html("nearlight: comparison of VPL samplers", kStyle);
    html.element("h1", "Comparison of VPL samplers");
    write_contents(html, comparison);
    write_conditions(html, comparison, settings);
    html.element("h2", "In short", {{"id", "summary"}});
    write_summary_table(html, comparison, settings);
    for (std::size_t i = 0; i < comparison.scenes.size(); ++i) {
        write_scene(html, comparison.scenes[i], section_name(i), settings);
    }
    write_meanings(html);
    return html.finish();
}

}  // namespace nearlight::core
