// SPDX-License-Identifier: Apache-2.0
// The image module. No other file knows OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "host/base/names.h"
#include "host/base/words.h"
#include "host/image/head_check.h"
#include "host/image/image_codec.h"
#include "host/image/webp_codec.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

/// The options leave alpha as the file has it.
OIIO::ImageSpec reading_options() {
    OIIO::ImageSpec options;
    options.attribute("oiio:UnassociatedAlpha", 1);
    return options;
}

/// What a file of a format begins with.
struct Signature {
    std::string_view start;
    const char* format;  ///< OpenImageIO's name
};
using namespace std::string_view_literals;
constexpr Signature kSignatures[] = {
    {"\x76\x2f\x31\x01"sv, "openexr"},
    {"\x89PNG\r\n\x1a\n"sv, "png"},
    {"\xff\xd8\xff"sv, "jpeg"},
    {"#?"sv, "hdr"},
    {"BM"sv, "bmp"},
    {"II*\0"sv, "tiff"},
    {"MM\0*"sv, "tiff"},
    {"II+\0"sv, "tiff"},
    {"MM\0+"sv, "tiff"},
    {"GIF87a"sv, "gif"},
    {"GIF89a"sv, "gif"},
    {"8BPS"sv, "psd"},
    {"DDS "sv, "dds"},
};

std::uintmax_t size_of(const fs::path& file, OIIO::Filesystem::IOProxy* memory) {
    std::error_code ignored;
    return memory != nullptr ? memory->size() : fs::file_size(file, ignored);
}

ImageHead read_head(const fs::path& file, OIIO::Filesystem::IOProxy* memory) {
    ImageHead head{};
    static_cast<void>(memory != nullptr
                          ? memory->pread(head.data(), head.size(), 0)
                          : OIIO::Filesystem::read_bytes(file.string(), head.data(), head.size()));
    return head;
}

/// OpenImageIO's name of a file's format. OpenImageIO itself would try all its readers, some of which crash
/// on damaged files. Files of Targa have no signature, and those of the PNM family are told by their second
/// letter.
std::string format_of(const fs::path& file, const ImageHead& head) {
    const std::string_view start(head.data(), head.size());
    for (const Signature& known : kSignatures) {
        if (start.starts_with(known.start)) {
            return known.format;
        }
    }
    if (start[0] == 'P' && "1234567Ff"sv.find(start[1]) != std::string_view::npos) {
        return "pnm";
    }
    if (equal_in_any_case(file.extension().string(), ".tga")) {
        return "targa";
    }
    fail_image("cannot read image", file,
               "it is none of EXR, PNG, JPEG, HDR, TIFF, Targa, BMP, GIF, WebP, PSD, DDS, PNM and PFM");
}

/// Refuses a TIFF file of CMYK in tiles, whatever its compression. OpenImageIO 2.4 takes room for three
/// channels, and writes four.
void check_tiff_tiles(const fs::path& file, const OIIO::ImageSpec& spec) {
    constexpr int kSeparated = 5;  // inks, as TIFF 6.0 numbers the values of PhotometricInterpretation
    if (spec.tile_width > 0 && spec.get_int_attribute("tiff:PhotometricInterpretation") == kSeparated) {
        fail_image("cannot read image", file, "tiles of CMYK in TIFF are not supported; save it as RGB");
    }
}

std::unique_ptr<OIIO::ImageInput> open(const fs::path& file, OIIO::Filesystem::IOProxy* memory = nullptr) {
    const ImageHead head = read_head(file, memory);
    const std::string format = format_of(file, head);
    if (format == "gif") {
        check_gif_screen(file, head, size_of(file, memory));
    } else if (format == "dds") {
        check_dds_masks(file, head);
    }
    OIIO::ImageSpec options = reading_options();
    // The proxy is passed both ways, because some formats take it from the options and ignore the other.
    void* const proxy = memory;
    if (memory != nullptr) {
        options.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    }
    auto input = OIIO::ImageInput::create(format);
    if (!input) {
        fail_image("cannot read image", file, OIIO::geterror());
    }
    // OpenImageIO 2.4 fills a table of tags at the first ICC profile, of whatever format, without a lock.
    static std::mutex heads;
    const std::scoped_lock one_at_a_time(heads);
    OIIO::ImageSpec spec;
    if ((memory != nullptr && !input->set_ioproxy(memory)) || !input->open(file.string(), spec, options)) {
        fail_image("cannot read image", file, input->geterror());
    }
    return input;
}

