// SPDX-License-Identifier: Apache-2.0
// Tests the JSON, CSV, HTML and Markdown of a comparison with chosen numbers.
#include "host/compare/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "host/base/files.h"
#include "host/compare/pictures.h"
#include "host/compare/plots.h"
#include "host/compare/report_csv.h"
#include "host/image/image_io.h"
#include "tests/compare/methods.h"
#include "tests/image/environment_variable.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::size_t value = digits.find(c);
        if (value == std::string::npos) {
            break;
        }
        bits = bits << 6u | static_cast<unsigned>(value);
        if ((count += 6) >= 8) {
            bytes += static_cast<char>(bits >> (count -= 8) & 255u);
        }
    }
    return bytes;
}

/// The page without encoded data, which may contain any words.
std::string without_pictures(std::string page) {
    const std::string mark = ";base64,";
    for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
        page.erase(at + mark.size(), page.find('"', at) - at - mark.size());
    }
    return page;
}

class Report : public testing::Test {
  protected:
    Report() {
        settings_.output = folder_.path();
        settings_.methods = {default_method(), kWalks};
        settings_.vpl_counts = {100, 200};
        settings_.seed_count = 3;
        settings_.program_version = "0.0";
        comparison_ = {.device = "a <device> & co", .driver = "1", .measured_cells = 5, .reused_cells = 7};
        comparison_.scenes.push_back(make_scene());
    }

    PictureFile picture(const std::string& name) {
        const std::filesystem::path file = folder_ / (name + ".png");
        Image image = make_picture(4, 3);
        image.at(1, 1, 0) = 0.5f;
        write_image(file, image);
        return {file, file};
    }

    SceneComparison make_scene() {
        SceneComparison scene{
            .facts = {.name = "desk", .source = "a<b>.xml", .hash = 17, .triangles = 12},
            .reference = {.picture = make_picture(4, 3), .method = "path tracing", .samples = 256}};
        scene.reference.noise = {.known = true, .mean_variance = 1e-8};
        for (const uint vpls : settings_.vpl_counts) {
            for (const Method& method : settings_.methods) {
                const double rmse = (method == kWalks ? 2.0 : 1.0) / vpls;
                scene.equal_vpls.push_back({.method = method,
                                            .vpls = vpls,
                                            .gathered_vpls = vpls - 1.5,
                                            .rmse = {rmse, kNan, rmse, rmse},
                                            .rmse_ratio = method == kWalks ? 2.0 : 1.0,
                                            .mean_ratio = {0.99, 0.02},
                                            .generate_seconds = 0.25,
                                            .gather_seconds = 0.5});
                scene.figures.methods.push_back({.method = method,
                                                 .vpls = vpls,
                                                 .picture = picture("p"),
                                                 .error_map = picture("e"),
                                                 .crops = {picture("c").full},
                                                 .crop_rmse = {0.125}});
            }
        }
        scene.equal_rmse = {
            {0.01, {{0, Reach::measured, 98.5, 0.75, 1.0, 1.0}, {1, Reach::never, kNan, kNan, kNan, kNan}}}};
        scene.figures.overview = picture("o");
        scene.figures.reference = picture("r");
        scene.figures.crops = {{0, 0, 2, 2}};
        scene.figures.reference_crops = {picture("rc").full};
        scene.figures.vpls = {{default_method(), 98, 50, 40, picture("v")}};
        write_text(folder_ / "plot.svg",
                   "<svg xmlns=\"http://www.w3.org/2000/svg\"><path stroke='black'/></svg>");
        scene.plots = {
            {.title = "RMSE", .script = folder_ / "plot.gp", .svg = folder_ / "plot.svg"},
            {.title = "missing", .script = folder_ / "missing.gp", .missing_because = "gnuplot failed"},
            {.title = "unwritten", .script = {}, .missing_because = "the disk is full"}};
        return scene;
    }
    [[nodiscard]] std::string html() const {
        write_report(comparison_, settings_);
        return read_bytes(folder_ / "report.html");
    }

    TemporaryFolder folder_;
    CompareSettings settings_;
    Comparison comparison_;
};

