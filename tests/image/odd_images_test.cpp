// SPDX-License-Identifier: Apache-2.0
// Image files that are sound but rare, or that OpenImageIO does not survive.
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <initializer_list>

#include "host/image/image_io.h"
#include "tests/image/image_checks.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

using namespace image_checks;
namespace fs = std::filesystem;

void put(std::string& text, std::uint32_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) {
        text.push_back(static_cast<char>(number >> 8 * i & 0xffu));
    }
}

/// A TIFF file of 16 × 16 pixels of CMYK, as one strip or one tile without compression.
std::string cmyk_tiff(bool is_tiled) {
    constexpr std::uint32_t kSide = 16;
    constexpr std::uint32_t kShort = 3;
    constexpr std::uint32_t kLong = 4;
    struct Field {
        std::uint32_t tag, type, count, value;
    };
    std::vector<Field> fields{{256, kShort, 1, kSide}, {257, kShort, 1, kSide}, {258, kShort, 4, 0},
                              {259, kShort, 1, 1},     {262, kShort, 1, 5},     {277, kShort, 1, 4}};
    const std::uint32_t directory_size = 2 + 12 * (is_tiled ? 10 : 9) + 4;
    const std::uint32_t bits_at = 8 + directory_size;
    const std::uint32_t pixels_at = bits_at + 8;
    fields[2].value = bits_at;
    if (is_tiled) {
        fields.insert(fields.end(), {{322, kShort, 1, kSide},
                                     {323, kShort, 1, kSide},
                                     {324, kLong, 1, pixels_at},
                                     {325, kLong, 1, 4 * kSide * kSide}});
    } else {
        fields.insert(fields.begin() + 5, {273, kLong, 1, pixels_at});
        fields.insert(fields.end(), {{278, kShort, 1, kSide}, {279, kLong, 1, 4 * kSide * kSide}});
    }
    std::string text("II*\0\x08\0\0\0", 8);
    put(text, static_cast<std::uint32_t>(fields.size()), 2);
    for (const Field& field : fields) {
        put(text, field.tag, 2);
        put(text, field.type, 2);
        put(text, field.count, 4);
        put(text, field.value, 4);
    }
    put(text, 0, 4);
    for (int channel = 0; channel < 4; ++channel) {
        put(text, 8, 2);
    }
    for (std::uint32_t pixel = 0; pixel < kSide * kSide; ++pixel) {
        text += std::string("\xff\0\0\0", 4);  // cyan
    }
    return text;
}

TEST(OddImages, CmykTiffsInTilesAreRefused) {
    const TemporaryFolder folder;
    write_text(folder / "strip.tif", cmyk_tiff(false));
    const Image cyan = read_image(folder / "strip.tif");
    EXPECT_EQ(cyan.width, 16);
    EXPECT_EQ(cyan.at(15, 15, 0), 0.0f);
    EXPECT_EQ(cyan.at(15, 15, 1), 1.0f);
    EXPECT_EQ(cyan.at(15, 15, 2), 1.0f);
    write_text(folder / "tile.tif", cmyk_tiff(true));
    EXPECT_NE(error_of(ErrorKind::file, [&] { read_image(folder / "tile.tif"); }).find("tiles of CMYK"),
              std::string::npos);
}

/// A DDS file of one pixel of 32 bits without compression, 0xff804020 with its alpha first.
std::string dds(std::uint32_t flags, const std::array<std::uint32_t, 4>& masks) {
    std::string text = "DDS ";
    for (const std::uint32_t number : {124u, 0x100fu, 1u, 1u, 4u, 0u, 0u}) {
        put(text, number, 4);
    }
    text.append(44, '\0');
    for (const std::uint32_t number :
         {32u, flags, 0u, 32u, masks[0], masks[1], masks[2], masks[3], 0x1000u}) {
        put(text, number, 4);
    }
    text.append(16, '\0');
    put(text, 0xff804020u, 4);
    return text;
}

