// SPDX-License-Identifier: Apache-2.0
#include "host/image/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <system_error>
#include <utility>

#include "host/base/error.h"
#include "host/image/color.h"
#include "host/image/exr_patch.h"

namespace nearlight {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* what, const fs::path& file, std::string reason) {
    // Libraries end some of their messages with line breaks; ours have one line.
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    reason.erase(reason.find_last_not_of(" .") + 1);
    throw Error(ExitCode::file, std::string(what) + " '" + file.string() +
                                    "': " + (reason.empty() ? "unknown reason" : reason));
}

/// Alpha is left as the file has it.
OIIO::ImageSpec reading_options() {
    OIIO::ImageSpec options;
    options.attribute("oiio:UnassociatedAlpha", 1);
    return options;
}

bool is_integer(const OIIO::ImageSpec& spec) {
    return !spec.format.is_floating_point();
}

/// Colour channels of integer files are sRGB-encoded, unless the file says otherwise.
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

/// A broken header may promise any size. Deflate, the densest of the compressions in use, packs about 1000
/// to 1.
bool fits_in_file(const OIIO::ImageSpec& spec, std::uintmax_t file_size) {
    constexpr std::uintmax_t kDensest = 2000;
    constexpr std::uintmax_t kAlwaysFine = 64u << 20u;
    return spec.image_bytes(true) <= kAlwaysFine + kDensest * file_size;
}

std::unique_ptr<OIIO::ImageInput> open(const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) {
        fail("cannot read image", file, "no such file");
    }
    if (fs::is_directory(file, ignored)) {
        fail("cannot read image", file, "it is a folder");
    }
    const OIIO::ImageSpec options = reading_options();
    auto input = OIIO::ImageInput::open(file.string(), &options);
    if (!input) {
        fail("cannot read image", file, OIIO::geterror());
    }
    return input;
}

Image read(const fs::path& file, bool decode_srgb) {
    const auto input = open(file);
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) {
        fail("cannot read image", file, "it is not a plain two-dimensional image");
    }
    std::error_code ignored;
    if (!fits_in_file(spec, fs::file_size(file, ignored))) {
        fail("cannot read image", file, "its header promises more pixels than it can hold");
    }
    Image image = make_image(spec.width, spec.height, spec.channelnames);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()) ||
        input->has_error()) {
        fail("cannot read image", file, input->geterror());
    }
    if (decode_srgb && is_integer(spec) && spec.get_string_attribute("oiio:ColorSpace") != "Linear") {
        linearize(image);
    }
    return image;
}

enum class Format { exr, png };

Format format_of(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr") {
        return Format::exr;
    }
    if (extension == ".png") {
        return Format::png;
    }
    throw Error(ExitCode::usage, "cannot write image '" + file.string() + "': unknown extension '" +
                                     extension + "', use .exr or .png");
}

/// Beside the target, so that a rename never crosses file systems; no two writers share one.
fs::path temporary_path(const fs::path& file) {
    std::random_device random;
    std::array<char, 40> suffix{};
    std::snprintf(suffix.data(), suffix.size(), ".partial-%d-%08x", static_cast<int>(getpid()), random());
    return file.string() + suffix.data();
}

void set_attribute(OIIO::ImageSpec& spec, const std::string& name, const Metadata::mapped_type& value) {
    if (const auto* integer = std::get_if<int>(&value)) {
        spec.attribute(name, *integer);
    } else if (const auto* number = std::get_if<float>(&value)) {
        spec.attribute(name, *number);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
        spec.attribute(name, *text);
    } else {
        const auto& numbers = std::get<std::vector<float>>(value);
        const auto type = numbers.size() == 16
                              ? OIIO::TypeMatrix44
                              : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, static_cast<int>(numbers.size()));
        spec.attribute(name, type, numbers.data());
    }
}

OIIO::ImageSpec exr_spec(int width, int height, const std::vector<std::string>& channels,
                         const Metadata& metadata) {
    OIIO::ImageSpec spec(width, height, static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = channels;
    spec.attribute("compression", "zip");
    for (const auto& [name, value] : metadata) {
        set_attribute(spec, name, value);
    }
    return spec;
}

OIIO::ImageSpec png_spec(int width, int height) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return spec;
}

}  // namespace

Image read_image(const fs::path& file) {
    return read(file, false);
}

Image read_linear_image(const fs::path& file) {
    return read(file, true);
}

Metadata read_metadata(const fs::path& file) {
    const auto input = open(file);
    Metadata metadata;
    for (const OIIO::ParamValue& attribute : input->spec().extra_attribs) {
        const std::string name = attribute.name().string();
        if (attribute.type() == OIIO::TypeInt) {
            metadata[name] = attribute.get_int();
        } else if (attribute.type() == OIIO::TypeFloat) {
            metadata[name] = attribute.get_float();
        } else if (attribute.type() == OIIO::TypeString) {
            metadata[name] = attribute.get_string();
        }
    }
    return metadata;
}

