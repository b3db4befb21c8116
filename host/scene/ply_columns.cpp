// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_columns.h"

#include <optional>
#include <utility>

#include "host/image/color.h"

namespace nearlight::core {
namespace {

// The slot of a property; −1 if it is neither of a position nor of a normal.
int vertex_slot(std::string_view name) {
    constexpr std::pair<std::string_view, int> kSlots[] = {{"x", 0},  {"y", 1},  {"z", 2},
                                                           {"nx", 3}, {"ny", 4}, {"nz", 5}};
    for (const auto& [known, slot] : kSlots) {
        if (known == name) {
            return slot;
        }
    }
    return -1;
}

constexpr int kFirstPlyUv = 6;
/// What texture coordinates may be called. The first pair of which a table has both counts, as in Mitsuba 3,
/// so that a number that happens to be called s or t is not taken for one.
constexpr std::pair<std::string_view, std::string_view> kUvNames[] = {
    {"u", "v"}, {"texture_u", "texture_v"}, {"s", "t"}};

/// The column of a number with this name that has no slot yet.
std::optional<std::size_t> free_column(const PlyElement& element, const PlyColumns& columns,
                                       std::string_view name) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (columns.slots[i] < 0 && !property.is_list && property.name == name) {
            return i;
        }
    }
    return std::nullopt;
}

void add_uv_slots(const PlyElement& element, PlyColumns& columns) {
    for (const auto& [u_name, v_name] : kUvNames) {
        const std::optional<std::size_t> u = free_column(element, columns, u_name);
        const std::optional<std::size_t> v = free_column(element, columns, v_name);
        if (u && v) {
            columns.slots[*u] = kFirstPlyUv;
            columns.slots[*v] = kFirstPlyUv + 1;
            return;
        }
    }
}

/// The place of a name among red, green and blue; −1 if it is none of them.
int color_channel(std::string_view name) {
    return name == "r" || name == "red"     ? 0
           : name == "g" || name == "green" ? 1
           : name == "b" || name == "blue"  ? 2
                                            : -1;
}

bool is_channel(std::string_view name, std::string_view attribute) {
    return name.size() == attribute.size() + 2 && name.starts_with(attribute) &&
           name[attribute.size()] == '_' &&
           std::string_view("xyzwrgba01234").find(name.back()) != std::string_view::npos;
}

/// The slots of a colour that is called r, g and b.
PlyColumns color_columns(const PlyElement& element) {
    PlyColumns columns{.slots = std::vector<int>(element.properties.size(), -1)};
    std::array<bool, 3> found{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        const int channel = property.is_list ? -1 : color_channel(property.name);
        if (channel >= 0) {
            columns.slots[i] = kFirstPlyChannel + channel;
            found[static_cast<std::size_t>(channel)] = true;
        }
    }
    columns.channels = found[0] && found[1] && found[2] ? 3 : 0;
    return columns;
}

/// The linear value of a channel, or what PlyCode::display makes of it.
float channel_value(double number, PlyScalar type, PlyCode code) {
    const double largest = largest_number(type);
    const bool is_short = type == PlyScalar::u8 || type == PlyScalar::u16;
    const bool is_part = code == PlyCode::display ? is_short : code != PlyCode::as_it_stands && largest > 0.0;
    const auto value = static_cast<float>(is_part ? number / largest : number);
    return code == PlyCode::srgb ? srgb_to_linear(value) : value;
}

}  // namespace

PlyColumns attribute_columns(const PlyElement& element, std::string_view attribute) {
    if (attribute == "color") {
        if (PlyColumns columns = color_columns(element); columns.channels == 3) {
            return columns;
        }
    }
    PlyColumns columns{.slots = std::vector<int>(element.properties.size(), -1)};
    for (std::size_t i = 0; i < element.properties.size() && columns.channels < 3; ++i) {
        const PlyProperty& property = element.properties[i];
        if (!property.is_list && is_channel(property.name, attribute)) {
            columns.slots[i] = kFirstPlyChannel + columns.channels++;
        }
    }
    columns.channels = columns.channels == 2 ? 0 : columns.channels;
    return columns;
}

PlyColumns vertex_columns(const PlyElement& element, std::string_view attribute) {
    PlyColumns columns = attribute_columns(element, attribute);
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        int& slot = columns.slots[i];
        slot = slot < 0 && !property.is_list ? vertex_slot(property.name) : slot;
    }
    add_uv_slots(element, columns);
    for (const int slot : columns.slots) {
        if (slot >= 0) {
            columns.present[static_cast<std::size_t>(slot)] = true;
        }
    }
    return columns;
}

void read_slot(PlyReader& reader, PlyScalar type, int slot, PlyCode code, PlyRow& row) {
    const double number = reader.read(type);
    row[static_cast<std::size_t>(slot)] =
        slot < kFirstPlyChannel ? static_cast<float>(number) : channel_value(number, type, code);
}

PlyRow read_row(PlyReader& reader, const PlyElement& element, const PlyColumns& columns, PlyCode code) {
    PlyRow row{};
    for (std::size_t i = 0; i < columns.slots.size(); ++i) {
        if (columns.slots[i] < 0) {
            reader.skip(element.properties[i]);
        } else {
            read_slot(reader, element.properties[i].type, columns.slots[i], code, row);
        }
    }
    return row;
}

Vec3 attribute_value(const PlyRow& row, int channels) {
    const float first = row[kFirstPlyChannel];
    return channels == 1 ? Vec3{first, first, first}
                         : Vec3{first, row[kFirstPlyChannel + 1], row[kFirstPlyChannel + 2]};
}

}  // namespace nearlight::core
