// SPDX-License-Identifier: Apache-2.0
#include "host/compare/figures.h"

#include <algorithm>

#include "host/base/files.h"
#include "host/compare/pictures.h"
#include "host/compare/vpl_figure.h"
#include "host/image/image_io.h"

namespace nearlight::core {
namespace {

constexpr int kOverviewWidth = 200;
constexpr std::size_t kAutomaticCrops = 2;

/// Writes PNG files named `scene`-`what`.png.
class Album {
  public:
    Album(std::filesystem::path folder, std::string scene)
        : folder_(std::move(folder)), scene_(std::move(scene)) {
        make_folder(folder_);
    }

    std::filesystem::path write(const std::string& what, const Image& picture) const {
        std::filesystem::path file = folder_ / (scene_ + "-" + what + ".png");
        write_image(file, picture);
        return file;
    }
    PictureFile write_both(const std::string& what, const Image& picture,
                           int small_width = kOverviewWidth) const {
        PictureFile file;
        file.full = write(what, picture);
        file.small =
            picture.width <= small_width ? file.full : write(what + "-small", shrunk(picture, small_width));
        return file;
    }

  private:
    std::filesystem::path folder_;
    std::string scene_;
};

/// The method whose errors decide the crops.
Method hard_method(const CompareSettings& settings) {
    const Method rival{SamplerKind::instant_radiosity, std::nullopt};
    if (std::ranges::find(settings.methods, rival) != settings.methods.end()) {
        return rival;
    }
    const auto other =
        std::ranges::find_if(settings.methods, [&](const Method& m) { return m != settings.baseline; });
    return other == settings.methods.end() ? settings.baseline : *other;
}

std::vector<Crop> choose_crops(const Reference& reference, const CellStore& cells,
                               const CompareSettings& settings) {
    if (!settings.crops.empty()) {
        return settings.crops;
    }
    const Image picture =
        cells.load_picture({hard_method(settings), settings.vpl_counts.front(), settings.first_seed});
    return hardest_crops(picture, reference.picture, kAutomaticCrops);
}

MethodFigure make_method_figure(const Album& album, const Reference& reference,
                                const std::vector<Crop>& crops, const CellId& id, const Image& picture) {
    const std::string name = file_stem(id.method) + "-" + std::to_string(id.vpls);
    MethodFigure figure{.method = id.method, .vpls = id.vpls};
    const Image shown = scaled(picture, reference.display_scale);
    figure.picture = album.write_both(name, shown);
    figure.error_map = album.write_both(name + "-error", signed_error_map(picture, reference.picture));
    for (std::size_t i = 0; i < crops.size(); ++i) {
        figure.crops.push_back(album.write(name + "-crop" + std::to_string(i + 1), cropped(shown, crops[i])));
        figure.crop_rmse.push_back(rmse_of_part(picture, reference.picture, crops[i]));
    }
    return figure;
}

VplFigure make_vpl_figure(const Album& album, SceneBench& bench, const Method& method, uint vpls, uint seed) {
    const VplSet set = bench.sample(method, vpls, seed);
    const VplDots dots =
        draw_vpls(bench.overview(), bench.depths(), bench.facts().camera, set.vpls.download());
    return {method, dots.vpls, dots.in_picture, dots.visible,
            album.write_both("vpls-" + file_stem(method), dots.picture, 2 * kOverviewWidth)};
}

}  // namespace

SceneFigures make_figures(SceneBench& bench, const Reference& reference, const CellStore& cells,
                          const CompareSettings& settings, const std::filesystem::path& folder) {
    const Album album(folder, bench.facts().name);
    SceneFigures figures;
    figures.overview =
        album.write_both("overview", scaled(bench.overview(), display_scale(bench.overview())));
    const Image shown = scaled(reference.picture, reference.display_scale);
    figures.reference = album.write_both("reference", shown);
    figures.crops = choose_crops(reference, cells, settings);
    for (std::size_t i = 0; i < figures.crops.size(); ++i) {
        figures.reference_crops.push_back(
            album.write("reference-crop" + std::to_string(i + 1), cropped(shown, figures.crops[i])));
    }
    for (const Method& method : settings.methods) {
        figures.vpls.push_back(
            make_vpl_figure(album, bench, method, settings.vpl_counts.front(), settings.first_seed));
    }
    for (const uint vpls : settings.vpl_counts) {
        for (const Method& method : settings.methods) {
            const CellId id{method, vpls, settings.first_seed};
            figures.methods.push_back(
                make_method_figure(album, reference, figures.crops, id, cells.load_picture(id)));
        }
    }
    return figures;
}

}  // namespace nearlight::core