TEST_F(Report, JsonHoldsTheContract) {
    const nlohmann::json json = nlohmann::json::parse(write_report(comparison_, settings_));
    EXPECT_EQ(json, nlohmann::json::parse(read_bytes(folder_ / "compare.json")));
    const auto& scene = json.at("scenes").at(0);
    EXPECT_EQ(scene.at("name"), "desk");
    EXPECT_EQ(scene.at("triangles"), 12);
    EXPECT_EQ(scene.at("reference").at("samples"), 256);
    EXPECT_NEAR(scene.at("reference").at("noise").get<double>(), 1e-4, 1e-12);
    const auto& row = scene.at("equal_vpls").at(1);
    EXPECT_EQ(scene.at("equal_vpls").size(), 4u);
    EXPECT_EQ(row.at("sampler"), "instant-radiosity");
    EXPECT_TRUE(row.at("policy").is_null());
    EXPECT_EQ(row.at("vpls"), 100);
    EXPECT_EQ(row.at("rmse"), 0.02);
    EXPECT_TRUE(row.at("rmse_ci95").is_null());
    EXPECT_EQ(row.at("mean_ratio"), 0.99);
    EXPECT_EQ(row.at("generate_s"), 0.25);
    EXPECT_EQ(row.at("gather_s"), 0.5);
    const auto& own = scene.at("equal_rmse").at(0).at("rows").at(0);
    EXPECT_EQ(scene.at("equal_rmse").at(0).at("rmse"), 0.01);
    EXPECT_EQ(own.at("sampler"), "close-range");
    EXPECT_EQ(own.at("policy"), to_string(*default_method().policy));
    EXPECT_EQ(own.at("vpls"), 98.5);
    EXPECT_EQ(own.at("seconds"), 0.75);
    EXPECT_EQ(own.at("vpls_ratio"), 1.0);
    EXPECT_EQ(own.at("time_ratio"), 1.0);
    const auto& rival = scene.at("equal_rmse").at(0).at("rows").at(1);
    EXPECT_TRUE(rival.at("vpls").is_null());
    EXPECT_EQ(rival.at("reach"), "never");
}

TEST_F(Report, CsvHasAsManyFieldsInEachLineAsInItsHead) {
    for (const std::string& csv : {equal_vpls_csv(comparison_), equal_rmse_csv(comparison_, settings_)}) {
        std::istringstream lines(csv);
        std::string head, line;
        std::getline(lines, head);
        int count = 0;
        while (std::getline(lines, line)) {
            EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(head, ',')) << line;
            ++count;
        }
        EXPECT_GT(count, 1);
    }
    EXPECT_NE(equal_vpls_csv(comparison_).find("\ndesk,instant-radiosity,,200,198.5,0,0.01,,"),
              std::string::npos);
    EXPECT_NE(equal_rmse_csv(comparison_, settings_).find("\ndesk,instant-radiosity,,0.01,,,,,never\n"),
              std::string::npos);
}

