// SPDX-License-Identifier: Apache-2.0
// A folder of passes of references, found again by what they show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "host/compare/method.h"
#include "host/image/image.h"

namespace nearlight::core {

/// All that shapes the expectation of a reference.
struct ReferenceSpec {
    std::optional<Method> sampler;  ///< of very many VPLs; none: path tracing with Embree, host/reference
    std::string scene_name;         ///< for names of files only
    std::uint64_t scene_hash = 0;
    int width = 0;
    int height = 0;
    float clamp_radius = 0;
    unsigned max_depth = 0;      ///< as Mitsuba counts
    bool pixel_centers = false;  ///< rays go through the pixels' centres, not all over them
};

/// What makes it: "path tracing", or the sampler's name.
std::string method_name(const ReferenceSpec& spec);

class ReferenceStore {
  public:
    /// The folder is made when something is saved.
    explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Pass `index` of so many samples, if it is there; one that cannot be read is as good as missing, with a
    /// warning.
    [[nodiscard]] std::optional<Image> load(const ReferenceSpec& spec, std::size_t index,
                                            std::size_t samples) const;
    /// Throws Error(ErrorKind::file).
    void save(const ReferenceSpec& spec, std::size_t index, std::size_t samples, const Image& pass) const;

    [[nodiscard]] std::filesystem::path file(const ReferenceSpec& spec, std::size_t index,
                                             std::size_t samples) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace nearlight::core
