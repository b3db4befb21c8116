// SPDX-License-Identifier: Apache-2.0
// The pictures of a report, as PNG files: the positions of VPLs (the paper's figure 1), and the scene as each
// method renders it at each count (figures 2 to 4).
#pragma once

#include <filesystem>
#include <vector>

#include "host/compare/cell_store.h"
#include "host/compare/scene_bench.h"

namespace nearlight::core {

struct PictureFile {
    std::filesystem::path full;
    std::filesystem::path small;  ///< for overviews; the same as `full` if that is small enough
};

struct VplFigure {
    Method method;
    std::size_t vpls = 0;
    std::size_t in_picture = 0;  ///< VPLs in front of the camera and within the picture
    std::size_t visible = 0;     ///< VPLs of in_picture that nothing hides
    PictureFile file;
};

/// The pictures of one method at one count, with the first seed.
struct MethodFigure {
    Method method;
    uint vpls = 0;  ///< number of VPLs that was asked for
    PictureFile picture{};
    PictureFile error_map{};  ///< signed_error_map()
    std::vector<std::filesystem::path> crops{};
    std::vector<double> crop_rmse{};  ///< RMSE of each crop; the reference's noise is not subtracted
};

struct SceneFigures {
    PictureFile overview;   ///< direct and indirect light
    PictureFile reference;  ///< indirect light, as in all other pictures below
    std::vector<Crop> crops;
    std::vector<std::filesystem::path> reference_crops;
    std::vector<VplFigure> vpls;        ///< at the smallest count, one per method
    std::vector<MethodFigure> methods;  ///< by count, then in the order of the methods
};

/// Makes all figures in `folder`. If the settings give no crops, they are the parts with the largest error of
/// instant radiosity (or else of the first method that is not the baseline) at the smallest count.
SceneFigures make_figures(SceneBench& bench, const Reference& reference, const CellStore& cells,
                          const CompareSettings& settings, const std::filesystem::path& folder);

}  // namespace nearlight::core
