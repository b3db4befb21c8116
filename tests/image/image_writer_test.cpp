// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "host/image/image_io.h"
#include "tests/image/image_checks.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

using namespace image_checks;
namespace fs = std::filesystem;

TEST(ImageIo, RowsInAnyPortions) {
    const TemporaryFolder folder;
    const Image image = noise(9, 23, kLayers);
    const std::size_t row = 9 * kLayers.size();
    for (const char* name : {"a.exr", "a.png"}) {
        ImageWriter writer(folder / name, 9, 23, kLayers);
        std::size_t written = 0;
        for (const std::size_t count : {1u, 0u, 3u, 7u, 12u}) {
            writer.write_rows(std::span(image.values).subspan(written * row, count * row));
            written += count;
        }
        writer.commit();
        write_image(folder / (std::string("whole-") + name), image);
        expect_same(read_image(folder / (std::string("whole-") + name)), read_image(folder / name));
    }
}

TEST(ImageIo, APartOfAPictureHasItsPlace) {
    const TemporaryFolder folder;
    write_image(folder / "part.exr", noise(9, 23, kLayers),
                {.place = ImagePlace{.x = 5, .y = 7, .whole_width = 40, .whole_height = 30}});
    const auto input = OIIO::ImageInput::open((folder / "part.exr").string());
    ASSERT_TRUE(input);
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ(std::vector({spec.x, spec.y, spec.width, spec.height}), std::vector({5, 7, 9, 23}));
    EXPECT_EQ(std::vector({spec.full_x, spec.full_y, spec.full_width, spec.full_height}),
              std::vector({0, 0, 40, 30}));
    EXPECT_EQ(read_image(folder / "part.exr").place, (ImagePlace{5, 7, 40, 30}));
    write_image(folder / "whole.exr", noise(9, 23, kLayers));
    EXPECT_FALSE(read_image(folder / "whole.exr").place);
}

/// What is known only when a picture is done, but before it is written.
TEST(ImageIo, TextsAreSetBeforeTheFirstRows) {
    const TemporaryFolder folder;
    const Image image = noise(5, 8, {"R", "G", "B"});
    for (const char* name : {"a.exr", "a.png"}) {
        ImageWriter writer(folder / name, 5, 8, image.channels,
                           {.metadata = {{"nearlight:a", std::string("old")}}});
        writer.set_text("nearlight:a", "a longer text");
        writer.set_text("nearlight:b", "new");
        writer.write_rows(image.values);
        writer.commit();
        const Metadata metadata = read_metadata(folder / name);
        EXPECT_EQ(metadata.at("nearlight:a"), Metadata::mapped_type{"a longer text"}) << name;
        EXPECT_EQ(metadata.at("nearlight:b"), Metadata::mapped_type{"new"}) << name;
    }
}

TEST(ImageIo, MissingRowsAreZero) {
    const TemporaryFolder folder;
    Image image = noise(5, 8, {"R", "G", "B"});
    ImageWriter writer(folder / "a.exr", 5, 8, image.channels);
    writer.write_rows(std::span(image.values).first(5 * 3 * 3));
    writer.commit();
    std::fill(image.values.begin() + 5 * 3 * 3, image.values.end(), 0.0f);
    expect_same(image, read_image(folder / "a.exr"));
}

TEST(ImageIo, PartialOrTooManyRowsAreRefused) {
    const TemporaryFolder folder;
    ImageWriter writer(folder / "a.exr", 2, 2, {"R", "G", "B"});
    const std::vector<float> values(2 * 3 * 3);
    error_of(ErrorKind::failure, [&] { writer.write_rows(std::span(values).first(7)); });
    error_of(ErrorKind::failure, [&] { writer.write_rows(values); });
}

