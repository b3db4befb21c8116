// SPDX-License-Identifier: Apache-2.0
#include "viewer/channels.h"

#include <gtest/gtest.h>

#include "host/stages/film_layers.h"
#include "nearlight/session.h"

namespace nearlight::viewer {
namespace {

/// Two pixels of all layers, whose values count up.
Image picture() {
    Image image{.width = 2, .height = 1, .channels = picture_channels()};
    for (std::size_t i = 0; i < 2 * image.channels.size(); ++i) {
        image.values.push_back(static_cast<float>(i));
    }
    return image;
}

TEST(Channels, AreWhereTheTableOfLayersHasThem) {
    for (const core::FilmLayer& layer : core::kFilmLayers) {
        const Channels found = channels_of(picture(), layer.name);
        EXPECT_EQ(found.first, layer.first_channel) << layer.name;
        EXPECT_EQ(found.count, layer.channel_count) << layer.name;
    }
    EXPECT_EQ(channels_of(picture(), "nosuch").count, 0u);
}

/// The table of layers decides what `nearlight render` writes unless it is asked for other layers.
TEST(Channels, FilesGetTheLayersThatRenderWrites) {
    const Image all = picture();
    const Image kept = with_file_layers(all);
    Image expected{.width = 2, .height = 1};
    for (std::size_t pixel = 0; pixel < 2; ++pixel) {
        for (const core::FilmLayer& layer : core::kFilmLayers) {
            for (std::size_t i = 0; i < layer.channel_count && layer.files == core::FileRule::always; ++i) {
                const std::size_t channel = layer.first_channel + i;
                expected.values.push_back(static_cast<float>(pixel * all.channels.size() + channel));
                if (pixel == 0) {
                    expected.channels.push_back(all.channels[channel]);
                }
            }
        }
    }
    EXPECT_EQ(kept.width, 2);
    EXPECT_EQ(kept.channels, expected.channels);
    EXPECT_EQ(kept.values, expected.values);
}

}  // namespace
}  // namespace nearlight::viewer
