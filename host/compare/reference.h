// SPDX-License-Identifier: Apache-2.0
// The reference that pictures are compared with: the indirect light of a scene, with its noise.
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
    /// Variance of the picture's values, mean over pixels and R, G, B; 0 if it is not known.
    double mean_variance = 0;
    double mean_relative_variance = 0;  ///< mean of variance ÷ (value² + kRelativeErrorFloor); 0 if not known
};

struct Reference {
    Image picture;  ///< R, G, B: indirect light
    ReferenceNoise noise{};
    float display_scale = 1.0f;  ///< see display_scale() in pictures.h
    std::string method;          ///< method_name()
    bool path_traced = true;
    std::size_t samples = 0;  ///< samples per pixel if path-traced, otherwise VPLs
    std::string file{};       ///< the file that was given; empty if the reference was made
    double seconds = 0;       ///< seconds that this run took to make it; 0 if everything was stored
};

/// The reference's samples in words, such as "1024 samples per pixel" or "300000 VPLs".
std::string samples_text(const Reference& reference);

/// A hash of the picture's bits, because errors against different references cannot be compared.
std::uint64_t identity(const Reference& reference);

/// Makes pass `index` with `samples` samples. It has the channels R, G, B and, if its noise is known,
/// variance.R, .G, .B. Empty if it was stopped.
using PassMaker = std::function<std::optional<Image>(std::size_t index, std::size_t samples)>;

/// Makes a reference of `samples` samples from passes. Stored passes are reused and new ones are stored at
/// once, so a stop, after which the result is empty, loses only the unfinished pass, and a longer reference
/// extends a shorter one. If passes do not know their noise, it is estimated from their differences.
std::optional<Reference> make_reference(const ReferenceSpec& spec, std::size_t samples,
                                        const ReferenceStore& store, const PassMaker& make_pass);

/// The numbers of samples of the passes of a reference. All but the last are equal. With path tracing they
/// are rounded up to a multiple of 16.
std::vector<std::size_t> pass_sizes(const ReferenceSpec& spec, std::size_t samples);

/// Loads a picture made by `nearlight reference`. Throws Error(ErrorKind::file) if the file is not such a
/// picture, or has another scene, size, clamp radius or depth.
Reference load_reference(const std::filesystem::path& file, const ReferenceSpec& spec);

}  // namespace nearlight::core
