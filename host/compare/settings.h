// SPDX-License-Identifier: Apache-2.0
// What a comparison is asked to do, and the reading of its lists.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/compare/method.h"

namespace nearlight::core {

/// A part of the picture to look at closely, in pixels from the top left corner.
struct Crop {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    bool operator==(const Crop&) const = default;
};

struct CompareSettings {
    std::filesystem::path output;            ///< folder of the report
    std::filesystem::path reference_folder;  ///< where references are kept; empty: output/references
    std::vector<Method> methods = all_methods();
    Method baseline = default_method();  ///< ratios are a method's ÷ this one's
    std::vector<uint> vpl_counts{1000, 2000, 5000, 10000};
    uint seed_count = 4;
    uint first_seed = 0;
    int width = 320;
    int height = 240;
    uint samples_per_pixel = 1;
    std::optional<float> clamp_radius;        ///< scene units
    std::optional<float> clamp_fraction;      ///< of the range; kDefaultClampFraction where neither is given
    std::optional<float> range;               ///< of the close range, scene units; empty: from the view
    std::optional<uint> max_depth;            ///< as Mitsuba counts; empty: the scene's, or 8
    int reference_spp = 1024;                 ///< of the path-traced reference
    std::size_t reference_vpls = 0;           ///< where not 0: so many VPLs are the reference
    std::optional<Method> reference_sampler;  ///< of these; empty: instant radiosity, as in the paper
    std::vector<std::filesystem::path>
        reference_files;  ///< made by `nearlight reference`; each for the scene it fits
    BvhQuality bvh_quality = BvhQuality::quality;
    std::vector<Crop> crops;      ///< empty: chosen where the picture is hardest
    std::string program_version;  ///< cells of other versions are measured anew

    [[nodiscard]] std::filesystem::path references() const {
        return reference_folder.empty() ? output / "references" : reference_folder;
    }
};

inline constexpr float kDefaultClampFraction = 0.025f;
/// The paper calls its references "densely sampled: number of VPLs above 200k".
inline constexpr std::size_t kMinReferenceVpls = 200'000;
/// Other samplers' VPLs: times the largest number that is compared, so that a reference has a third of the
/// noise.
inline constexpr std::size_t kReferenceExcess = 10;

/// Comma-separated names, see parse_method(); none twice. Throws Error(ErrorKind::invalid_argument).
std::vector<Method> parse_methods(const std::string& list);
/// Comma-separated counts of 1 to 50 million, none twice; sorted. Throws Error(ErrorKind::invalid_argument).
std::vector<uint> parse_vpl_counts(const std::string& list);
/// "X,Y,W,H". Throws Error(ErrorKind::invalid_argument).
Crop parse_crop(const std::string& text);

/// Whether the settings go together. Throws Error(ErrorKind::invalid_argument) for the first that does not.
void check_settings(const CompareSettings& settings);

}  // namespace nearlight::core
