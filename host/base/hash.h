// SPDX-License-Identifier: Apache-2.0
// Hashes of data in memory, for keys and checksums of cached files and for comparing pictures. They are XXH3
// hashes [Collet], which are the same on all little-endian machines and do not resist deliberate collisions.
// The minimal build does without xxHash; its hash_plain.cpp gives other hashes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace nearlight::core {

using Hash128 = std::array<std::uint64_t, 2>;

/// Hashes data that comes in parts. The result does not depend on where one part ends and the next begins.
class Hasher {
  public:
    Hasher();
    ~Hasher();
    Hasher(Hasher&&) noexcept;
    Hasher& operator=(Hasher&&) noexcept;

    void add_bytes(std::span<const std::byte> bytes);
    void add_text(std::string_view text) { add_bytes(std::as_bytes(std::span(text.data(), text.size()))); }
    /// Hashes the bytes of the value, with its padding, which must therefore be zero.
    template <typename T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        add_bytes(std::as_bytes(std::span(&value, 1)));
    }
    /// Hashes the array with its length; otherwise two arrays would hash like two others with the same
    /// concatenation.
    template <typename T>
    void add_array(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(std::uint64_t{values.size()});
        add_bytes(std::as_bytes(values));
    }
    template <typename T>
    void add_array(const std::vector<T>& values) {
        add_array(std::span<const T>(values));
    }

    [[nodiscard]] std::uint64_t hash64() const;
    [[nodiscard]] Hash128 hash128() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

std::uint64_t hash64(std::span<const std::byte> bytes);
Hash128 hash128(std::span<const std::byte> bytes);
inline std::uint64_t hash64(std::string_view text) {
    return hash64(std::as_bytes(std::span(text.data(), text.size())));
}
inline Hash128 hash128(std::string_view text) {
    return hash128(std::as_bytes(std::span(text.data(), text.size())));
}

/// The value as sixteen hexadecimal digits.
inline std::string hex_digits(std::uint64_t value) {
    std::string text(16, '0');
    for (int i = 15; i >= 0; --i, value >>= 4u) {
        text[static_cast<std::size_t>(i)] = "0123456789abcdef"[value & 15u];
    }
    return text;
}
inline std::string hex_digits(const Hash128& hash) {
    return hex_digits(hash[0]) + hex_digits(hash[1]);
}

}  // namespace nearlight::core
