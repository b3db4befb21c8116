// SPDX-License-Identifier: Apache-2.0
#include "host/image/image_io.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include "host/base/atomic_file.h"
#include "host/base/files.h"
#include "host/base/half.h"
#include "host/image/color.h"
#include "host/image/exr_patch.h"
#include "host/image/image_codec.h"
#include "host/image/pnm.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

/// Colour channels of files of integers are sRGB-encoded. What a file says of its gamma counts for nothing,
/// as in Mitsuba.
void linearize(Image& image) {
    for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
        if (image.channels[channel] == "A") {
            continue;
        }
        for (std::size_t i = channel; i < image.values.size(); i += image.channel_count()) {
            image.values[i] = srgb_to_linear(image.values[i]);
        }
    }
}

void check_readable(const fs::path& file) {
    if (const std::string reason = reason_not_to_read(file); !reason.empty()) {
        fail_image("cannot read image", file, reason);
    }
}

Image read(const fs::path& file, bool decode_srgb) {
    check_readable(file);
    std::optional<Image> plain = read_pnm(file);
    Image image = plain ? std::move(*plain) : image_codec().read(file, {});
    if (decode_srgb && !image.holds_floats) {
        linearize(image);
    }
    return image;
}

ImageFormat format_of(const fs::path& file) {
    const std::string extension = lower_case_extension(file);
    if (extension == ".exr") {
        return ImageFormat::exr;
    }
    if (extension == ".png") {
        return ImageFormat::png;
    }
    throw Error(ErrorKind::invalid_argument, "cannot write image '" + file.string() +
                                                 "': unknown extension '" + extension +
                                                 "'; use .exr or .png");
}

}  // namespace

Image read_image(const fs::path& file) {
    return read(file, false);
}

Image read_image(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.empty()) {
        fail_image("cannot read image", name, "it is empty");
    }
    return image_codec().read(name, bytes);
}

Image read_linear_image(const fs::path& file) {
    return read(file, true);
}

void load_image_libraries() {
    static_cast<void>(image_codec());
}

Metadata read_metadata(const fs::path& file) {
    check_readable(file);
    return image_codec().read_metadata(file);
}

struct ImageWriter::State {
    AtomicFile file;
    ImageFormat format = ImageFormat::exr;
    int width = 0;
    int height = 0;
    int next_row = 0;
    std::size_t channel_count = 0;
    std::array<std::size_t, 3> rgb{};  ///< indices of R, G and B among the channels, for PNG
    float scale = 1.0f;                ///< exposure as a factor, for PNG
    ToneCurve curve = ToneCurve::linear;
    std::vector<std::uint8_t> encoded;
    std::vector<float> limited;
    std::size_t limited_count = 0;
    // A stream of our own reports every failed write, even after the last row.
    std::FILE* stream = nullptr;
    EncodingTask task;
    /// Made when the first rows come, so that the start does not wait for the module.
    std::unique_ptr<ImageEncoder> encoder;

    explicit State(const fs::path& target) : file(target) {}
    ~State();
    void open(const std::vector<std::string>& channels, const ImageWriterOptions& options);
    void write(int row_count, const float* values);
    const float* within_half(int row_count, const float* values);
    void encode_pixel(const float* channels, std::uint8_t* codes) const;
    void close();
    [[noreturn]] void fail_to_write(const std::string& reason) const {
        fail_image("cannot write image", file.target(), reason);
    }
    /// For a file that was open already.
    [[noreturn]] void fail_to_go_on(const std::string& reason) const {
        fail_to_write(reason + "; is the disk full, or its folder gone?");
    }
};

ImageWriter::State::~State() {
    encoder.reset();
    if (stream != nullptr) {
        std::fclose(stream);
    }
}

void ImageWriter::State::open(const std::vector<std::string>& channels, const ImageWriterOptions& options) {
    stream = std::fopen(file.temporary().c_str(), "wb");
    if (stream == nullptr) {
        const int error = errno;
        const std::string missing = missing_folder_text(file.target());
        fail_to_write(missing.empty() ? std::strerror(error) : missing);
    }
    task = {.stream = stream,
            .name = file.target().string(),
            .format = format,
            .width = width,
            .height = height,
            .channels = channels,
            .half = options.half,
            .compression = options.compression,
            .place = options.place,
            .metadata = options.metadata};
}

/// The values. In channels of 16 bits, finite ones are bounded by what these can hold.
const float* ImageWriter::State::within_half(int row_count, const float* values) {
    if (task.half.empty()) {
        return values;
    }
    const std::size_t pixel_count = static_cast<std::size_t>(row_count) * static_cast<std::size_t>(width);
    limited.assign(values, values + pixel_count * channel_count);
    for (std::size_t i = 0; i < limited.size(); ++i) {
        if (task.half[i % channel_count] && std::isfinite(limited[i]) && std::abs(limited[i]) > kMaxHalf) {
            limited[i] = std::copysign(kMaxHalf, limited[i]);
            ++limited_count;
        }
    }
    return limited.data();
}

