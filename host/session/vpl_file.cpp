// SPDX-License-Identifier: Apache-2.0
#include "host/session/vpl_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/limits.h"
#include "host/base/packed_direction.h"
#include "host/scene/file_text.h"
#include "host/scene/ply_file.h"
#include "host/stages/receiver_paths.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTitle = "nearlight virtual point lights, version 1";

/// The columns of the table, in the order of their numbers.
constexpr std::array kColumns{"x",   "y",     "z",    "nx",    "ny",    "nz",
                              "red", "green", "blue", "depth", "flags", "shading"};
/// How many columns, from the first on, a file must have. Other programs may leave out the rest.
constexpr std::size_t kNeeded = 9;
using Row = std::array<double, kColumns.size()>;

/// What a file may say of a VPL. The other bits have meanings of their own where gathers read VPLs.
constexpr uint kFlagsOfFiles =
    NEARLIGHT_VPL_CLOSE | NEARLIGHT_VPL_MAPPED | NEARLIGHT_VPL_TILTED | ~0u << NEARLIGHT_VPL_CURVE_SHIFT;

template <typename Number>
std::string decimal(Number number) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string header_of(const VplFile& set) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    const auto say = [&text](const std::string& comment) { text += "comment " + comment + "\n"; };
    if (set.origin) {
        say(kTitle);
        say("scene " + hex_digits(set.origin->scene));
        say("max_depth " + decimal(set.origin->max_depth));
        say("close " + decimal(set.origin->close_count));
        say("asked " + decimal(set.origin->asked_count));
        if (set.origin->ray_budget) {
            say("clamp_radius " + decimal(set.origin->ray_budget->clamp_radius));
            say("light_samples " + decimal(set.origin->ray_budget->direct_samples_per_pixel));
            say("shared_limit " + decimal(set.origin->ray_budget->shared_limit));
            say("aimed_rays " + decimal(set.origin->ray_budget->aimed_rays));
        }
    }
    text += "element vertex " + decimal(set.vpls.size()) + "\n";
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
        text += std::string(i < kNeeded ? "property float " : "property uint ") + kColumns[i] + "\n";
    }
    return text + "end_header\n";
}

void add_number(std::string& text, auto number) {
    static_assert(sizeof(number) == 4 && std::endian::native == std::endian::little);
    text.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

/// The value of a line of the header; empty if there is none.
std::string value_of(const PlyHeader& header, const std::string& name) {
    for (const std::string& comment : header.comments) {
        if (comment.starts_with(name + " ")) {
            return comment.substr(name.size() + 1);
        }
    }
    return "";
}

/// A number of the header, of a certain base if it is an integer.
template <typename Number>
Number number_of(const fs::path& file, const PlyHeader& header, const std::string& name, auto... base) {
    const std::string text = value_of(header, name);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base...);
    if (error != std::errc() || end != text.data() + text.size()) {
        fail_ply(file, "the header has no number `" + name + "`");
    }
    return number;
}

VplOrigin origin_of(const fs::path& file, const PlyHeader& header) {
    VplOrigin origin{.scene = number_of<std::uint64_t>(file, header, "scene", 16),
                     .max_depth = number_of<uint>(file, header, "max_depth"),
                     .close_count = number_of<std::size_t>(file, header, "close"),
                     .asked_count = number_of<std::size_t>(file, header, "asked")};
    if (!value_of(header, "clamp_radius").empty()) {
        const float radius = number_of<float>(file, header, "clamp_radius");
        const uint samples = number_of<uint>(file, header, "light_samples");
        if (!(radius >= 0.0f && radius <= kMaxLength) || samples < 1 || samples > kMaxLightSamples) {
            fail_ply(file, "the header's clamp radius must be from 0 to " + decimal(kMaxLength) +
                               " and its light samples from 1 to " + decimal(kMaxLightSamples));
        }
        origin.ray_budget = {.clamp_radius = radius, .direct_samples_per_pixel = samples};
        // The rest is optional: without it, bundles share everything, and receivers do not aim.
        if (!value_of(header, "shared_limit").empty()) {
            origin.ray_budget->shared_limit = number_of<float>(file, header, "shared_limit");
            if (!(origin.ray_budget->shared_limit >= 0.0f &&
                  std::isfinite(origin.ray_budget->shared_limit))) {
                fail_ply(file, "the header's shared limit must be a finite number that is 0 or more");
            }
        }
        if (!value_of(header, "aimed_rays").empty()) {
            origin.ray_budget->aimed_rays = number_of<uint>(file, header, "aimed_rays");
            if (origin.ray_budget->aimed_rays > kMaxAimedRays) {
                fail_ply(file, "the header's aimed rays must be at most " + decimal(kMaxAimedRays));
            }
        }
    }
    return origin;
}

/// The place in a Row of each property; −1 for those that are passed over.
std::vector<int> places_of(const fs::path& file, const PlyElement& element) {
    std::vector<int> places;
    for (const PlyProperty& property : element.properties) {
        const auto column = std::ranges::find(kColumns, property.name,
                                              [](const char* name) { return std::string_view(name); });
        const bool is_known = column != kColumns.end() && !property.is_list;
        places.push_back(is_known ? static_cast<int>(column - kColumns.begin()) : -1);
    }
    for (std::size_t i = 0; i < kNeeded; ++i) {
        if (std::ranges::find(places, static_cast<int>(i)) == places.end()) {
            fail_ply(file, std::string("the VPLs have no property `") + kColumns[i] + "`");
        }
    }
    return places;
}