TEST_F(Report, MarkdownHasRowsAsWideAsTheirHeadAndPicturesThatAreThere) {
    write_report(comparison_, settings_);
    const std::string text = read_bytes(folder_ / "report.md");
    std::istringstream lines(text);
    std::string line;
    std::ptrdiff_t columns = 0;
    int rows = 0;
    while (std::getline(lines, line)) {
        const auto bars = std::ranges::count(line, '|');
        if (bars > 0 && columns > 0) {
            EXPECT_EQ(bars, columns) << line;
            ++rows;
        }
        columns = bars;
    }
    EXPECT_GE(rows, 4 + 2 + 3);
    EXPECT_NE(text.find("| instant-radiosity | 200 | 198 | 0 | 0.01 | 2.00 | 0.99 ± 0.02 |"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("| instant-radiosity | 0.01 | – | – | – | – | never |"), std::string::npos) << text;
    const std::regex pictures(R"(\]\(pictures/([^)]+)\))");
    int count = 0;
    for (std::sregex_iterator match(text.begin(), text.end(), pictures), end; match != end;
         ++match, ++count) {
        EXPECT_TRUE(std::filesystem::exists(folder_ / (*match)[1].str())) << (*match)[1];
    }
    EXPECT_EQ(count, 1 + 1 + 4);
}

TEST_F(Report, HtmlNeedsNoNetwork) {
    const std::string page = without_pictures(html());
    EXPECT_EQ(page.find("http"), std::string::npos);
    EXPECT_EQ(page.find("//"), std::string::npos);
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_EQ(page.find("<link"), std::string::npos);
    EXPECT_EQ(page.find("url("), std::string::npos);
    const std::regex source("(src|href)=\"([^\"]{0,12})");
    for (std::sregex_iterator match(page.begin(), page.end(), source), end; match != end; ++match) {
        const std::string place = (*match)[2];
        EXPECT_TRUE(place.starts_with("data:image/") || place.starts_with("#")) << place;
    }
    EXPECT_NE(page.find("src=\"data:image/png;base64,\""), std::string::npos);
}

TEST_F(Report, EveryPictureInTheHtmlDecodes) {
    const std::string page = html();
    const std::string mark = "src=\"data:image/png;base64,";
    int count = 0;
    for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1), ++count) {
        const std::size_t begin = at + mark.size();
        std::ofstream(folder_ / "decoded.png", std::ios::binary)
            << decoded(page.substr(begin, page.find('"', begin) - begin));
        const Image image = read_image(folder_ / "decoded.png");
        EXPECT_EQ(image.width, 4);
        EXPECT_NEAR(image.at(1, 1, 0), 188.0 / 255.0, 1e-3);  // 0.5 in sRGB
    }
    // The pictures are the overview and the VPLs, and for each count the reference and its crop, and for each
    // of two methods its picture, error map and crop.
    EXPECT_EQ(count, 2 + 2 * (2 + 2 * 3));
}

TEST_F(Report, PlotsArePartsOfThePage) {
    EXPECT_NE(html().find("<svg role=\"img\" aria-label=\"RMSE\"><path stroke='currentColor'/></svg>"),
              std::string::npos);
}

TEST_F(Report, OnlyWhatIsCertainlyBestIsMarked) {
    const auto marks = [&] {
        const std::string page = html();
        const std::string mark = "<td class=\"best\">";
        int count = 0;
        for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
            ++count;
        }
        return count;
    };
    EXPECT_EQ(marks(), 2);  // one at each number of VPLs
    comparison_.scenes[0].equal_vpls[0].rmse.high = 0.015;
    EXPECT_EQ(marks(), 2);
    comparison_.scenes[0].equal_vpls[0].rmse.high = 0.025;  // above the other sampler's 0.02
    EXPECT_EQ(marks(), 1);
    comparison_.scenes[0].equal_vpls[2].rmse.high = kNan;  // a single seed
    EXPECT_EQ(marks(), 0);
}

TEST_F(Report, HtmlHasContentsHeadersAndItsOrigin) {
    settings_.command_line = "nearlight compare 'a & b.xml' -o x";
    settings_.date = "2026-11-23 10:50 UTC";
    const std::string page = html();
    for (const char* part :
         {"<a href=\"#summary\">In short</a>", "<a href=\"#scene-1\">desk</a>", "<section id=\"scene-1\">",
          "<code>nearlight compare &#39;a &amp; b.xml&#39; -o x</code>", "<dd>2026-11-23 10:50 UTC</dd>",
          "<th scope=\"col\">RMSE ± 95 %</th>", "<caption>",
          "<th class=\"name\" scope=\"row\">instant-radiosity</th>"}) {
        EXPECT_NE(page.find(part), std::string::npos) << part;
    }
}

TEST_F(Report, HtmlIsWellFormedAndEscaped) {
    const std::string page = html();
    std::vector<std::string> open;
    const std::regex tags("<(/?)([a-z0-9]+)[^>]*>");
    for (std::sregex_iterator match(page.begin(), page.end(), tags), end; match != end; ++match) {
        const std::string name = (*match)[2];
        if ((*match)[1].length() > 0) {
            ASSERT_FALSE(open.empty()) << name;
            ASSERT_EQ(open.back(), name);
            open.pop_back();
        } else if (name != "img" && name != "meta" && !match->str().ends_with("/>")) {
            open.push_back(name);
        }
    }
    EXPECT_TRUE(open.empty());
    EXPECT_NE(page.find("a &lt;device&gt; &amp; co"), std::string::npos);
    EXPECT_NE(page.find("a&lt;b&gt;.xml"), std::string::npos);
}