/// Owns the temporary file: whatever is not committed is removed.
struct ImageWriter::State {
    fs::path target;
    fs::path temporary;
    Format format = Format::exr;
    int width = 0;
    int height = 0;
    int next_row = 0;
    std::size_t channel_count = 0;
    std::array<std::size_t, 3> rgb{};  ///< PNG: where the colour is among the channels
    float scale = 1.0f;                ///< PNG: exposure as a factor
    std::vector<std::uint8_t> encoded;
    // A stream of our own tells of every failed write, also of those after the last row.
    std::FILE* stream = nullptr;
    std::unique_ptr<OIIO::Filesystem::IOFile> proxy;
    std::unique_ptr<OIIO::ImageOutput> output;

    ~State();
    void open(const std::vector<std::string>& channels, const ImageWriterOptions& options);
    void write(int row_count, const float* values);
    void close();
    [[noreturn]] void fail_to_write(const std::string& reason) const {
        fail("cannot write image", target, reason);
    }
};

ImageWriter::State::~State() {
    if (output) {
        output->close();
    }
    if (stream != nullptr) {
        std::fclose(stream);
    }
    if (!temporary.empty()) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
    }
}

void ImageWriter::State::open(const std::vector<std::string>& channels, const ImageWriterOptions& options) {
    const fs::path path = temporary_path(target);
    stream = std::fopen(path.c_str(), "wb");
    if (stream == nullptr) {
        fail_to_write(std::strerror(errno));
    }
    temporary = path;
    proxy = std::make_unique<OIIO::Filesystem::IOFile>(stream, OIIO::Filesystem::IOProxy::Write);
    output = OIIO::ImageOutput::create(format == Format::exr ? "openexr" : "png", proxy.get());
    if (!output) {
        fail_to_write(OIIO::geterror());
    }
    output->set_ioproxy(proxy.get());
    const OIIO::ImageSpec spec =
        format == Format::exr ? exr_spec(width, height, channels, options.metadata) : png_spec(width, height);
    if (!output->open(temporary.string(), spec)) {
        fail_to_write(output->geterror());
    }
}

void ImageWriter::State::write(int row_count, const float* values) {
    bool written = false;
    const int end = next_row + row_count;
    if (format == Format::exr) {
        written = output->write_scanlines(next_row, end, 0, OIIO::TypeDesc::FLOAT, values);
    } else {
        const std::size_t pixel_count = static_cast<std::size_t>(row_count) * static_cast<std::size_t>(width);
        encoded.resize(pixel_count * 3);
        for (std::size_t i = 0; i < pixel_count; ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                encoded[i * 3 + c] = linear_to_srgb8(values[i * channel_count + rgb[c]] * scale);
            }
        }
        written = output->write_scanlines(next_row, end, 0, OIIO::TypeDesc::UINT8, encoded.data());
    }
    if (!written || std::ferror(stream) != 0) {
        const int error = errno;
        const std::string reason = output->geterror();
        fail_to_write(reason.empty() ? std::strerror(error) : reason);
    }
    next_row = end;
}

void ImageWriter::State::close() {
    if (!output->close()) {
        fail_to_write(output->geterror());
    }
    output.reset();
    // The last bytes leave the buffers here, and may find the disk full.
    const bool flushed = std::fflush(stream) == 0 && std::ferror(stream) == 0;
    const int error = errno;
    const bool closed = std::fclose(std::exchange(stream, nullptr)) == 0;
    if (!flushed || !closed) {
        fail_to_write(std::strerror(flushed ? errno : error));
    }
}

ImageWriter::ImageWriter(const fs::path& file, int width, int height, std::vector<std::string> channels,
                         const ImageWriterOptions& options)
    : state_(std::make_unique<State>()) {
    state_->target = file;
    state_->format = format_of(file);
    state_->width = width;
    state_->height = height;
    state_->channel_count = channels.size();
    state_->scale = std::exp2(options.exposure);
    if (width < 1 || height < 1 || channels.empty()) {
        state_->fail_to_write("it has no pixels");
    }
    if (state_->format == Format::png) {
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

void ImageWriter::write_rows(std::span<const float> values) {
    const std::size_t row_size = static_cast<std::size_t>(state_->width) * state_->channel_count;
    const std::size_t row_count = values.size() / row_size;
    if (values.size() % row_size != 0 ||
        row_count > static_cast<std::size_t>(state_->height - state_->next_row)) {
        throw Error(ExitCode::runtime, "cannot write image '" + state_->target.string() +
                                           "': " + std::to_string(values.size()) +
                                           " values are not whole rows, or too many");
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
    if (state_->format == Format::exr) {
        for (const auto& [name, value] : late) {
            patch_exr_float(state_->temporary, name, value);
        }
    }
    std::error_code error;
    fs::rename(state_->temporary, state_->target, error);
    if (error) {
        state_->fail_to_write(error.message());
    }
    state_->temporary.clear();
}

void write_image(const fs::path& file, const Image& image, const ImageWriterOptions& options) {
    ImageWriter writer(file, image.width, image.height, image.channels, options);
    writer.write_rows(image.values);
    writer.commit();
}

}  // namespace nearlight
