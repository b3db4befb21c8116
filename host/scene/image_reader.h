// SPDX-License-Identifier: Apache-2.0
// Reads the images of a scene ahead of whoever asks for them.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <future>
#include <optional>
#include <span>
#include <vector>

#include "host/image/image.h"

namespace nearlight::core {

/// An image file.
struct ImageSource {
    std::filesystem::path file;                         ///< of an image in memory a name, for messages
    std::optional<std::span<const std::byte>> bytes{};  ///< what the file holds, if it is in memory

    bool operator==(const ImageSource& other) const { return file == other.file && start() == other.start(); }
    [[nodiscard]] const std::byte* start() const { return bytes ? bytes->data() : nullptr; }
};

/// Reads image files. Those that it is told to expect are read by other threads ahead of the caller, because
/// scenes of many textures would else keep one core busy while the others wait. ThreadLimit says how many
/// threads.
class ImageReader {
  public:
    /// The files that read() will probably be asked for, in about this order. One that is never asked for
    /// costs time, but is no error, whatever it is like. Bytes in memory must outlive the reader.
    void expect(std::vector<ImageSource> sources);

    /// The image, with the values and the errors of read_image(). Valid until the next call; asked for twice
    /// in a row, an image is read once.
    const Image& read(const ImageSource& source);

  private:
    struct Ahead {
        ImageSource source;
        std::future<Image> image;
    };
    void read_ahead();
    std::future<Image> take(const ImageSource& source);

    std::deque<ImageSource> expected_;  ///< that nobody has begun to read
    std::deque<Ahead> ahead_;
    std::optional<ImageSource> last_;  ///< whose image `image_` is; none before the first and after an error
    Image image_;
};

}  // namespace nearlight::core
