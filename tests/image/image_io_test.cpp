// SPDX-License-Identifier: Apache-2.0
#include "host/image/image_io.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>

#include "host/base/random.h"
#include "host/image/color.h"
#include "host/image/exr_patch.h"
#include "host/image/image_codec.h"
#include "tests/image/image_checks.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

using namespace image_checks;
namespace fs = std::filesystem;

TEST(ImageIo, ExrKeepsEveryChannelBitForBit) {
    const TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 37}, {53, 1}, {17, 19}, {64, 64}}) {
        const Image image = noise(width, height, kLayers);
        write_image(folder / "a.exr", image);
        expect_same(image, read_image(folder / "a.exr"));
    }
}

TEST(ImageIo, ExrRoundsChannelsThatAreHalfFloats) {
    const TemporaryFolder folder;
    Image image = noise(19, 7, {"R", "depth.Z", "A"});
    image.at(2, 1, 0) = 1e9f;
    image.at(3, 1, 0) = -1e9f;
    image.at(4, 1, 0) = std::numeric_limits<float>::infinity();
    for (const ExrCompression compression :
         {ExrCompression::none, ExrCompression::zip, ExrCompression::piz}) {
        ImageWriter writer(folder / "a.exr", image.width, image.height, image.channels,
                           {.compression = compression, .half = {true, false, true}});
        writer.write_rows(image.values);
        writer.commit();
        EXPECT_EQ(writer.limited_count(), 2u);
        const Image back = read_image(folder / "a.exr");
        ASSERT_EQ(back.values.size(), image.values.size());
        const auto channel = [&](const char* name) {
            return static_cast<std::size_t>(back.find_channel(name));
        };
        EXPECT_EQ(back.at(2, 1, channel("R")), 65504.0f);
        EXPECT_EQ(back.at(3, 1, channel("R")), -65504.0f);
        EXPECT_TRUE(std::isinf(back.at(4, 1, channel("R"))));
        uint rounded = 0;
        for (int x = 5; x < 19; ++x) {
            const float value = image.at(x, 1, 0);
            EXPECT_NEAR(back.at(x, 1, channel("R")), value, std::abs(value) / 2048 + 1e-7f);
            rounded += back.at(x, 1, channel("R")) != value ? 1 : 0;
            EXPECT_EQ(back.at(x, 1, channel("depth.Z")), image.at(x, 1, 1));
        }
        EXPECT_GT(rounded, 0u);
    }
}

TEST(ImageIo, DwaaChangesColoursByLittle) {
    const TemporaryFolder folder;
    Image image = make_image(64, 64, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] = 0.5f + 0.4f * std::sin(static_cast<float>(i) * 0.01f);
    }
    write_image(folder / "a.exr", image, {.compression = ExrCompression::dwaa, .half = {true, true, true}});
    const Image back = read_image(folder / "a.exr");
    double change = 0;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        change = std::max<double>(change, std::abs(back.values[i] - image.values[i]));
    }
    EXPECT_GT(change, 0.0);
    EXPECT_LT(change, 0.05);
}

TEST(ImageIo, PngKeepsTexts) {
    const TemporaryFolder folder;
    write_image(folder / "a.png", noise(4, 4, {"R", "G", "B"}),
                {.metadata = {{"nearlight:sampler", std::string("local")}, {"nearlight:vpls", 7}}});
    const Metadata metadata = read_metadata(folder / "a.png");
    EXPECT_EQ(metadata.at("nearlight:sampler"), Metadata::mapped_type{"local"});
    EXPECT_FALSE(metadata.contains("nearlight:vpls"));
}

TEST(ImageIo, ExrKeepsInfinityAndNan) {
    const TemporaryFolder folder;
    Image image = make_image(3, 1, {"R", "G", "B"});
    image.at(0, 0, 0) = std::numeric_limits<float>::infinity();
    image.at(1, 0, 1) = std::numeric_limits<float>::quiet_NaN();
    write_image(folder / "a.exr", image);
    const Image back = read_image(folder / "a.exr");
    EXPECT_TRUE(std::isinf(back.at(0, 0, 0)));
    EXPECT_TRUE(std::isnan(back.at(1, 0, 1)));
}

