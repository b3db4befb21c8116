// SPDX-License-Identifier: Apache-2.0
#include "host/scene/image_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <span>
#include <string>

#include "host/base/thread_limit.h"
#include "host/image/image_io.h"
#include "nearlight/error.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

constexpr int kImages = 12;

/// A folder of images of one pixel each, whose red is the number of the image ÷ 255.
class ImageReaderTest : public testing::TestWithParam<int> {
  protected:
    ImageReaderTest() : limit_(GetParam()) {
        for (int i = 0; i < kImages; ++i) {
            std::ofstream(file(i), std::ios::binary) << "P6\n1 1\n255\n" << static_cast<char>(i) << "ab";
            sources_.push_back({.file = file(i)});
        }
    }

    [[nodiscard]] std::filesystem::path file(int i) const { return folder_ / (std::to_string(i) + ".ppm"); }
    void expect_image(int i) {
        EXPECT_FLOAT_EQ(reader_.read(sources_[static_cast<std::size_t>(i)]).values.at(0),
                        static_cast<float>(i) / 255.0f)
            << i;
    }

    ThreadLimit limit_;
    TemporaryFolder folder_;
    std::vector<ImageSource> sources_;
    ImageReader reader_;
};

TEST_P(ImageReaderTest, ReadsInTheExpectedOrder) {
    reader_.expect(sources_);
    for (int i = 0; i < kImages; ++i) {
        expect_image(i);
        expect_image(i);
    }
}

TEST_P(ImageReaderTest, ReadsInAnyOtherOrder) {
    std::vector<int> order(kImages);
    std::iota(order.begin(), order.end(), 0);
    for (unsigned seed = 0; seed < 8; ++seed) {
        std::shuffle(order.begin(), order.end(), std::mt19937(seed));
        reader_.expect(sources_);
        for (const int i : order) {
            expect_image(i);
        }
    }
}

TEST_P(ImageReaderTest, ReadsWhatItDidNotExpect) {
    reader_.expect({sources_.begin(), sources_.begin() + 6});
    for (int i = kImages - 1; i >= 0; --i) {
        expect_image(i);
    }
}

TEST_P(ImageReaderTest, BrokenFilesFailWhenTheyAreAskedFor) {
    std::ofstream(file(1)) << "P6";
    std::filesystem::remove(file(2));
    reader_.expect(sources_);
    expect_image(0);
    for (const int broken : {1, 2, 1}) {
        EXPECT_THROW(reader_.read(sources_[static_cast<std::size_t>(broken)]), Error) << broken;
    }
    expect_image(3);
}

TEST_P(ImageReaderTest, AnEmptyPathIsNoImageThatWasReadBefore) {
    EXPECT_THROW(reader_.read({}), Error);
    expect_image(0);
    std::filesystem::remove(file(1));
    EXPECT_THROW(reader_.read(sources_[1]), Error);
    EXPECT_THROW(reader_.read({}), Error);
}

TEST_P(ImageReaderTest, ImagesInMemoryAreNotTakenForEachOther) {
    Image image = make_image(1, 1, {"R", "G", "B"});
    std::vector<std::string> files;
    for (const float red : {0.0f, 1.0f}) {
        image.values[0] = red;
        write_image(folder_ / "a.png", image);
        std::ifstream in(folder_ / "a.png", std::ios::binary);
        files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    std::vector<ImageSource> sources;
    for (const std::string& bytes : files) {
        sources.push_back({.file = "image.png", .bytes = std::as_bytes(std::span(bytes))});
    }
    reader_.expect(sources);
    EXPECT_EQ(reader_.read(sources[0]).values.at(0), 0.0f);
    EXPECT_EQ(reader_.read(sources[1]).values.at(0), 1.0f);
    const std::span<const std::byte> nothing;
    EXPECT_THROW(reader_.read({.file = file(0), .bytes = nothing}), Error);
}

INSTANTIATE_TEST_SUITE_P(Threads, ImageReaderTest, testing::Values(1, 2, 8));

}  // namespace
}  // namespace nearlight::core
