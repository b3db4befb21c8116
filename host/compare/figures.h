// SPDX-License-Identifier: Apache-2.0
// The pictures of a report, as PNG files: where VPLs are (the paper's figure 1), and what each method makes
// of the scene at each count (figures 2 to 4).
#pragma once

#include <filesystem>
#include <vector>

#include "host/compare/cell_store.h"
#include "host/compare/scene_bench.h"

namespace nearlight::core {

struct PictureFile {
    std::filesystem::path full;
    std::filesystem::path small;  ///< for overviews; the same file where that is small enough
};

struct VplFigure {
    Method method;
    std::size_t vpls = 0;
    std::size_t in_picture = 0;  ///< before the camera and within the picture
    std::size_t visible = 0;     ///< of those, not behind anything
    PictureFile file;
};

/// One method at one count, first seed.
struct MethodFigure {
    Method method;
    uint vpls = 0;  ///< asked for
    PictureFile picture{};
    PictureFile error_map{};  ///< signed_error_map()
    std::vector<std::filesystem::path> crops{};
    std::vector<double> crop_rmse{};  ///< the reference's noise not subtracted
};

struct SceneFigures {
    PictureFile overview;   ///< direct and indirect light
    PictureFile reference;  ///< indirect light, as all that follow
    std::vector<Crop> crops;
    std::vector<std::filesystem::path> reference_crops;
    std::vector<VplFigure> vpls;        ///< at the smallest count, one a method
    std::vector<MethodFigure> methods;  ///< by count, then in the order of the methods
};

/// Makes them all in `folder`. Crops that the settings leave open are where instant radiosity (or the first
/// method that is not the baseline) errs most at the smallest count.
SceneFigures make_figures(SceneBench& bench, const Reference& reference, const CellStore& cells,
                          const CompareSettings& settings, const std::filesystem::path& folder);

}  // namespace nearlight::core
