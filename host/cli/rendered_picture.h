// SPDX-License-Identifier: Apache-2.0
// Takes the rows of a picture while it is rendered and writes its files, denoised if that is wanted.
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/cli/matte_layers.h"
#include "host/cli/picture_files.h"
#include "host/image/denoiser.h"

namespace nearlight::core {

/// Sends the mattes of a picture that was rendered, as Session::mattes() does.
using MatteSource = std::function<void(const MatteSink& sink)>;

class RenderedPicture {
  public:
    /// If the options want a denoised picture, finds the denoiser, which works on `threads` threads, or on
    /// all if that is 0. Throws as Denoiser does.
    RenderedPicture(const PictureOptions& options, int threads);

    /// As PictureFiles::set_outputs().
    void set_outputs(std::vector<std::string> outputs) { files_.set_outputs(std::move(outputs)); }
    /// Opens the files, again if they were committed. `metadata` gets the attribute that names the denoiser.
    void open(int width, int height, Metadata metadata, const ScreenLook& look,
              const std::optional<ImagePlace>& place = std::nullopt);
    /// Takes rows with the channels of layer_channels().
    void add_rows(std::span<const float> rows);
    /// Denoises what rows there are, joins them with mattes if the options ask for them (zeros for rows that
    /// `mattes` does not send), and completes the files. `since_begin` is for their attribute of the time.
    /// The denoiser learns the variance of the beauty if the passes, whose samples per pixel are
    /// `pass_samples`, tell it. `quiet` is PictureFiles::commit()'s.
    void commit(const Stopwatch& since_begin, std::span<const uint> pass_samples, bool quiet = false,
                const MatteSource& mattes = {});

    /// What denoises the picture, such as "Open Image Denoise 2.5.1 (direct and indirect apart, albedo, N,
    /// variance)", or "none". Whether the variance is used is known from commit() on.
    [[nodiscard]] std::string denoiser() const;
    [[nodiscard]] double denoising_seconds() const { return denoising_seconds_; }
    [[nodiscard]] double matte_seconds() const { return matte_seconds_; }
    /// Whether the files of the last commit() have rows that no mattes were sent for.
    [[nodiscard]] bool lacks_mattes() const { return lacks_mattes_; }

  private:
    void prepare_to_write();
    void denoise(bool knows_variance);
    void write_with(const MatteSource& mattes);
    [[nodiscard]] std::size_t pixel_floats() const;

    std::optional<Denoiser> denoiser_;
    std::string guide_;  ///< what guides the denoiser
    bool is_fast_;
    std::size_t matte_floats_;  ///< of a pixel's mattes
    PictureFiles files_;
    int width_ = 0;
    /// Rows that wait to be denoised, with the channels of kRawLayer at the end, or for mattes.
    std::vector<float> rows_;
    double denoising_seconds_ = 0.0;
    double matte_seconds_ = 0.0;
    bool lacks_mattes_ = false;
    std::future<void> libraries_;  ///< of image files, which are loaded while rows wait
};

}  // namespace nearlight::core
