// SPDX-License-Identifier: Apache-2.0
#include "host/base/cryptomatte_id.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace nearlight::core {
namespace {

constexpr std::uint32_t kLargestExponent = 254;  // of finite floats
constexpr int kMantissaBits = 23;

/// Mixes a word of the text before it joins the hash.
std::uint32_t mixed_word(std::uint32_t word) {
    return std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/// Up to four bytes, the first of which is the lowest.
std::uint32_t word_of(std::string_view bytes) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    }
    return word;
}

}  // namespace

std::uint32_t murmur_hash3(std::string_view bytes) {
    std::uint32_t hash = 0;
    std::size_t at = 0;
    for (; at + 4 <= bytes.size(); at += 4) {
        hash = std::rotl(hash ^ mixed_word(word_of(bytes.substr(at, 4))), 13) * 5 + 0xe6546b64u;
    }
    hash ^= mixed_word(word_of(bytes.substr(at)));
    hash ^= static_cast<std::uint32_t>(bytes.size());
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
    return hash ^ (hash >> 16);
}

std::uint32_t cryptomatte_id(std::string_view name) {
    const std::uint32_t hash = murmur_hash3(name);
    const std::uint32_t exponent = std::clamp((hash >> kMantissaBits) & 0xffu, 1u, kLargestExponent);
    return (hash & ~(0xffu << kMantissaBits)) | (exponent << kMantissaBits);
}

}  // namespace nearlight::core
