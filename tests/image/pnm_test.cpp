// SPDX-License-Identifier: Apache-2.0
#include "host/image/pnm.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <fstream>

#include "host/base/random.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

std::string random_bytes(std::size_t count) {
    Pcg32 random(3);
    std::string bytes(count, 0);
    for (char& byte : bytes) {
        byte = static_cast<char>(random.next());
    }
    return bytes;
}

class Pnm : public testing::Test {
  protected:
    std::optional<Image> read(const std::string& text) {
        std::ofstream(file_, std::ios::binary) << text;
        return read_pnm(file_);
    }
    void expect_as_openimageio_reads_it(const std::string& text) {
        const std::optional<Image> image = read(text);
        ASSERT_TRUE(image);
        const auto input = OIIO::ImageInput::open(file_.string());
        ASSERT_TRUE(input) << OIIO::geterror();
        const OIIO::ImageSpec& spec = input->spec();
        EXPECT_EQ(image->width, spec.width);
        EXPECT_EQ(image->height, spec.height);
        EXPECT_EQ(image->channels, spec.channelnames);
        std::vector<float> values(image->values.size());
        ASSERT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()));
        EXPECT_EQ(image->values, values);
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "a.ppm";
};

TEST_F(Pnm, ColourAndGreyAreWhatOpenImageIoReads) {
    expect_as_openimageio_reads_it("P6\n13 7\n255\n" + random_bytes(3 * 13 * 7));
    expect_as_openimageio_reads_it("P5 13\t7 255\n" + random_bytes(13 * 7));
    expect_as_openimageio_reads_it("P6\n# by hand\n13 7\n# of course\n255\n" + random_bytes(3 * 13 * 7));
}

TEST_F(Pnm, OthersAreLeftToOpenImageIo) {
    const std::string pixels = random_bytes(600);
    for (const std::string& text : {std::string(), std::string("P6"), std::string("P6\n13 7\n"),
                                    "P6\n13 7\n255\n" + pixels.substr(0, 272), "P6\n13 7\n65535\n" + pixels,
                                    "P3\n13 7\n255\n" + pixels, "P6\n0 7\n255\n" + pixels,
                                    "P6\n-13 7\n255\n" + pixels, "P6\n99999999999999999999 7\n255\n" + pixels,
                                    "P6\n65536 65536\n255\n" + pixels, "PF\n2 2\n-1\n" + pixels}) {
        EXPECT_FALSE(read(text)) << text.substr(0, 30);
    }
    EXPECT_FALSE(read_pnm(folder_ / "no such file"));
}

}  // namespace
}  // namespace nearlight::core