bool holds_codes(const OIIO::ImageSpec& spec) {
    return spec.format == OIIO::TypeDesc::UINT8 && spec.channelformats.empty();
}

/// Reads the rows [first, end) as the file has them; images of tiles can be read as a whole only. For numbers
/// of another type, OpenImageIO would take memory for at least 256 rows, however many are asked for.
bool read_rows(OIIO::ImageInput& input, int first, int end, std::vector<std::byte>& native) {
    const OIIO::ImageSpec& spec = input.spec();
    native.resize(spec.scanline_bytes(true) * static_cast<std::size_t>(end - first));
    return spec.tile_width > 0
               ? input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UNKNOWN, native.data())
               : input.read_scanlines(0, 0, spec.y + first, spec.y + end, 0, 0, spec.nchannels,
                                      OIIO::TypeDesc::UNKNOWN, native.data());
}

/// Turns pixels as the file has them into floats. OpenImageIO could turn codes of 8 bits into floats too, but
/// takes longer for that than for all else.
void convert(const OIIO::ImageSpec& spec, std::span<const std::byte> native, float* numbers) {
    if (holds_codes(spec)) {
        std::transform(native.begin(), native.end(), numbers, [](std::byte code) {
            return static_cast<float>(std::to_integer<int>(code)) * (1.0f / 255.0f);
        });
        return;
    }
    const std::size_t pixel_bytes = spec.pixel_bytes(true);
    const auto count = static_cast<int>(native.size() / pixel_bytes);
    if (spec.channelformats.empty()) {
        OIIO::convert_pixel_values(spec.format, native.data(), OIIO::TypeDesc::FLOAT, numbers,
                                   count * spec.nchannels);
        return;
    }
    std::size_t offset = 0;
    for (int channel = 0; channel < spec.nchannels; ++channel) {
        const OIIO::TypeDesc type = spec.channelformat(channel);
        OIIO::convert_image(
            1, count, 1, 1, native.data() + offset, type, static_cast<OIIO::stride_t>(pixel_bytes),
            OIIO::AutoStride, OIIO::AutoStride, numbers + channel, OIIO::TypeDesc::FLOAT,
            static_cast<OIIO::stride_t>(spec.nchannels * sizeof(float)), OIIO::AutoStride, OIIO::AutoStride);
        offset += type.size();
    }
}

/// Reads all pixels. Images of scanlines are read in parts, so that a short file whose header promises many
/// pixels takes memory for the first part only.
bool read_pixels(OIIO::ImageInput& input, std::vector<float>& values) {
    constexpr std::size_t kPart = std::size_t{4} << 20;  // numbers
    const OIIO::ImageSpec& spec = input.spec();
    const std::size_t row = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels);
    const bool has_tiles = spec.tile_width > 0;
    if (has_tiles && !holds_codes(spec)) {
        // Tiles are read as a whole, so that numbers need not be kept in the file's type, too.
        values.resize(row * static_cast<std::size_t>(spec.height));
        return input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data());
    }
    const int step =
        has_tiles ? spec.height : static_cast<int>(std::clamp<std::size_t>(kPart / row, 1, 1u << 16));
    std::vector<std::byte> native;
    values.reserve(row * static_cast<std::size_t>(spec.height));
    for (int first = 0; first < spec.height; first += step) {
        const int end = std::min(first + step, spec.height);
        if (!read_rows(input, first, end, native)) {
            return false;
        }
        const std::size_t before = values.size();
        values.resize(before + row * static_cast<std::size_t>(end - first));
        convert(spec, native, values.data() + before);
    }
    return true;
}

/// What the data window is of the display window, if they differ.
std::optional<ImagePlace> place_of(const OIIO::ImageSpec& spec) {
    const ImagePlace place{spec.x - spec.full_x, spec.y - spec.full_y, spec.full_width, spec.full_height};
    const ImagePlace all{0, 0, spec.width, spec.height};
    return place == all ? std::nullopt : std::optional(place);
}

/// Whether all that a reader reported are bytes that belong to no part of a JPEG file, as some cameras leave
/// them. They cost no pixel.
bool are_spare_bytes(std::string_view reports) {
    while (!reports.empty()) {
        const std::string_view line = reports.substr(0, reports.find('\n'));
        if (line.find("extraneous bytes before marker") == std::string_view::npos) {
            return false;
        }
        reports.remove_prefix(std::min(line.size() + 1, reports.size()));
    }
    return true;
}