/// Attributes are sorted, and manifests of mattes, which may be long, come before.
TEST(ImageIo, ANumberBehindLongTextsIsPatched) {
    const TemporaryFolder folder;
    ImageWriterOptions options;
    options.metadata = {{"cryptomatte/a/manifest", std::string(200'000, 'x') + "renderTimeSeconds"},
                        {"renderTimeSeconds", 1.5f}};
    write_image(folder / "a.exr", noise(4, 4, kLayers), options);
    patch_exr_float(folder / "a.exr", "renderTimeSeconds", 2.5f);
    EXPECT_EQ(read_metadata(folder / "a.exr").at("renderTimeSeconds"), Metadata::mapped_type{2.5f});
    EXPECT_THROW(patch_exr_float(folder / "a.exr", "nothing", 1.0f), Error);
}

TEST(ImageIo, ExrKeepsMetadata) {
    const TemporaryFolder folder;
    std::vector<float> matrix(16);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        matrix[i] = static_cast<float>(i) * 0.5f;
    }
    ImageWriterOptions options;
    options.metadata = {{"nearlight:vpls", 1000},
                        {"nearlight:clampRadius", 0.25f},
                        {"nearlight:sampler", std::string("close-range")},
                        {"nearlight:origin", std::vector<float>{1, 2, 3}},
                        {"worldToCamera", matrix},
                        {"renderTimeSeconds", 1.5f}};
    write_image(folder / "a.exr", noise(4, 4, kLayers), options);
    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(input);
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ(spec.get_int_attribute("nearlight:vpls"), 1000);
    EXPECT_EQ(spec.get_float_attribute("nearlight:clampRadius"), 0.25f);
    EXPECT_EQ(spec.get_string_attribute("nearlight:sampler"), "close-range");
    EXPECT_EQ(spec.get_float_attribute("renderTimeSeconds"), 1.5f);
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
    const auto* origin = spec.find_attribute("nearlight:origin");
    ASSERT_NE(origin, nullptr);
    EXPECT_EQ(static_cast<const float*>(origin->data())[2], 3.0f);
    const auto* stored = spec.find_attribute("worldToCamera", OIIO::TypeMatrix44);
    ASSERT_NE(stored, nullptr);
    EXPECT_TRUE(std::equal(matrix.begin(), matrix.end(), static_cast<const float*>(stored->data())));

    const Metadata read = read_metadata(folder / "a.exr");
    for (const char* name :
         {"nearlight:vpls", "nearlight:clampRadius", "nearlight:sampler", "renderTimeSeconds"}) {
        EXPECT_EQ(read.at(name), options.metadata.at(name)) << name;
    }
    EXPECT_FALSE(read.contains("worldToCamera"));
    error_of(ErrorKind::file, [&] { read_metadata(folder / "b.exr"); });
}

TEST(ImageIo, PngIsExposedAndSrgbEncoded) {
    const TemporaryFolder folder;
    Image image = make_image(3, 1, {"depth.Z", "B", "G", "R"});
    image.at(0, 0, 3) = 0.25f;
    image.at(0, 0, 2) = 7.0f;
    image.at(0, 0, 1) = -1.0f;
    image.at(1, 0, 3) = std::numeric_limits<float>::quiet_NaN();
    ImageWriterOptions options;
    options.exposure = 1.0f;
    write_image(folder / "a.PNG", image, options);
    const Image back = read_image(folder / "a.PNG");
    ASSERT_EQ(back.channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_FLOAT_EQ(back.at(0, 0, 0), 188.0f / 255.0f);  // sRGB of 0.5 is 0.7354
    EXPECT_EQ(back.at(0, 0, 1), 1.0f);
    EXPECT_EQ(back.at(0, 0, 2), 0.0f);
    EXPECT_EQ(back.at(1, 0, 0), 0.0f);
    EXPECT_NEAR(read_linear_image(folder / "a.PNG").at(0, 0, 0), 0.5f, 0.004f);
}

TEST(ImageIo, LinearReadingLeavesFloatFilesAlone) {
    const TemporaryFolder folder;
    const Image image = noise(5, 4, {"R", "G", "B"});
    write_image(folder / "a.exr", image);
    expect_same(image, read_linear_image(folder / "a.exr"));
}

TEST(ImageIo, AlphaIsNotMultiplied) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto output = OIIO::ImageOutput::create("png");
    ASSERT_TRUE(output->open((folder / "a.png").string(), spec));
    const std::array<unsigned char, 4> pixel{200, 100, 50, 51};
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixel.data()));
    output->close();
    const Image image = read_image(folder / "a.png");
    ASSERT_EQ(image.channel_count(), 4u);
    EXPECT_FLOAT_EQ(image.at(0, 0, 0), 200.0f / 255.0f);
    EXPECT_FLOAT_EQ(image.at(0, 0, 3), 0.2f);
}

