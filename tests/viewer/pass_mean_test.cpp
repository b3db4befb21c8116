// SPDX-License-Identifier: Apache-2.0
#include "viewer/pass_mean.h"

#include <gtest/gtest.h>

#include "host/stages/film_layers.h"
#include "nearlight/session.h"

namespace nearlight::viewer {
namespace {

Image pass(float light, float depth) {
    return {.width = 1,
            .height = 1,
            .channels = {"R", "direct.R", "depth.Z", "A"},
            .values = {light, 2 * light, depth, 0.25f * light}};
}

TEST(PassMean, AveragesLightAndKeepsTheFirstSurfaces) {
    PassMean mean;
    mean.begin(pass(100, 5));
    mean.add(pass(1, 4));
    mean.add(pass(2, 6));
    mean.add(pass(6, 7));
    EXPECT_EQ(mean.passes(), 3u);
    EXPECT_FLOAT_EQ(mean.image().values[0], 3.0f);
    EXPECT_FLOAT_EQ(mean.image().values[1], 6.0f);
    EXPECT_EQ(mean.image().values[2], 5.0f);
    EXPECT_FLOAT_EQ(mean.image().values[3], 0.75f);
}

TEST(PassMean, BeginsAnew) {
    PassMean mean;
    mean.begin(pass(1, 5));
    mean.add(pass(1, 5));
    mean.begin(pass(2, 6));
    mean.add(pass(3, 7));
    EXPECT_EQ(mean.image().values[0], 3.0f);
    EXPECT_EQ(mean.image().values[2], 6.0f);
}

/// The table of layers decides what `nearlight render` averages. The albedo of passes of one sample is
/// averaged here besides.
TEST(PassMean, AveragesWhatRenderAverages) {
    const std::vector<std::string> channels = picture_channels();
    for (const core::FilmLayer& layer : core::kFilmLayers) {
        for (std::size_t i = 0; i < layer.channel_count; ++i) {
            const std::string& channel = channels.at(layer.first_channel + i);
            EXPECT_EQ(is_averaged(channel), layer.passes == core::PassRule::mean || layer.name == "albedo")
                << channel;
        }
    }
}

}  // namespace
}  // namespace nearlight::viewer
