// SPDX-License-Identifier: Apache-2.0
#include "host/image/webp_codec.h"

#include <webp/decode.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

namespace nearlight::core {
namespace {

/// "RIFF", four bytes of size, "WEBP".
constexpr std::size_t kHeadSize = 12;

bool is_webp(std::span<const std::byte> content) {
    return content.size() >= kHeadSize && std::memcmp(content.data(), "RIFF", 4) == 0 &&
           std::memcmp(content.data() + 8, "WEBP", 4) == 0;
}

/// The content of the file, if it is WebP.
std::string webp_in(const std::filesystem::path& file) {
    std::ifstream input(file, std::ios::binary);
    std::string content(kHeadSize, '\0');
    if (!input.read(content.data(), kHeadSize) || !is_webp(std::as_bytes(std::span(content)))) {
        return {};
    }
    return content.append(std::istreambuf_iterator<char>(input), {});
}

struct WebPDeleter {
    void operator()(std::uint8_t* pixels) const { WebPFree(pixels); }
};

}  // namespace

std::optional<Image> decode_webp(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    const std::string from_file = bytes.empty() ? webp_in(file) : std::string();
    const auto content = bytes.empty() ? std::as_bytes(std::span(from_file)) : bytes;
    if (!is_webp(content)) {
        return std::nullopt;
    }
    const auto* const data = reinterpret_cast<const std::uint8_t*>(content.data());
    WebPBitstreamFeatures features{};
    if (WebPGetFeatures(data, content.size(), &features) != VP8_STATUS_OK || features.has_animation != 0) {
        fail_image("cannot read image", file,
                   features.has_animation != 0 ? "it is an animation" : "it is damaged");
    }
    const std::size_t channels = features.has_alpha != 0 ? 4 : 3;
    const std::size_t count =
        static_cast<std::size_t>(features.width) * static_cast<std::size_t>(features.height) * channels;
    check_fits_in_file(file, count, content.size());
    int width = 0;
    int height = 0;
    const auto decode = channels == 4 ? WebPDecodeRGBA : WebPDecodeRGB;
    const std::unique_ptr<std::uint8_t, WebPDeleter> codes(decode(data, content.size(), &width, &height));
    if (!codes) {
        fail_image("cannot read image", file, "it is damaged or incomplete");
    }
    Image image{
        .width = width, .height = height, .channels = {"R", "G", "B"}, .values = {}, .holds_floats = false};
    if (channels == 4) {
        image.channels.emplace_back("A");
    }
    image.values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        image.values.push_back(static_cast<float>(codes.get()[i]) * (1.0f / 255.0f));
    }
    return image;
}

}  // namespace nearlight::core
