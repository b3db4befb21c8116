// SPDX-License-Identifier: Apache-2.0
// Pictures, files and comparisons that the tests of image files share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/base/random.h"
#include "host/image/image.h"
#include "nearlight/error.h"

namespace nearlight::core::image_checks {

inline Image noise(int width, int height, std::vector<std::string> channels) {
    Image image = make_image(width, height, std::move(channels));
    Pcg32 random(7);
    for (float& value : image.values) {
        value = random.uniform() * 4.0f - 1.0f;
    }
    return image;
}

inline const std::vector<std::string> kLayers{"R",          "G",          "B",      "indirect.R",
                                              "indirect.G", "indirect.B", "depth.Z"};

inline std::string read_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

/// The message of the Error of kind `code` that `action` must throw.
template <typename Action>
std::string error_of(ErrorKind code, Action action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), code) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

/// Compares the values of channels by name, because a file may order channels differently.
inline void expect_same(const Image& a, const Image& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    ASSERT_EQ(a.channel_count(), b.channel_count());
    for (std::size_t c = 0; c < a.channel_count(); ++c) {
        const int other = b.find_channel(a.channels[c]);
        ASSERT_GE(other, 0) << a.channels[c];
        for (int y = 0; y < a.height; ++y) {
            for (int x = 0; x < a.width; ++x) {
                ASSERT_EQ(a.at(x, y, c), b.at(x, y, static_cast<std::size_t>(other)))
                    << a.channels[c] << " at " << x << ", " << y;
            }
        }
    }
}

}  // namespace nearlight::core::image_checks
