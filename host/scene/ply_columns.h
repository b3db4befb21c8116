// SPDX-License-Identifier: Apache-2.0
// Which columns of a PLY file's tables hold what a mesh is made of.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "host/base/math.h"
#include "host/scene/ply_file.h"

namespace nearlight::core {

/// What the numbers of a colour or of another attribute mean.
enum class PlyCode {
    /// Linear, and those of integer types not divided by anything, as in Mitsuba 3, which expects 0 to 1.
    as_it_stands,
    srgb,    ///< all are sRGB; integers are parts of the largest number of their type
    linear,  ///< all are linear; integers are parts of the largest number of their type
    /// As decode_display_colors() takes them: nothing is decoded, and only 8 and 16 bits without a sign are
    /// parts of the largest number, because some programs write bytes into the wider types.
    display,
};

/// The slots of an attribute's channels.
inline constexpr int kFirstPlyChannel = 8;
inline constexpr std::size_t kPlySlotCount = 11;
/// A number for each slot, in the order x y z nx ny nz u v and then the attribute's channels.
using PlyRow = std::array<float, kPlySlotCount>;

/// Where the rows of a table keep what is asked for.
struct PlyColumns {
    std::vector<int> slots;                     ///< of each property; −1 if it is skipped
    std::array<bool, kPlySlotCount> present{};  ///< whether a property of a vertex has the slot
    int channels = 0;                           ///< of the attribute: 0, 1 or 3
};

/// The slots of an attribute; its channels have the order of the file.
PlyColumns attribute_columns(const PlyElement& element, std::string_view attribute);
/// The slots of all that a vertex may have.
PlyColumns vertex_columns(const PlyElement& element, std::string_view attribute);

/// Reads a number into its slot. Channels become linear, or what PlyCode::display makes of them.
void read_slot(PlyReader& reader, PlyScalar type, int slot, PlyCode code, PlyRow& row);
PlyRow read_row(PlyReader& reader, const PlyElement& element, const PlyColumns& columns, PlyCode code);

/// The attribute's value, where a single number is a grey.
Vec3 attribute_value(const PlyRow& row, int channels);

}  // namespace nearlight::core