/// A losslessly compressed WebP of one pixel, (200, 100, 50) with the alpha 51, as Pillow 12 writes it.
constexpr std::string_view kWebpOfOnePixel{
    "\x52\x49\x46\x46\x1e\x00\x00\x00\x57\x45\x42\x50\x56\x50\x38\x4c\x11\x00\x00\x00\x2f\x00\x00\x00"
    "\x10\x07\x50\xb2\x22\x57\xa6\x33\x81\x88\xe8\x7f\x00\x00",
    38};

TEST(ImageIo, AlphaOfWebpIsNotMultiplied) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.webp", std::ios::binary)
        .write(kWebpOfOnePixel.data(), std::ssize(kWebpOfOnePixel));
    const Image image = read_image(folder / "a.webp");
    ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_FLOAT_EQ(image.at(0, 0, 0), 200.0f / 255.0f);
    EXPECT_FLOAT_EQ(image.at(0, 0, 2), 50.0f / 255.0f);
    EXPECT_FLOAT_EQ(image.at(0, 0, 3), 0.2f);
    std::ofstream(folder / "cut.webp", std::ios::binary)
        .write(kWebpOfOnePixel.data(), std::ssize(kWebpOfOnePixel) - 5);
    EXPECT_THROW(read_image(folder / "cut.webp"), Error);
}

/// Without loss, WebP takes no bits for the pixels of an even image. So the file of one pixel becomes one of
/// many by its header alone, which has width and height, less one, in 14 bits each.
TEST(ImageIo, EvenWebpsMayBeLargeWithinReason) {
    const TemporaryFolder folder;
    const auto read = [&](std::uint32_t side) {
        std::string bytes(kWebpOfOnePixel);
        const std::uint32_t sizes = (side - 1) | (side - 1) << 14u | 1u << 28u;
        for (std::size_t i = 0; i < 4; ++i) {
            bytes[21 + i] = static_cast<char>(sizes >> 8u * i & 0xffu);
        }
        std::ofstream(folder / "a.webp", std::ios::binary).write(bytes.data(), std::ssize(bytes));
        return read_image(folder / "a.webp");
    };
    const Image image = read(4100);
    EXPECT_EQ(image.width, 4100);
    EXPECT_FLOAT_EQ(image.at(4099, 4099, 0), 200.0f / 255.0f);
    EXPECT_NE(error_of(ErrorKind::file, [&] { read(16384); }).find("promises more"), std::string::npos);
}

/// Files as other programs write them, in formats that we only read.
class Readable : public testing::TestWithParam<const char*> {
  protected:
    static void write_other(const fs::path& file, int width, int height) {
        const auto output = OIIO::ImageOutput::create(file.string());
        ASSERT_TRUE(output) << OIIO::geterror();
        const Image image = noise(width, height, {"R", "G", "B"});
        ASSERT_TRUE(output->open(file.string(), OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT)));
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, image.values.data()));
        ASSERT_TRUE(output->close());
    }
};

TEST_P(Readable, WholeFileIsReadAndTruncatedOneIsAnError) {
    const TemporaryFolder folder;
    const fs::path file = folder / (std::string("a.") + GetParam());
    write_other(file, 61, 47);
    const Image image = read_image(file);
    EXPECT_EQ(image.width, 61);
    EXPECT_EQ(image.height, 47);
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
    const std::string text = read_text(file);
    for (const double part : {0.0, 0.01, 0.3, 0.6, 0.9}) {
        write_text(file, text.substr(0, static_cast<std::size_t>(static_cast<double>(text.size()) * part)));
        const std::string message = error_of(ErrorKind::file, [&] { read_image(file); });
        EXPECT_NE(message.find(file.string()), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}
INSTANTIATE_TEST_SUITE_P(Formats, Readable,
                         testing::Values("exr", "png", "jpg", "hdr", "ppm", "tif", "tga", "bmp"),
                         [](const auto& tested) { return std::string(tested.param); });

/// A TIFF file of one channel, with numbers of a type in scanlines or in tiles.
void write_tiff(const fs::path& file, const Image& image, OIIO::TypeDesc type, int tile) {
    OIIO::ImageSpec spec(image.width, image.height, 1, type);
    spec.tile_width = tile;
    spec.tile_height = tile;
    const auto output = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(output && output->open(file.string(), spec)) << OIIO::geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, image.values.data()));
    ASSERT_TRUE(output->close());
}

