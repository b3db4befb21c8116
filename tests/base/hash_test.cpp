// SPDX-License-Identifier: Apache-2.0
#include "host/base/hash.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace nearlight::core {
namespace {

TEST(Fnv1a, HasThePublishedValues) {
    EXPECT_EQ(fnv1a(""), 0xcbf29ce484222325ull);
    EXPECT_EQ(fnv1a("a"), 0xaf63dc4c8601ec8cull);
    EXPECT_EQ(fnv1a("foobar"), 0x85944171f73967e8ull);
    EXPECT_EQ(fnv1a("bar", fnv1a("foo")), fnv1a("foobar"));
}

/// Neither half meets another's.
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
