// SPDX-License-Identifier: Apache-2.0
#include "host/compare/plots.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/files.h"
#include "host/base/message.h"

extern char** environ;

namespace nearlight::core {
namespace {

enum class Drawing { done, no_data, no_gnuplot, failed };

/// Runs gnuplot on a script, in the script's folder and without output.
Drawing run_gnuplot(const std::filesystem::path& script) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, script.parent_path().c_str());
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    std::string program = "gnuplot";
    std::string file = script.filename().string();
    const std::array<char*, 3> arguments{program.data(), file.data(), nullptr};
    pid_t child = 0;
    const int failed = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (failed != 0) {
        return Drawing::no_gnuplot;
    }
    const bool done = waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return done ? Drawing::done : Drawing::failed;
}

/// Why a plot is missing, as Plot::missing_because has it.
const char* reason_of(Drawing drawing) {
    switch (drawing) {
        case Drawing::done:
            return "";
        case Drawing::no_data:
            return "no RMSE is above the reference's noise";
        case Drawing::no_gnuplot:
            return "gnuplot is not installed";
        case Drawing::failed:
            return "gnuplot failed";
    }
    return "";
}

/// What to do about missing plots, as a continuation of the reason.
std::string advice_on(Drawing drawing, const std::filesystem::path& folder) {
    if (drawing == Drawing::no_gnuplot) {
        return "; with it, run `gnuplot *.gp` in " + folder.string();
    }
    return drawing == Drawing::failed ? "; see `gnuplot *.gp` in " + folder.string() : "";
}

/// A line of data with an error bar. On a logarithmic axis, a bar that reaches 0 is cut off at a tenth of the
/// value.
std::string data_line(const EqualVplsRow& row) {
    const RmseEstimate& rmse = row.rmse;
    const double low = std::isfinite(rmse.low) ? std::max(rmse.low, 0.1 * rmse.value) : rmse.value;
    const double high = std::isfinite(rmse.high) ? rmse.high : rmse.value;
    return fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n", row.gathered_vpls,
                       row.generate_seconds + row.gather_seconds, rmse.value, low, high);
}

/// Colours that can be told apart on white and on a dark page, where black becomes white, also by most people
/// with colour blindness [after Okabe and Ito, Color Universal Design, 2008].
constexpr std::array kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9",
                             "#e69f00", "#000000", "#9e5bc4", "#a6701f"};

/// Tics at 1, 2 and 5 times each power of ten between both bounds, for an axis that may be shorter than a
/// decade.
std::string tics_between(double low, double high) {
    std::string tics;
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0) {
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double value = factor * decade;
            if (value >= low && value <= high) {
                tics += fmt::format("{}{:.6g}", tics.empty() ? "" : ", ", value);
            }
        }
    }
    return "(" + tics + ")";
}

/// The axes' ranges and tics. By default gnuplot widens logarithmic axes to whole decades and labels only
/// those.
std::string axes(bool over_seconds, const CompareSettings& settings, std::span<const EqualVplsRow> rows) {
    constexpr double kFar = 1e300;
    double x_low = kFar, x_high = 0, y_low = kFar, y_high = 0;
    for (const EqualVplsRow& row : rows) {
        const double x = over_seconds ? row.generate_seconds + row.gather_seconds : row.gathered_vpls;
        if (row.rmse.value > 0.0 && x > 0.0) {
            x_low = std::min(x_low, x / 1.3);
            x_high = std::max(x_high, x * 1.3);
            y_low = std::min(y_low, row.rmse.value / 2.0);
            y_high = std::max(y_high, row.rmse.value * 2.0);
        }
    }
    if (x_high == 0.0) {
        return "";
    }
    const std::string x_tics = over_seconds ? tics_between(x_low, x_high)
                                            : fmt::format("({})", fmt::join(settings.vpl_counts, ", "));
    return fmt::format("set xrange [{:.4g}:{:.4g}]\nset xtics {}\nset yrange [{:.4g}:{:.4g}]\nset ytics {}\n",
                       x_low, x_high, x_tics, y_low, y_high, tics_between(y_low, y_high));
}

}  // namespace

std::string plot_script(const std::string& title, const std::string& stem, bool over_seconds,
                        const CompareSettings& settings, std::span<const EqualVplsRow> rows) {
    std::string text =
        fmt::format("# Columns: VPLs gathered, seconds (generate + gather), RMSE, its 95 % interval\n");
    std::string curves;
    for (std::size_t i = 0; i < settings.methods.size(); ++i) {
        const Method& method = settings.methods[i];
        text += fmt::format("${} << EOD\n", fmt::format("method{}", i));
        for (const EqualVplsRow& row : rows) {
            if (row.method == method && row.rmse.value > 0.0) {
                text += data_line(row);
            }
        }
        text += "EOD\n";
        curves += fmt::format(
            "{}$method{} using {}:3:4:5 with yerrorlines linewidth 2 linecolor rgb \"{}\" pointtype {} title "
            "\"{}\"",
            i > 0 ? ", \\\n     " : "plot ", i, over_seconds ? 2 : 1, kColors[i % kColors.size()], i % 12 + 4,
            to_string(method));
    }
    text += fmt::format(
        "set title \"{}\" noenhanced\nset logscale xy\nset grid\nset key outside right top vertical "
        "noenhanced\n"
        "set xlabel \"{}\"\nset ylabel \"RMSE of indirect light\"\nset format y \"%g\"\n",
        title, over_seconds ? "seconds (generate + gather)" : "VPLs gathered");
    text += axes(over_seconds, settings, rows);
    text += fmt::format("set terminal svg size 820,440 dynamic background \"white\" font \"sans,13\"\n");
    text += fmt::format("set output \"{}.svg\"\n{}\n", stem, curves);
    text += fmt::format(
        "set terminal pngcairo size 1230,660 font \"sans,13\"\nset output \"{}.png\"\nreplot\n", stem);
    return text;
}

std::vector<Plot> make_plots(const std::string& scene, const CompareSettings& settings,
                             std::span<const EqualVplsRow> rows, const std::filesystem::path& folder) {
    make_folder(folder);
    const bool has_data =
        std::ranges::any_of(rows, [](const EqualVplsRow& row) { return row.rmse.value > 0.0; });
    std::vector<Plot> plots;
    Drawing trouble = Drawing::done;
    for (const bool over_seconds : {false, true}) {
        const std::string stem = scene + (over_seconds ? "-rmse-seconds" : "-rmse-vpls");
        Plot plot{.title = scene + ": RMSE over " + (over_seconds ? "seconds" : "VPLs"),
                  .script = folder / (stem + ".gp")};
        write_text(plot.script, plot_script(plot.title, stem, over_seconds, settings, rows));
        const Drawing drawing = has_data ? run_gnuplot(plot.script) : Drawing::no_data;
        plot.missing_because = reason_of(drawing);
        if (drawing == Drawing::done) {
            plot.svg = folder / (stem + ".svg");
            plot.png = folder / (stem + ".png");
        } else {
            trouble = drawing;
        }
        plots.push_back(std::move(plot));
    }
    if (trouble != Drawing::done) {
        say_warning("the plots of scene '" + scene + "' are missing: " + reason_of(trouble) +
                    advice_on(trouble, folder));
    }
    return plots;
}

}  // namespace nearlight::core
