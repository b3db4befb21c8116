// SPDX-License-Identifier: Apache-2.0
#include "host/base/hash.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace nearlight::core {
namespace {

TEST(Hash, HasThePublishedValuesOfXxh3) {
    EXPECT_EQ(hash64(""), 0x2d06800538d394c2ull);
    EXPECT_EQ(hash64("a"), 0xe6c632b61e964e1full);
    EXPECT_EQ(hex_digits(hash128("")), "99aa06d3014798d86001c324468d497f");
    EXPECT_EQ(hex_digits(hash128("a")), "a96faf705af16834e6c632b61e964e1f");
}

TEST(Hasher, TakesDataInPartsOfAnySize) {
    std::string text;
    for (int length = 0; length < 3000;
         length += 1 + length / 16, text.resize(static_cast<std::size_t>(length), 'x')) {
        for (const std::size_t part : {1u, 7u, 64u, 256u, 1000u}) {
            Hasher hasher;
            for (std::size_t i = 0; i < text.size(); i += part) {
                hasher.add_text(std::string_view(text).substr(i, part));
            }
            EXPECT_EQ(hasher.hash64(), hash64(text)) << length;
            EXPECT_EQ(hasher.hash128(), hash128(text)) << length;
        }
        if (!text.empty()) {
            text.back() = static_cast<char>(length);
        }
    }
}

TEST(Hasher, TellsArraysApartThatAreSplitElsewhere) {
    const auto hash_of = [](const std::vector<int>& first, const std::vector<int>& second) {
        Hasher hasher;
        hasher.add_array(first);
        hasher.add_array(second);
        return hasher.hash64();
    };
    EXPECT_NE(hash_of({1, 2}, {3}), hash_of({1}, {2, 3}));
    EXPECT_EQ(hash_of({1, 2}, {3}), hash_of({1, 2}, {3}));
}

/// No two hashes have the same upper or lower half.
TEST(Hash128, DiffersForTextsThatHardlyDiffer) {
    const std::string text = "what is kept in a cache has a key";
    std::set<std::uint64_t> halves;
    std::size_t hashed = 0;
    const auto add = [&](const std::string& other) {
        const Hash128 hash = hash128(other);
        halves.insert(hash.begin(), hash.end());
        ++hashed;
    };
    for (std::size_t length = 0; length <= text.size(); ++length) {
        add(text.substr(0, length));
        add(std::string(length + 1, '\0'));
    }
    for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
        std::string flipped = text;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        add(flipped);
    }
    add(text.substr(8, 8) + text.substr(0, 8) + text.substr(16));
    EXPECT_EQ(halves.size(), 2 * hashed);
    EXPECT_EQ(hash128(text), hash128(std::string(text)));
}

TEST(HexDigits, AreInReadingOrder) {
    EXPECT_EQ(hex_digits(0x0123456789abcdefull), "0123456789abcdef");
    EXPECT_EQ(hex_digits(Hash128{1, 0xf000000000000000ull}), "0000000000000001f000000000000000");
}

}  // namespace
}  // namespace nearlight::core