TEST(OddImages, DdsFilesNeedBitsForEachChannel) {
    const TemporaryFolder folder;
    const auto read = [&](std::uint32_t flags, std::array<std::uint32_t, 4> masks) {
        write_text(folder / "a.dds", dds(flags, masks));
        return read_image(folder / "a.dds");
    };
    const auto is_refused = [&](std::uint32_t flags, std::array<std::uint32_t, 4> masks) {
        return error_of(ErrorKind::file, [&] {
                   read(flags, masks);
               }).find("no bits for one of its channels") != std::string::npos;
    };
    constexpr std::uint32_t kRgb = 0x40;
    constexpr std::uint32_t kLuminance = 0x20000;
    constexpr std::uint32_t kAlpha = 1;
    constexpr std::uint32_t kAlphaOnly = 2;
    constexpr std::array kAll{0xff0000u, 0xff00u, 0xffu, 0xff000000u};
    constexpr std::array kOpaque{0xff0000u, 0xff00u, 0xffu, 0u};
    EXPECT_FLOAT_EQ(read(kRgb, kOpaque).at(0, 0, 0), 128.0f / 255.0f);
    EXPECT_FLOAT_EQ(read(kRgb | kAlpha, kAll).at(0, 0, 3), 1.0f);
    EXPECT_EQ(read(kLuminance, {0xffffffffu, 0, 0, 0}).channel_count(), 1u);
    EXPECT_EQ(read(kAlphaOnly, {0, 0, 0, 0xff000000u}).channel_count(), 1u);
    EXPECT_TRUE(is_refused(kRgb, {0, 0, 0, 0}));
    EXPECT_TRUE(is_refused(kRgb, {0xff0000u, 0, 0xffu, 0}));
    EXPECT_TRUE(is_refused(kRgb | kAlpha, kOpaque));
    EXPECT_TRUE(is_refused(kLuminance, {0, 0xffu, 0xff00u, 0xff000000u}));
    EXPECT_TRUE(is_refused(kLuminance | kAlpha, {0xffu, 0, 0, 0}));
    EXPECT_TRUE(is_refused(kAlphaOnly, kOpaque));
    EXPECT_TRUE(is_refused(kAlphaOnly | kAlpha, {0xffu, 0, 0, 0xff000000u}));
}

TEST(OddImages, SpareBytesInJpegsCostNothing) {
    const TemporaryFolder folder;
    const auto output = OIIO::ImageOutput::create("jpeg");
    ASSERT_TRUE(output &&
                output->open((folder / "a.jpg").string(), OIIO::ImageSpec(40, 40, 3, OIIO::TypeDesc::FLOAT)));
    const Image image = noise(40, 40, {"R", "G", "B"});
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, image.values.data()));
    ASSERT_TRUE(output->close());
    const std::string whole = read_text(folder / "a.jpg");
    const Image expected = read_image(folder / "a.jpg");
    for (const std::size_t at : {whole.find("\xff\xdb"), whole.find("\xff\xda"), whole.size() - 2}) {
        std::string text = whole;
        text.insert(at, "spare");
        write_text(folder / "b.jpg", text);
        expect_same(read_image(folder / "b.jpg"), expected);
    }
    std::string cut = whole;
    cut.erase(cut.size() * 3 / 4).append("\xff\xd9");
    write_text(folder / "b.jpg", cut);
    error_of(ErrorKind::file, [&] { read_image(folder / "b.jpg"); });
}

TEST(OddImages, DeepImagesAreNamed) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeDesc::HALF);
    spec.channelnames = {"R", "A", "Z"};
    spec.deep = true;
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output && output->open((folder / "a.exr").string(), spec));
    OIIO::DeepData samples(spec);
    samples.set_samples(0, 1);
    ASSERT_TRUE(output->write_deep_image(samples));
    ASSERT_TRUE(output->close());
    EXPECT_NE(error_of(ErrorKind::file, [&] { read_image(folder / "a.exr"); }).find("deep images are not"),
              std::string::npos);
}

}  // namespace
}  // namespace nearlight::core
