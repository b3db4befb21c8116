// SPDX-License-Identifier: Apache-2.0
// Files with the sums of a picture's passes, from which `render --resume` goes on and which `merge` adds up.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "host/cli/screen_options.h"
#include "host/image/image_io.h"
#include "host/session/checkpoint.h"

namespace nearlight::core {

/// What a file begins with.
inline constexpr std::string_view kCheckpointMagic = "NLSUMS03";

/// What a checkpoint says about its picture.
struct CheckpointFacts {
    std::string version;           ///< of the program and its kernels
    std::uint64_t scene_hash = 0;  ///< with the camera and all options that change the scene
    /// Names and values of the options that decide what light passes bring in the mean.
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();
    /// Names and values of what, beside these, decides the bits of a pass.
    nlohmann::ordered_json maker = nlohmann::ordered_json::object();
    Metadata metadata;  ///< of the picture's files
    ScreenLook look;    ///< of PNG files
    std::optional<ImagePlace> place;
};

/// Writes a file, which appears whole or not at all. Throws Error(ErrorKind::file).
void write_checkpoint(const std::filesystem::path& file, const CheckpointFacts& facts,
                      const PassRecord& record, const PassSums& sums);

/// A checkpoint that is read. What it says of itself is there at once, and its sums on demand; in between,
/// the file is closed.
class CheckpointReader {
  public:
    /// Throws Error(ErrorKind::file) if there is no such file, or if it is none or that of another version of
    /// the format, or if it has another size than it says.
    explicit CheckpointReader(std::filesystem::path file);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const CheckpointFacts& facts() const { return facts_; }
    [[nodiscard]] const PassRecord& record() const { return record_; }
    [[nodiscard]] std::size_t width() const { return width_; }    ///< pixels
    [[nodiscard]] std::size_t height() const { return height_; }  ///< pixels

    /// Reads the sums. Throws Error(ErrorKind::file) if any byte of the file is not as it was written.
    [[nodiscard]] PassSums read_sums() const;

  private:
    void take_header(std::istream& stream);

    std::filesystem::path file_;
    std::string header_;  ///< JSON
    CheckpointFacts facts_;
    PassRecord record_;
    std::size_t width_ = 0;
    std::size_t height_ = 0;
};

}  // namespace nearlight::core