TEST(ImageIo, NumbersOfEachTypeAreRead) {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.tif";
    Image image = noise(61, 47, {"Y"});
    // Codes of 8 bits are exact in all types that are not halves.
    for (float& value : image.values) {
        value = std::round(255.0f * std::clamp(value, 0.0f, 1.0f)) / 255.0f;
    }
    for (const OIIO::TypeDesc type : {OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::HALF,
                                      OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::DOUBLE}) {
        for (const int tile : {0, 16}) {
            if (type == OIIO::TypeDesc::DOUBLE && tile > 0) {
                continue;  // OpenImageIO 2.4 writes tiles of doubles that no reader understands.
            }
            write_tiff(file, image, type, tile);
            const Image back = read_image(file);
            ASSERT_EQ(back.values.size(), image.values.size());
            for (std::size_t i = 0; i < image.values.size(); ++i) {
                EXPECT_NEAR(back.values[i], image.values[i], type == OIIO::TypeDesc::HALF ? 3e-4 : 1e-7)
                    << type.c_str() << ", tiles of " << tile;
            }
        }
    }
}

TEST(ImageIo, PfmIsReadTopRowFirst) {
    const TemporaryFolder folder;
    // In the file, the bottom row comes first.
    const std::array<float, 6> values{4, 5, 6, 1, 2, 3};
    std::string text = "PF\n1 2\n-1.0\n";
    text.append(reinterpret_cast<const char*>(values.data()), sizeof values);
    write_text(folder / "a.pfm", text);
    const Image image = read_image(folder / "a.pfm");
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
    write_text(folder / "a.pfm", text.substr(0, text.size() - 3));
    error_of(ErrorKind::file, [&] { read_image(folder / "a.pfm"); });
}

TEST(ImageIo, ReadingNamesTheFileAndTheReason) {
    const TemporaryFolder folder;
    EXPECT_NE(
        error_of(ErrorKind::file, [&] { read_image(folder / "none.exr"); }).find("none.exr': no such file"),
        std::string::npos);
    EXPECT_NE(error_of(ErrorKind::file, [&] { read_image(folder.path()); }).find("folder"),
              std::string::npos);
    write_text(folder / "text.exr", "this is no picture");
    EXPECT_NE(error_of(ErrorKind::file, [&] { read_image(folder / "text.exr"); }).find("text.exr"),
              std::string::npos);
    write_text(folder / "what.ever", "this is no picture");
    error_of(ErrorKind::file, [&] { read_image(folder / "what.ever"); });
}

TEST(ImageIo, ContentTellsTheFormat) {
    const TemporaryFolder folder;
    write_image(folder / "a.png", noise(5, 3, {"R", "G", "B"}));
    fs::rename(folder / "a.png", folder / "a.exr");
    EXPECT_EQ(read_image(folder / "a.exr").width, 5);
    write_text(folder / "a.pic", "\x53\x80\xf6\x34 a format whose reader crashes on damaged files");
    EXPECT_NE(error_of(ErrorKind::file, [&] { read_image(folder / "a.pic"); }).find("it is none of EXR, PNG"),
              std::string::npos);
}

TEST(ImageIo, HeadersThatPromiseTooMuchAreErrors) {
    const TemporaryFolder folder;
    write_text(folder / "a.ppm", "P6 60000 60000 255\nabc");
    EXPECT_NE(error_of(ErrorKind::file, [&] { read_image(folder / "a.ppm"); }).find("promises more"),
              std::string::npos);
    // An even EXR picture of 20 000 × 20 000 has 480 KB as DWAA, and more than 2 MB as ZIP.
    const std::uintmax_t bytes = std::uintmax_t{20'000} * 20'000 * 6;
    EXPECT_NO_THROW(check_fits_in_file("a.exr", bytes, 480'000, kDwaDensity));
    EXPECT_THROW(check_fits_in_file("a.exr", bytes, 480'000), Error);
    EXPECT_THROW(check_fits_in_file("a.exr", 100 * bytes, 480'000, kDwaDensity), Error);
}

TEST(ImageIo, BrokenBytesNeverBreakTheReader) {
    const TemporaryFolder folder;
    Pcg32 random(11);
    for (const char* name : {"a.exr", "a.png"}) {
        write_image(folder / name, noise(13, 9, {"R", "G", "B"}));
        const std::string whole = read_text(folder / name);
        for (int i = 0; i < 100; ++i) {
            std::string broken = whole;
            for (int change = 0; change < 3; ++change) {
                broken[random.next() % broken.size()] = static_cast<char>(random.next());
            }
            write_text(folder / name, broken);
            try {
                const Image image = read_image(folder / name);
                EXPECT_EQ(image.values.size(), static_cast<std::size_t>(image.width) *
                                                   static_cast<std::size_t>(image.height) *
                                                   image.channel_count());
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::file) << error.what();
            }
        }
    }
}

}  // namespace
}  // namespace nearlight::core
