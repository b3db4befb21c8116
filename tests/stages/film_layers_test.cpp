// SPDX-License-Identifier: Apache-2.0
#include "host/stages/film_layers.h"

#include <gtest/gtest.h>

#include <set>

namespace nearlight::core {
namespace {

using Names = std::vector<std::string>;

// Existing files, and scripts that read them, rely on these names and this order.
TEST(FilmLayers, ChannelsHaveTheNamesAndTheOrderOfFiles) {
    EXPECT_EQ(layer_channels(), (Names{"R",          "G",          "B",          "direct.R",   "direct.G",
                                       "direct.B",   "indirect.R", "indirect.G", "indirect.B", "albedo.R",
                                       "albedo.G",   "albedo.B",   "N.X",        "N.Y",        "N.Z",
                                       "P.X",        "P.Y",        "P.Z",        "depth.Z",    "closerange.Y",
                                       "variance.R", "variance.G", "variance.B", "A"}));
}

TEST(FilmLayers, LieOneAfterTheOther) {
    std::size_t end = 0;
    std::set<std::string_view> names;
    for (const FilmLayer& layer : kFilmLayers) {
        EXPECT_EQ(layer.first_channel, end) << layer.name;
        EXPECT_EQ(channel_names(layer).size(), layer.channel_count) << layer.name;
        end += layer.channel_count;
        names.insert(layer.name);
    }
    EXPECT_EQ(end, std::size_t{NEARLIGHT_LAYER_CHANNELS});
    EXPECT_EQ(names.size(), kFilmLayers.size()) << "two layers share a name";
}

TEST(FilmLayers, HaveAPlaceForTheirSumsUnlessTheyComeFromOthers) {
    EXPECT_EQ(NEARLIGHT_FILM_CHANNELS, NEARLIGHT_LAYER_CHANNELS - 3) << "the beauty adds nothing up";
    EXPECT_EQ(NEARLIGHT_SUM_DIRECT, 0);
    EXPECT_EQ(NEARLIGHT_SUM_DEPTH, NEARLIGHT_SUM_POSITION + 3);
    EXPECT_EQ(NEARLIGHT_SUM_CLOSE_RANGE, NEARLIGHT_SUM_DEPTH + 1);
}

TEST(FilmLayers, PassesAverageLightAndKeepTheGeometryOfTheFirst) {
    const Names names = layer_channels();
    const auto rules = pass_rules();
    for (std::size_t c = 0; c < names.size(); ++c) {
        const bool is_light =
            names[c].size() == 1 || names[c].starts_with("direct.") || names[c].starts_with("indirect.");
        const PassRule other = names[c].starts_with("variance.") ? PassRule::variance : PassRule::first;
        EXPECT_EQ(rules[c], is_light ? PassRule::mean : other) << names[c];
    }
}

TEST(FilmLayers, VarianceAndCoverageMustBeAskedFor) {
    for (const FilmLayer& layer : kFilmLayers) {
        EXPECT_EQ(layer.files,
                  layer.name == "variance" || layer.name == "A" ? FileRule::asked : FileRule::always)
            << layer.name;
    }
}

}  // namespace
}  // namespace nearlight::core
