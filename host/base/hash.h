// SPDX-License-Identifier: Apache-2.0
// FNV-1a, 64 bits: the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace nearlight {

inline constexpr std::uint64_t kFnvSeed = 14695981039346656037ull;

inline std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash = kFnvSeed) {
    for (const std::byte b : bytes) {
        hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211ull;
    }
    return hash;
}
inline std::uint64_t fnv1a(std::string_view text, std::uint64_t hash = kFnvSeed) {
    return fnv1a(std::as_bytes(std::span(text.data(), text.size())), hash);
}

/// Sixteen hexadecimal digits.
inline std::string hex_digits(std::uint64_t value) {
    std::string text(16, '0');
    for (int i = 15; i >= 0; --i, value >>= 4u) {
        text[static_cast<std::size_t>(i)] = "0123456789abcdef"[value & 15u];
    }
    return text;
}

}  // namespace nearlight
