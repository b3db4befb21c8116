// SPDX-License-Identifier: Apache-2.0
#include "host/cli/rendered_picture.h"

#include <algorithm>
#include <system_error>

#include "host/image/image_io.h"
#include "host/session/passes.h"

namespace nearlight::core {
namespace {

constexpr const char* kDenoisedAttribute = "nearlight:denoised";
constexpr std::size_t kDenoisedPixelFloats = NEARLIGHT_LAYER_CHANNELS + kRawLayer.channel_count;

/// What guides the denoiser.
std::string guide_text(bool is_fast, bool uses_variance) {
    return is_fast
               ? "fast, albedo, N"
               : std::string("direct and indirect apart, albedo, N") + (uses_variance ? ", variance" : "");
}

}  // namespace

RenderedPicture::RenderedPicture(const PictureOptions& options, int threads)
    : is_fast_(options.denoise_fast),
      matte_floats_(kMatteChannels * matte_layers(options.layers).size()),
      files_(options) {
    if (options.denoise) {
        denoiser_.emplace(threads);
        guide_ = guide_text(is_fast_, false);
    }
}

std::string RenderedPicture::denoiser() const {
    return denoiser_ ? denoiser_->name() + " (" + guide_ + ")" : "none";
}

void RenderedPicture::open(int width, int height, Metadata metadata, const ScreenLook& look,
                           const std::optional<ImagePlace>& place) {
    metadata[kDenoisedAttribute] = denoiser();
    width_ = width;
    rows_.clear();
    files_.open(width, height, metadata, look, place);
}

void RenderedPicture::add_rows(std::span<const float> rows) {
    if (!denoiser_ && matte_floats_ == 0) {
        files_.write_rows(rows);
        return;
    }
    prepare_to_write();
    if (!denoiser_) {
        rows_.insert(rows_.end(), rows.begin(), rows.end());
        return;
    }
    for (std::size_t first = 0; first < rows.size(); first += NEARLIGHT_LAYER_CHANNELS) {
        const std::span<const float> pixel = rows.subspan(first, NEARLIGHT_LAYER_CHANNELS);
        const std::span<const float> beauty = pixel.subspan(NEARLIGHT_LAYER_BEAUTY, NEARLIGHT_CHANNELS_RGB);
        rows_.insert(rows_.end(), pixel.begin(), pixel.end());
        rows_.insert(rows_.end(), beauty.begin(), beauty.end());
    }
}

/// Loads the libraries of image files beside the rendering, once the first rows are there and the driver has
/// loaded its kernels: both wait for each other while they load.
void RenderedPicture::prepare_to_write() {
    if (libraries_.valid()) {
        return;
    }
    try {
        libraries_ = std::async(std::launch::async, load_image_libraries);
    } catch (const std::system_error&) {
        // Without a thread they are loaded when they are needed.
    }
}

void RenderedPicture::denoise(bool knows_variance) {
    const Stopwatch watch;
    float* const rows = rows_.data();
    std::vector<const float*> light{rows + NEARLIGHT_LAYER_DIRECT, rows + NEARLIGHT_LAYER_INDIRECT};
    if (is_fast_) {
        light = {rows + kRawLayer.first_channel};
    }
    const std::size_t row_floats = static_cast<std::size_t>(width_) * kDenoisedPixelFloats;
    const int height = static_cast<int>(rows_.size() / row_floats);
    const bool uses_variance = knows_variance && !is_fast_;
    denoiser_->denoise({.width = width_,
                        .height = height,
                        .pixel_floats = kDenoisedPixelFloats,
                        .light = std::move(light),
                        .albedo = rows + NEARLIGHT_LAYER_ALBEDO,
                        .normal = rows + NEARLIGHT_LAYER_NORMAL,
                        .variance = uses_variance ? rows + NEARLIGHT_LAYER_VARIANCE : nullptr,
                        .thorough = !is_fast_,
                        .output = rows + NEARLIGHT_LAYER_BEAUTY});
    guide_ = std::min(width_, height) < Denoiser::kMinSide
                 ? "unchanged: less than " + std::to_string(Denoiser::kMinSide) + " rows or columns"
                 : guide_text(is_fast_, uses_variance);
    files_.set_text(kDenoisedAttribute, denoiser());
    denoising_seconds_ = watch.seconds();
}

std::size_t RenderedPicture::pixel_floats() const {
    return denoiser_ ? kDenoisedPixelFloats : NEARLIGHT_LAYER_CHANNELS;
}

/// Writes the finished rows. The channels of each pixel are followed by its mattes.
void RenderedPicture::write_with(const MatteSource& mattes) {
    const Stopwatch watch;
    std::span<const float> rest = rows_;
    std::vector<float> both;
    const auto write = [&](std::span<const float> matte_rows) {
        both.clear();
        for (; !matte_rows.empty() && !rest.empty(); matte_rows = matte_rows.subspan(matte_floats_)) {
            both.insert(both.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(pixel_floats()));
            both.insert(both.end(), matte_rows.begin(),
                        matte_rows.begin() + static_cast<std::ptrdiff_t>(matte_floats_));
            rest = rest.subspan(pixel_floats());
        }
        files_.write_rows(both);
        return !rest.empty();
    };
    mattes(write);
    lacks_mattes_ = !rest.empty();
    const std::vector<float> no_mattes(static_cast<std::size_t>(width_) * matte_floats_);
    while (!rest.empty()) {
        write(no_mattes);
    }
    matte_seconds_ = watch.seconds();
}

void RenderedPicture::commit(const Stopwatch& since_begin, std::span<const uint> pass_samples, bool quiet,
                             const MatteSource& mattes) {
    if (denoiser_ && !rows_.empty()) {
        denoise(tells_error(pass_samples));
    }
    if (matte_floats_ > 0) {
        write_with(mattes);
    } else if (!rows_.empty()) {
        files_.write_rows(rows_);
    }
    files_.commit(since_begin.seconds(), quiet);
}

}  // namespace nearlight::core
