// SPDX-License-Identifier: Apache-2.0
// The settings of a comparison, and the parsing of its lists.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/base/limits.h"
#include "host/bvh/bvh.h"
#include "host/compare/method.h"

namespace nearlight::core {

/// A part of the picture that the report enlarges, in pixels from the top left corner.
struct Crop {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    bool operator==(const Crop&) const = default;
};

struct CompareSettings {
    std::filesystem::path output;  ///< folder of the report
    /// The folder in which references are stored; empty: output/references.
    std::filesystem::path reference_folder;
    std::vector<Method> methods = all_methods();
    Method baseline = default_method();  ///< the method by whose values ratios are divided
    std::vector<uint> vpl_counts{1000, 2000, 5000, 10000};
    uint seed_count = 4;
    uint first_seed = 0;
    int width = 320;
    int height = 240;
    uint samples_per_pixel = 1;
    std::optional<float> clamp_radius;    ///< m
    std::optional<float> clamp_fraction;  ///< of the range; if neither is given, that of the reference's
                                          ///< file, or else kDefaultClampFraction
    std::optional<float> range;           ///< range of the close range, m; empty: from the view
    std::optional<uint> max_depth;        ///< in Mitsuba's counting; empty: the scene's, or 256
    int reference_spp = 1024;             ///< samples per pixel of a path-traced reference
    std::size_t reference_vpls = 0;       ///< VPLs of a reference of VPLs; 0: the reference is path-traced
    /// The sampler of a reference of VPLs; empty: instant radiosity, as in the paper.
    std::optional<Method> reference_sampler;
    /// Made by `nearlight reference`; each is used for the scene that it shows.
    std::vector<std::filesystem::path> reference_files;
    BvhQuality bvh_quality = BvhQuality::quality;
    std::vector<Crop> crops;      ///< empty: chosen where errors are largest
    std::string program_version;  ///< cells of other versions or kernels are measured again
    std::string command_line;     ///< by which the report can be made again
    std::string date;             ///< on which the report is written

    [[nodiscard]] std::filesystem::path references() const {
        return reference_folder.empty() ? output / "references" : reference_folder;
    }
};

inline constexpr float kDefaultClampFraction = 0.025f;
/// The paper calls its references "densely sampled: number of VPLs above 200k".
inline constexpr std::size_t kMinReferenceVpls = 200'000;
/// Number of passes of a reference of VPLs, whose differences give an estimate of its noise.
inline constexpr std::size_t kReferencePasses = 8;
/// Maximum number of VPLs of a reference, whose passes are pictures of their own.
inline constexpr std::size_t kMaxReferenceVpls = kReferencePasses * kMaxVpls;
/// Minimum number of VPLs of a reference by another sampler, as a multiple of the largest number that is
/// compared. The reference then has a third of the noise.
inline constexpr std::size_t kReferenceExcess = 10;

/// Parses comma-separated names (see parse_method()); none may occur twice. Throws
/// Error(ErrorKind::invalid_argument).
std::vector<Method> parse_methods(const std::string& list);
/// Parses comma-separated counts of 1 to 50 million, and sorts them; none may occur twice. Throws
/// Error(ErrorKind::invalid_argument).
std::vector<uint> parse_vpl_counts(const std::string& list);

/// Checks that the settings are consistent. Throws Error(ErrorKind::invalid_argument) for the first that is
/// not.
void check_settings(const CompareSettings& settings);

}  // namespace nearlight::core
