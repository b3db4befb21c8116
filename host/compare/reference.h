// SPDX-License-Identifier: Apache-2.0
// The truth that pictures are compared with: the indirect light of a scene, and how noisy that is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/compare/reference_store.h"
#include "host/image/image.h"

namespace nearlight::core {

/// Keeps relative errors of black pixels finite; squared radiance.
inline constexpr double kRelativeErrorFloor = 0.01;

struct ReferenceNoise {
    bool known = false;
    double mean_variance = 0;  ///< of the picture's values, mean over pixels and R, G, B; 0 where not known
    double mean_relative_variance = 0;  ///< variance ÷ (value² + kRelativeErrorFloor), mean
};

struct Reference {
    Image picture;  ///< R, G, B: indirect light
    ReferenceNoise noise{};
    float display_scale = 1.0f;  ///< see display_scale() in pictures.h
    std::string method;          ///< method_name()
    bool path_traced = true;
    std::size_t samples = 0;  ///< a pixel where path-traced, else VPLs
    std::string file{};       ///< that was given; empty where it was made
    double seconds = 0;       ///< that making it took in this run; 0 where all was there
};

/// "1024 samples a pixel", "300000 VPLs".
std::string samples_text(const Reference& reference);

/// A hash of the picture's bits: errors against other references are other errors.
std::uint64_t identity(const Reference& reference);

/// Makes pass `index` of so many samples: channels R, G, B and, where its own noise is known, variance.R, .G,
/// .B. Nothing where it was stopped.
using PassMaker = std::function<std::optional<Image>(std::size_t index, std::size_t samples)>;

/// A reference of `samples` in passes: those in the store are used, others made and stored at once, so that
/// nothing but the pass at hand is lost when it is stopped (and then there is no reference), and a longer one
/// goes on from a shorter. Where passes do not know their noise, it is taken from how they differ.
std::optional<Reference> make_reference(const ReferenceSpec& spec, std::size_t samples,
                                        const ReferenceStore& store, const PassMaker& make_pass);

/// Samples of each pass of a reference: the pass size of such references, and what is left; rounded up to a
/// multiple of 16 where paths are traced.
std::vector<std::size_t> pass_sizes(const ReferenceSpec& spec, std::size_t samples);

/// A picture made by `nearlight reference`. Throws Error(ErrorKind::file) where it is none, or not of this
/// scene, size, clamp radius and depth.
Reference load_reference(const std::filesystem::path& file, const ReferenceSpec& spec);

}  // namespace nearlight::core
