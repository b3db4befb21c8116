// SPDX-License-Identifier: Apache-2.0
// A folder of passes of references, found again by what they show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "host/image/image.h"

namespace nearlight {

enum class ReferenceKind {
    path_tracing,       ///< Embree, host/reference
    instant_radiosity,  ///< very many VPLs, as in the paper
};
const char* to_string(ReferenceKind kind);

/// All that shapes the expectation of a reference.
struct ReferenceSpec {
    ReferenceKind kind = ReferenceKind::path_tracing;
    std::string scene_name;  ///< for names of files only
    std::uint64_t scene_hash = 0;
    int width = 0;
    int height = 0;
    float clamp_radius = 0;
    unsigned max_depth = 0;      ///< as Mitsuba counts
    bool pixel_centers = false;  ///< rays go through the pixels' centres, not all over them
};

class ReferenceStore {
  public:
    /// The folder is made when something is saved.
    explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Pass `index` of so many samples, if it is there; one that cannot be read is as good as missing, with a
    /// warning.
    [[nodiscard]] std::optional<Image> load(const ReferenceSpec& spec, std::size_t index,
                                            std::size_t samples) const;
    /// Throws Error(ExitCode::file).
    void save(const ReferenceSpec& spec, std::size_t index, std::size_t samples, const Image& pass) const;

    [[nodiscard]] std::filesystem::path file(const ReferenceSpec& spec, std::size_t index,
                                             std::size_t samples) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace nearlight