void ImageWriter::State::encode_pixel(const float* channels, std::uint8_t* codes) const {
    const Vec3 color{channels[rgb[0]] * scale, channels[rgb[1]] * scale, channels[rgb[2]] * scale};
    const Vec3 shown = apply_tone_curve(curve, color);
    codes[0] = linear_to_srgb8(shown.x);
    codes[1] = linear_to_srgb8(shown.y);
    codes[2] = linear_to_srgb8(shown.z);
}

void ImageWriter::State::write(int row_count, const float* values) {
    if (!encoder) {
        encoder = image_codec().make_encoder(task);
    }
    std::string failed;
    const int end = next_row + row_count;
    if (format == ImageFormat::exr) {
        failed = encoder->write(next_row, end, within_half(row_count, values));
    } else {
        const std::size_t pixel_count = static_cast<std::size_t>(row_count) * static_cast<std::size_t>(width);
        encoded.resize(pixel_count * 3);
        for (std::size_t i = 0; i < pixel_count; ++i) {
            encode_pixel(values + i * channel_count, encoded.data() + 3 * i);
        }
        failed = encoder->write(next_row, end, encoded.data());
    }
    const int error = errno;
    if (!failed.empty() || std::ferror(stream) != 0) {
        fail_to_go_on(failed.empty() ? std::strerror(error) : failed);
    }
    next_row = end;
}

void ImageWriter::State::close() {
    if (const std::string failed = encoder->close(); !failed.empty()) {
        fail_to_go_on(failed);
    }
    encoder.reset();
    // The last bytes leave the buffers only now, and the disk may be full.
    const bool flushed = std::fflush(stream) == 0 && std::ferror(stream) == 0;
    const int error = errno;
    const bool closed = std::fclose(std::exchange(stream, nullptr)) == 0;
    if (!flushed || !closed) {
        fail_to_go_on(std::strerror(flushed ? errno : error));
    }
}

ImageWriter::ImageWriter(const fs::path& file, int width, int height, std::vector<std::string> channels,
                         const ImageWriterOptions& options)
    : state_(std::make_unique<State>(file)) {
    state_->format = format_of(file);
    state_->width = width;
    state_->height = height;
    state_->channel_count = channels.size();
    state_->scale = std::exp2(options.exposure);
    state_->curve = options.curve;
    if (width < 1 || height < 1 || channels.empty()) {
        state_->fail_to_write("it has no pixels");
    }
    if (state_->format == ImageFormat::png) {
        const std::array<const char*, 3> names{"R", "G", "B"};
        for (std::size_t c = 0; c < names.size(); ++c) {
            const auto found = std::find(channels.begin(), channels.end(), names[c]);
            if (found == channels.end()) {
                state_->fail_to_write("PNG needs channels R, G and B");
            }
            state_->rgb[c] = static_cast<std::size_t>(found - channels.begin());
        }
    }
    state_->open(channels, options);
}

ImageWriter::~ImageWriter() = default;
ImageWriter::ImageWriter(ImageWriter&&) noexcept = default;
ImageWriter& ImageWriter::operator=(ImageWriter&&) noexcept = default;

void ImageWriter::set_text(const std::string& name, const std::string& text) {
    state_->task.metadata[name] = text;
}

void ImageWriter::write_rows(std::span<const float> values) {
    const std::size_t row_size = static_cast<std::size_t>(state_->width) * state_->channel_count;
    const std::size_t row_count = values.size() / row_size;
    if (values.size() % row_size != 0 ||
        row_count > static_cast<std::size_t>(state_->height - state_->next_row)) {
        throw Error(ErrorKind::failure, "cannot write image '" + state_->file.target().string() +
                                            "': " + std::to_string(values.size()) +
                                            " values are not whole rows, or are too many");
    }
    if (row_count > 0) {
        state_->write(static_cast<int>(row_count), values.data());
    }
}

void ImageWriter::commit(const std::map<std::string, float>& late) {
    const std::vector<float> zeros(state_->next_row < state_->height
                                       ? static_cast<std::size_t>(state_->width) * state_->channel_count
                                       : 0);
    while (state_->next_row < state_->height) {
        state_->write(1, zeros.data());
    }
    state_->close();
    if (std::error_code ignored; !fs::exists(state_->file.temporary(), ignored)) {
        state_->fail_to_go_on("what was written of it is gone");
    }
    if (state_->format == ImageFormat::exr) {
        for (const auto& [name, value] : late) {
            patch_exr_float(state_->file.temporary(), name, value);
        }
    }
    if (const std::error_code error = state_->file.commit(Durability::result)) {
        state_->fail_to_go_on(error.message());
    }
}

std::size_t ImageWriter::limited_count() const {
    return state_->limited_count;
}

void write_image(const fs::path& file, const Image& image, const ImageWriterOptions& options) {
    ImageWriter writer(file, image.width, image.height, image.channels, options);
    writer.write_rows(image.values);
    writer.commit();
}

}  // namespace nearlight::core
