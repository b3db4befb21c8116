// SPDX-License-Identifier: Apache-2.0
// A folder of passes of references, which are found by their ReferenceSpec.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "host/compare/method.h"
#include "host/image/image.h"

namespace nearlight::core {

/// Everything that determines the expectation of a reference.
struct ReferenceSpec {
    /// The sampler of a reference of VPLs; empty: path tracing (host/reference).
    std::optional<Method> sampler;
    std::string scene_name;  ///< only used for names of files
    std::uint64_t scene_hash = 0;
    int width = 0;
    int height = 0;
    float clamp_radius = 0;
    unsigned max_depth = 0;      ///< in Mitsuba's counting
    bool pixel_centers = false;  ///< whether rays go through the pixels' centres instead of all over them
};

/// The method that makes it: "path tracing", or the sampler's name.
std::string method_name(const ReferenceSpec& spec);

class ReferenceStore {
  public:
    /// The folder is created when the first pass is saved.
    explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Pass `index` with `samples` samples, or nothing. A pass that cannot be read counts as missing, with a
    /// warning.
    [[nodiscard]] std::optional<Image> load(const ReferenceSpec& spec, std::size_t index,
                                            std::size_t samples) const;
    /// Stores a pass. Throws Error(ErrorKind::file) if the file cannot be written.
    void save(const ReferenceSpec& spec, std::size_t index, std::size_t samples, const Image& pass) const;

    [[nodiscard]] std::filesystem::path file(const ReferenceSpec& spec, std::size_t index,
                                             std::size_t samples) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace nearlight::core
