// SPDX-License-Identifier: Apache-2.0
// Names as numbers, as Cryptomatte has them [Friedman and Jones, Fully Automatic ID Mattes with Support for
// Motion Blur and Transparency, 2015; Psyop, Cryptomatte Specification, version 1.2].
#pragma once

#include <cstdint>
#include <string_view>

namespace nearlight::core {

/// MurmurHash3_x86_32 with the seed 0 [Appleby, MurmurHash3, 2011].
std::uint32_t murmur_hash3(std::string_view bytes);

/// The bits of the float that stands for a name: its hash, with an exponent that makes it a normal number.
std::uint32_t cryptomatte_id(std::string_view name);

}  // namespace nearlight::core