Vpl vpl_of(const fs::path& file, std::size_t index, const Row& row, bool has_shading) {
    const auto vec3 = [&row](std::size_t first) {
        return Vec3{static_cast<float>(row[first]), static_cast<float>(row[first + 1]),
                    static_cast<float>(row[first + 2])};
    };
    const auto word = [&row](std::size_t place) {
        return row[place] >= 0.0 && row[place] < 4294967296.0 ? static_cast<uint>(row[place]) : 0u;
    };
    Vpl vpl{.position = vec3(0),
            .depth = word(9),
            .normal = vec3(3),
            .flags = word(10),
            .power = vec3(6),
            .shading = word(11)};
    const float length = std::hypot(vpl.normal.x, vpl.normal.y, vpl.normal.z);
    const Vec3 power = vpl.power;
    if (!is_finite(vpl.position) || !is_finite(power) || std::min({power.x, power.y, power.z}) < 0.0f ||
        !std::isfinite(length) || !(length > 0.0f)) {
        fail_ply(file, "VPL " + std::to_string(index) +
                           " is broken: it needs a finite position, a normal, and powers of 0 or more");
    }
    if ((vpl.flags & ~kFlagsOfFiles) != 0) {
        fail_ply(file, "VPL " + std::to_string(index) + " has flags that nearlight does not know");
    }
    if (std::abs(length - 1.0f) > 1e-3f) {
        // The reciprocal of the shortest lengths is infinite.
        vpl.normal = {vpl.normal.x / length, vpl.normal.y / length, vpl.normal.z / length};
    }
    if (!has_shading) {
        vpl.shading = pack_direction(vpl.normal);
    }
    return vpl;
}

std::vector<Vpl> read_vpls(const fs::path& file, PlyReader& reader, const PlyElement& element) {
    const std::vector<int> places = places_of(file, element);
    const bool has_shading = std::ranges::find(places, static_cast<int>(kColumns.size()) - 1) != places.end();
    std::vector<Vpl> vpls;
    vpls.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
        Row row{};
        for (std::size_t p = 0; p < places.size(); ++p) {
            if (places[p] < 0) {
                reader.skip(element.properties[p]);
            } else {
                row[static_cast<std::size_t>(places[p])] = reader.read(element.properties[p].type);
            }
        }
        reader.end_row();
        vpls.push_back(vpl_of(file, i, row, has_shading));
    }
    return vpls;
}

}  // namespace

void write_vpl_file(const fs::path& file, const VplFile& set) {
    std::string text = header_of(set);
    text.reserve(text.size() + 4 * kColumns.size() * set.vpls.size());
    for (const Vpl& vpl : set.vpls) {
        for (const Vec3 v : {vpl.position, vpl.normal, vpl.power}) {
            for (const float number : {v.x, v.y, v.z}) {
                add_number(text, number);
            }
        }
        for (const uint number : {vpl.depth, vpl.flags, vpl.shading}) {
            add_number(text, number);
        }
    }
    write_text(file, text);
}

VplFile read_vpl_file(const fs::path& file) {
    const std::string text = read_file_text(file);
    const PlyHeader header = parse_ply_header(file, text);
    const auto element = std::ranges::find(header.elements, "vertex", &PlyElement::name);
    if (element != header.elements.begin() || element == header.elements.end()) {
        fail_ply(file, "VPLs must be the first element of the file, and be called `vertex`");
    }
    PlyReader reader(file, text, header);
    if (element->count > kMaxVpls) {
        fail_ply(file, "it has more than " + decimal(kMaxVpls) + " VPLs");
    }
    reader.check_size_of(*element);
    VplFile set{.vpls = read_vpls(file, reader, *element)};
    if (std::ranges::find(header.comments, kTitle) != header.comments.end()) {
        set.origin = origin_of(file, header);
    }
    return set;
}

void check_vpls(const VplFile& set, const Scene& scene, uint max_depth, const fs::path& file) {
    if (set.origin && set.origin->scene != lighting_hash(scene)) {
        fail_ply(file, "these VPLs were made for another scene, or the scene has changed since");
    }
    if (set.origin && set.origin->max_depth != max_depth) {
        fail_ply(file,
                 "these VPLs were made for a maximum depth of " + std::to_string(set.origin->max_depth) +
                     ", not of " + std::to_string(max_depth),
                 "max_depth");
    }
    const std::size_t curve_count = scene.transmission_curves.size() / NEARLIGHT_CURVE_SIZE;
    if (std::ranges::any_of(set.vpls, [&](const Vpl& vpl) {
            return vpl.flags >> NEARLIGHT_VPL_CURVE_SHIFT >= curve_count;
        })) {
        fail_ply(file, "a VPL has a transmission curve that the scene has not");
    }
}

VplFile vpl_file_of(const VplSet& set, VplOrigin origin) {
    if (set.local) {
        throw Error(ErrorKind::invalid_argument,
                    "VPLs of the sampler local cannot be saved, because its local lights belong to the view");
    }
    origin.close_count = set.close_count;
    origin.asked_count = set.asked_count;
    origin.ray_budget = set.ray_budget;
    return {.vpls = set.vpls.download(), .origin = origin};
}

VplSet vpl_set_of(Device& device, const VplFile& file) {
    VplSet set{.vpls = VplBuffer(device, file.vpls), .distant_count = file.vpls.size()};
    if (file.origin) {
        set.close_count = std::min(file.origin->close_count, file.vpls.size());
        set.distant_count -= set.close_count;
        set.close_fraction = static_cast<float>(set.close_count) /
                             static_cast<float>(std::max<std::size_t>(file.vpls.size(), 1));
        set.asked_count = file.origin->asked_count < file.vpls.size() ? file.origin->asked_count : 0;
        set.ray_budget = file.origin->ray_budget;
    }
    return set;
}

}  // namespace nearlight::core