TEST(ImageIo, OldFileSurvivesUntilCommit) {
    const TemporaryFolder folder;
    const Image old_image = noise(8, 8, {"R", "G", "B"});
    write_image(folder / "a.exr", old_image);
    {
        ImageWriter abandoned(folder / "a.exr", 3, 3, {"R", "G", "B"});
        abandoned.write_rows(std::vector<float>(3 * 3 * 2));
        EXPECT_EQ(folder.file_count(), 2u);
    }
    EXPECT_EQ(folder.file_count(), 1u);
    expect_same(old_image, read_image(folder / "a.exr"));
    const Image new_image = noise(3, 5, {"R", "G", "B"});
    write_image(folder / "a.exr", new_image);
    EXPECT_EQ(folder.file_count(), 1u);
    expect_same(new_image, read_image(folder / "a.exr"));
}

TEST(ImageIo, MovedWriterOwnsTheFile) {
    const TemporaryFolder folder;
    ImageWriter writer(folder / "a.exr", 1, 1, {"R", "G", "B"});
    ImageWriter other(folder / "b.exr", 1, 1, {"R", "G", "B"});
    other = std::move(writer);
    EXPECT_EQ(folder.file_count(), 1u);
    other.commit();
    EXPECT_TRUE(fs::exists(folder / "a.exr"));
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(ImageIo, UnwritablePlacesAreErrors) {
    const TemporaryFolder folder;
    const Image image = noise(2, 2, {"R", "G", "B"});
    const std::string missing = error_of(ErrorKind::file, [&] { write_image(folder / "none/a.exr", image); });
    EXPECT_NE(missing.find("none'; create it first"), std::string::npos) << missing;
    write_text(folder / "file", "");
    error_of(ErrorKind::file, [&] { write_image(folder / "file/a.exr", image); });
    fs::create_directory(folder / "folder.exr");
    error_of(ErrorKind::file, [&] { write_image(folder / "folder.exr", image); });
    EXPECT_EQ(folder.file_count(), 2u);
    error_of(ErrorKind::invalid_argument, [&] { write_image(folder / "a.gif", image); });
    error_of(ErrorKind::invalid_argument, [&] { write_image(folder / "a", image); });
    error_of(ErrorKind::file, [&] { write_image(folder / "a.png", noise(2, 2, {"Y"})); });
    EXPECT_EQ(folder.file_count(), 2u);
}

/// Simulates a full disk by a limit on file sizes, which makes writes fail in the same way.
class SmallDisk {
  public:
    explicit SmallDisk(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &old_limit_);
        rlimit limit = old_limit_;
        limit.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~SmallDisk() {
        setrlimit(RLIMIT_FSIZE, &old_limit_);
        std::signal(SIGXFSZ, old_handler_);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

  private:
    rlimit old_limit_{};
    void (*old_handler_)(int);
};

TEST(ImageIo, FullDiskIsAnErrorAtWhateverByteItFills) {
    const TemporaryFolder folder;
    const Image image = noise(40, 33, kLayers);
    for (const char* name : {"a.exr", "a.png"}) {
        write_image(folder / name, image);
        const auto size = fs::file_size(folder / name);
        const std::string old_text = read_text(folder / name);
        for (const auto limit : {std::uintmax_t{0}, std::uintmax_t{100}, size / 2, size - 1}) {
            const SmallDisk disk(limit);
            error_of(ErrorKind::file, [&] { write_image(folder / name, image); });
        }
        EXPECT_EQ(read_text(folder / name), old_text);
    }
    EXPECT_EQ(folder.file_count(), 2u);
}

long peak_kilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

TEST(ImageIo, StreamingKeepsMemoryLow) {
    const TemporaryFolder folder;
    constexpr int kWidth = 8192;
    constexpr int kHeight = 512;
    std::vector<std::string> channels;
    for (int c = 0; c < 17; ++c) {
        channels.push_back("layer" + std::to_string(c) + ".Y");
    }
    const std::vector<float> rows(16u * kWidth * channels.size(), 0.5f);
    ImageWriter writer(folder / "big.exr", kWidth, kHeight, channels);
    writer.write_rows(rows);
    const long before = peak_kilobytes();
    for (int y = 16; y < kHeight; y += 16) {
        writer.write_rows(rows);
    }
    writer.commit();
    // The whole picture has 285 MB.
    EXPECT_LT(peak_kilobytes() - before, 80 * 1024);
}

}  // namespace
}  // namespace nearlight::core