Image decode(const fs::path& file, std::span<const std::byte> bytes) {
    if (std::optional<Image> webp = decode_webp(file, bytes)) {
        return std::move(*webp);
    }
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    OIIO::Filesystem::IOProxy* const proxy = bytes.empty() ? nullptr : &memory;
    const auto input = open(file, proxy);
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.deep) {
        fail_image("cannot read image", file, "deep images are not supported; save it flattened");
    }
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) {
        fail_image("cannot read image", file, "it is not a plain two-dimensional image");
    }
    check_tiff_tiles(file, spec);
    const bool is_dwa = spec.get_string_attribute("compression").substr(0, 3) == "dwa";
    check_fits_in_file(file, std::max(spec.image_bytes(true), spec.tile_bytes(true)), size_of(file, proxy),
                       is_dwa ? kDwaDensity : kUsualDensity);
    Image image{.width = spec.width,
                .height = spec.height,
                .channels = spec.channelnames,
                .values = {},
                .holds_floats = spec.format.is_floating_point(),
                .place = place_of(spec)};
    const bool has_pixels = read_pixels(*input, image.values);
    const std::string reports = input->geterror();
    if (!has_pixels || !are_spare_bytes(reports)) {
        fail_image("cannot read image", file, reports);
    }
    return image;
}

Metadata decode_metadata(const fs::path& file) {
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

OIIO::ImageSpec exr_spec(const EncodingTask& task) {
    OIIO::ImageSpec spec(task.width, task.height, static_cast<int>(task.channels.size()),
                         OIIO::TypeDesc::FLOAT);
    if (task.place) {
        spec.x = task.place->x;
        spec.y = task.place->y;
        spec.full_width = task.place->whole_width;
        spec.full_height = task.place->whole_height;
    }
    spec.channelnames = task.channels;
    for (const bool is_half : task.half) {
        spec.channelformats.push_back(is_half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    }
    const auto alpha = std::find(task.channels.begin(), task.channels.end(), "A");
    spec.alpha_channel = alpha != task.channels.end() ? static_cast<int>(alpha - task.channels.begin()) : -1;
    spec.attribute("compression", name_in(kExrCompressions, task.compression));
    // Rec. 709 primaries with the white point D65: x and y of red, green, blue and white.
    constexpr std::array kChromaticities{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, kChromaticities.size()),
                   kChromaticities.data());
    for (const auto& [name, value] : task.metadata) {
        set_attribute(spec, name, value);
    }
    return spec;
}

OIIO::ImageSpec png_spec(const EncodingTask& task) {
    OIIO::ImageSpec spec(task.width, task.height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    for (const auto& [name, value] : task.metadata) {
        if (std::holds_alternative<std::string>(value)) {
            set_attribute(spec, name, value);
        }
    }
    return spec;
}

class OiioEncoder : public ImageEncoder {
  public:
    explicit OiioEncoder(const EncodingTask& task)
        : type_(task.format == ImageFormat::exr ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8),
          proxy_(task.stream, OIIO::Filesystem::IOProxy::Write),
          output_(OIIO::ImageOutput::create(task.format == ImageFormat::exr ? "openexr" : "png", &proxy_)) {
        if (!output_) {
            fail_image("cannot write image", task.name, OIIO::geterror());
        }
        output_->set_ioproxy(&proxy_);
        if (!output_->open(task.name, task.format == ImageFormat::exr ? exr_spec(task) : png_spec(task))) {
            fail_image("cannot write image", task.name, output_->geterror());
        }
    }
    ~OiioEncoder() override {
        if (output_) {
            output_->close();
        }
    }

    std::string write(int first, int end, const void* values) override {
        const int top = output_->spec().y;
        return output_->write_scanlines(top + first, top + end, 0, type_, values) ? "" : reason();
    }
    std::string close() override {
        const std::string failed = output_->close() ? "" : reason();
        output_.reset();
        return failed;
    }

  private:
    [[nodiscard]] std::string reason() const {
        const std::string text = output_->geterror();
        return text.empty() ? "the file cannot be written" : text;
    }

    OIIO::TypeDesc type_;
    OIIO::Filesystem::IOFile proxy_;
    std::unique_ptr<OIIO::ImageOutput> output_;
};

std::unique_ptr<ImageEncoder> make_encoder(const EncodingTask& task) {
    return std::make_unique<OiioEncoder>(task);
}

}  // namespace
}  // namespace nearlight::core

extern "C" {
extern const nearlight::core::ImageCodec nearlight_image_codec;
const nearlight::core::ImageCodec nearlight_image_codec{
    nearlight::core::decode, nearlight::core::decode_metadata, nearlight::core::make_encoder};
}
