// SPDX-License-Identifier: Apache-2.0
// Sets of VPLs in PLY files, which other programs can read and write. docs/vpl-files.md describes the
// properties.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "host/samplers/sampler.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// What a file holds besides VPLs. Files of other programs say none of it.
struct VplOrigin {
    std::uint64_t scene = 0;  ///< lighting_hash() of the scene
    uint max_depth = 0;       ///< maximum path length, as Mitsuba counts it
    std::size_t close_count = 0;
    std::size_t asked_count = 0;            ///< VplSet::asked_count
    std::optional<RayBudget> ray_budget{};  ///< VplSet::ray_budget
};

struct VplFile {
    std::vector<Vpl> vpls;  ///< in an order in which neighbours in space are close to each other
    std::optional<VplOrigin> origin{};
};

/// The file replaces an old one only when it is complete. Throws Error(ErrorKind::file).
void write_vpl_file(const std::filesystem::path& file, const VplFile& set);

/// Throws Error(ErrorKind::file) if the file is missing or truncated, lacks a property, has more than
/// kMaxVpls VPLs, or has a VPL whose position is not finite, whose normal has no direction, whose power is
/// not finite or is negative, or whose flags are unknown.
VplFile read_vpl_file(const std::filesystem::path& file);

/// Throws Error(ErrorKind::file) if the VPLs of a file cannot light a scene up to this maximum depth, because
/// they were made for another scene or another depth, or name a transmission curve that the scene has not;
/// `file` is for the message.
void check_vpls(const VplFile& set, const Scene& scene, uint max_depth, const std::filesystem::path& file);

/// A set of the samplers as a file has it. Throws Error(ErrorKind::invalid_argument) for a set with local
/// lights, which belong to a view.
VplFile vpl_file_of(const VplSet& set, VplOrigin origin);

/// The set that a file holds, in the memory of a device.
VplSet vpl_set_of(Device& device, const VplFile& file);

}  // namespace nearlight::core
