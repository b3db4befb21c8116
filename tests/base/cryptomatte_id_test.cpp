// SPDX-License-Identifier: Apache-2.0
#include "host/base/cryptomatte_id.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>

namespace nearlight::core {
namespace {

/// The values are those of the reference implementation [Appleby], with tails of 0 to 3 bytes.
TEST(CryptomatteId, HashesAsMurmurHash3Does) {
    EXPECT_EQ(murmur_hash3(""), 0u);
    EXPECT_EQ(murmur_hash3("a"), 0x3c2569b2u);
    EXPECT_EQ(murmur_hash3("abc"), 0xb3dd93fau);
    EXPECT_EQ(murmur_hash3("test"), 0xba6bd213u);
    EXPECT_EQ(murmur_hash3("hello"), 0x248bfa47u);
    EXPECT_EQ(murmur_hash3("hello, world"), 0x149bbb7fu);
    EXPECT_EQ(murmur_hash3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

/// Other programs that write and read mattes test with these names.
TEST(CryptomatteId, GivesNamesTheFloatsOfOtherPrograms) {
    EXPECT_FLOAT_EQ(std::bit_cast<float>(cryptomatte_id("hello")), 6.0705627e-17f);
    EXPECT_FLOAT_EQ(std::bit_cast<float>(cryptomatte_id("cube")), -4.0846191e+15f);
    EXPECT_FLOAT_EQ(std::bit_cast<float>(cryptomatte_id("sphere")), 2.7901860e+15f);
    EXPECT_FLOAT_EQ(std::bit_cast<float>(cryptomatte_id("plane")), 3.6655762e-11f);
    EXPECT_EQ(cryptomatte_id("/GAFFERBOT/C_torso_GRP/C_head_GRP/C_head_CPT/C_head001_REN"), 4226998693u);
    EXPECT_EQ(cryptomatte_id("crypto_object") >> 4, 0xf834d0au) << "the key of its attributes";
}

TEST(CryptomatteId, IsANormalNumberForAnyName) {
    unsigned changed = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::string name = "object " + std::to_string(i);
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(cryptomatte_id(name)))) << name;
        changed += cryptomatte_id(name) != murmur_hash3(name) ? 1 : 0;
    }
    EXPECT_EQ(cryptomatte_id("object 259"), 0x00e9b367u) << "the hash is a denormal number";
    EXPECT_EQ(cryptomatte_id("object 858"), 0xff068043u) << "the hash is NaN";
    EXPECT_GT(changed, 10u);
    EXPECT_LT(changed, 80u);
}

}  // namespace
}  // namespace nearlight::core