TEST_F(Report, HtmlSaysWhatIsMissingAndWhatNeverHappens) {
    const std::string page = html();
    EXPECT_NE(
        page.find("missing: the plot is missing because gnuplot failed; its script is missing.gp in the "
                  "folder plots."),
        std::string::npos);
    EXPECT_NE(page.find("unwritten: the plot is missing because the disk is full.</p>"), std::string::npos);
    EXPECT_NE(page.find(">never</td>"), std::string::npos);
    EXPECT_NE(page.find(">never in 1 of 1</td>"), std::string::npos);
    EXPECT_NE(page.find("<td class=\"name\">–</td><td>2.00</td>"), std::string::npos);  // RMSE ÷ baseline
    EXPECT_EQ(page.find(">nan<"), std::string::npos);
    EXPECT_EQ(page.find("Beware"), std::string::npos);
    comparison_.scenes[0].reference.noise.known = false;
    EXPECT_NE(html().find("Beware"), std::string::npos);
    comparison_.scenes[0].equal_rmse.clear();
    EXPECT_NE(html().find("at least two counts"), std::string::npos);
}

TEST_F(Report, APictureThatIsGoneIsAnError) {
    std::filesystem::remove(folder_ / "o.png");
    EXPECT_THROW(write_report(comparison_, settings_), Error);
}

/// The plots of a row with this RMSE, where `gnuplot` is what the script says, or not there if it is empty.
std::vector<Plot> plots_of(double rmse, const std::string& gnuplot) {
    const TemporaryFolder folder;
    const EnvironmentVariable path("PATH", folder.path().string());
    if (!gnuplot.empty()) {
        write_text(folder / "gnuplot", gnuplot);
        std::filesystem::permissions(folder / "gnuplot", std::filesystem::perms::owner_all);
    }
    CompareSettings settings;
    settings.methods = {kWalks};
    const std::vector<EqualVplsRow> rows{
        {.method = kWalks, .vpls = 100, .gathered_vpls = 98, .rmse = {rmse, 0.1, 0.0, 0.7}}};
    return make_plots("desk", settings, rows, folder / "plots");
}

TEST(Plots, SayWhyTheyAreMissing) {
    const auto reason = [](double rmse, const std::string& gnuplot) {
        const std::vector<Plot> plots = plots_of(rmse, gnuplot);
        EXPECT_EQ(plots.size(), 2u);
        EXPECT_EQ(plots[0].svg.empty(), !plots[0].missing_because.empty());
        EXPECT_EQ(plots[0].missing_because, plots[1].missing_because);
        return plots[0].missing_because;
    };
    EXPECT_EQ(reason(0.5, ""), "gnuplot is not installed");
    EXPECT_EQ(reason(0.5, "#!/bin/sh\nexit 1\n"), "gnuplot failed");
    EXPECT_EQ(reason(0.5, "#!/bin/sh\nexit 0\n"), "");
    EXPECT_EQ(reason(0.0, "#!/bin/sh\nexit 0\n"), "no RMSE is above the reference's noise");
}

TEST(PlotScript, HoldsItsOwnData) {
    CompareSettings settings;
    settings.methods = {kWalks};
    settings.baseline = kWalks;
    const std::vector<EqualVplsRow> rows{{.method = kWalks,
                                          .vpls = 100,
                                          .gathered_vpls = 98,
                                          .rmse = {0.5, 0.1, 0.0, 0.7},
                                          .generate_seconds = 1,
                                          .gather_seconds = 2}};
    const std::string script = plot_script("desk: RMSE", "desk-rmse", true, settings, rows);
    EXPECT_NE(script.find("\n98 3 0.5 0.05 0.7\n"),
              std::string::npos);  // no bar reaches 0 on a logarithmic axis
    EXPECT_NE(script.find("using 2:3:4:5"), std::string::npos);
    EXPECT_NE(script.find("\"instant-radiosity\""), std::string::npos);
    EXPECT_NE(script.find("set output \"desk-rmse.svg\""), std::string::npos);
    EXPECT_NE(plot_script("", "", false, settings, rows).find("using 1:3:4:5"), std::string::npos);
}

}  // namespace
}  // namespace nearlight::core
