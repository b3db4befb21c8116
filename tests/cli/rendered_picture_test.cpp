// SPDX-License-Identifier: Apache-2.0
#include "host/cli/rendered_picture.h"

#include <gtest/gtest.h>

#include "host/image/image_io.h"
#include "host/stages/film_layers.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

constexpr int kSide = 3;

/// A picture of which every channel is 1, with the mattes of `rows` rows, which are 0.5.
Image picture_with_mattes(int rows, bool expect_lack) {
    const TemporaryFolder folder;
    PictureOptions options;
    options.outputs = {(folder / "a.exr").string()};
    options.layers = {"depth", "cryptomatte_object"};
    RenderedPicture picture(options, 0);
    picture.open(kSide, kSide, {}, {});
    picture.add_rows(std::vector<float>(kSide * kSide * NEARLIGHT_LAYER_CHANNELS, 1.0f));
    picture.commit({}, {}, true, [&](const MatteSink& sink) {
        sink(std::vector<float>(static_cast<std::size_t>(rows) * kSide * kMatteChannels, 0.5f));
    });
    EXPECT_EQ(picture.lacks_mattes(), expect_lack);
    return read_image(folder / "a.exr");
}

TEST(RenderedPicture, RowsWithoutMattesGetZeros) {
    for (const int rows : {0, 2, kSide}) {
        const Image image = picture_with_mattes(rows, rows < kSide);
        ASSERT_EQ(image.height, kSide);
        std::size_t mattes = 0;
        for (std::size_t channel = 0; channel < image.channels.size(); ++channel) {
            const bool is_matte = image.channels[channel].starts_with("CryptoObject0");
            mattes += is_matte ? 1 : 0;
            for (int y = 0; y < kSide; ++y) {
                for (int x = 0; x < kSide; ++x) {
                    const std::size_t pixel = static_cast<std::size_t>(y * kSide + x);
                    EXPECT_EQ(image.values[pixel * image.channels.size() + channel], !is_matte  ? 1.0f
                                                                                     : y < rows ? 0.5f
                                                                                                : 0.0f)
                        << image.channels[channel] << " of row " << y;
                }
            }
        }
        EXPECT_EQ(mattes, kMatteChannels);
    }
}

}  // namespace
}  // namespace nearlight::core
