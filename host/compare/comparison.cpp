// SPDX-License-Identifier: Apache-2.0
#include "host/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/base/stopwatch.h"
#include "host/cl/kernel_source.h"
#include "host/compare/cost_model.h"
#include "host/image/image_io.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

std::string conditions_of(const Device& device, const SceneFacts& facts, const Reference& reference,
                          const CompareSettings& settings) {
    return hex_digits(facts.hash) + "|" + std::to_string(settings.width) + "x" +
           std::to_string(settings.height) + "|" + std::to_string(settings.samples_per_pixel) + "|" +
           exact_text(facts.range) + "|" + exact_text(facts.clamp_radius) + "|" +
           std::to_string(facts.max_depth) + "|" + hex_digits(identity(reference)) + "|" +
           device.entry().name + "|" + device.entry().driver + "|" + settings.program_version + "|" +
           hex_digits(kernels_hash(device.options().kernel_dir)) + "|" + to_string(settings.bvh_quality);
}

/// Whether the file is a reference of the scene with this hash.
bool shows(const std::filesystem::path& file, const std::string& hash) {
    const Metadata metadata = read_metadata(file);
    const auto found = metadata.find("nearlight:sceneHash");
    return found != metadata.end() && found->second == Metadata::mapped_type(hash);
}

/// The reference file that shows the scene with this hash; empty if none does.
std::optional<std::filesystem::path> reference_file_of(const std::string& hash,
                                                       const CompareSettings& settings) {
    const auto found = std::ranges::find_if(
        settings.reference_files, [&](const std::filesystem::path& file) { return shows(file, hash); });
    return found == settings.reference_files.end() ? std::nullopt : std::optional(*found);
}

/// Assigns each scene its reference file. Throws Error(ErrorKind::file) for a file that fits no scene, or one
/// that has a reference already.
std::vector<std::optional<std::filesystem::path>> assign_reference_files(std::span<const Scene> scenes,
                                                                         const CompareSettings& settings) {
    std::vector<std::optional<std::filesystem::path>> assigned;
    std::vector<std::string> hashes;
    for (const Scene& scene : scenes) {
        hashes.push_back(hex_digits(scene_hash(scene)));
        assigned.push_back(reference_file_of(hashes.back(), settings));
    }
    for (const std::filesystem::path& file : settings.reference_files) {
        if (std::ranges::find(assigned, std::optional(file)) != assigned.end()) {
            continue;
        }
        if (std::ranges::any_of(hashes, [&](const std::string& hash) { return shows(file, hash); })) {
            throw Error(ErrorKind::file,
                        "'" + file.string() +
                            "' shows a scene that another reference shows too; give one for each scene",
                        "reference_files");
        }
        throw Error(ErrorKind::file,
                    "'" + file.string() + "' shows none of the scenes to compare (according to its " +
                        "'nearlight:sceneHash'); make it with `nearlight reference` from the " +
                        "current scene file");
    }
    return assigned;
}

/// The comparison on one scene.
class SceneRun {
  public:
    SceneRun(Device& device, SceneBench& bench, const CompareSettings& settings,
             const CompareObserver& observer)
        : device_(device), bench_(bench), settings_(settings), observer_(observer) {}

    std::optional<Reference> find_reference(const std::optional<std::filesystem::path>& file) const {
        const ReferenceSpec spec = bench_.reference_spec();
        if (file) {
            return load_reference(*file, spec);
        }
        const std::size_t samples =
            spec.sampler ? settings_.reference_vpls : static_cast<std::size_t>(settings_.reference_spp);
        const auto progress = [this](double fraction) {
            observer_.advance(fraction, std::nullopt);
            return !observer_.stopped();
        };
        return make_reference(spec, samples, ReferenceStore(settings_.references()),
                              bench_.reference_maker(spec, progress, samples));
    }

    CellStore cell_store(const Reference& reference) const {
        return {settings_.output / "cells" / bench_.facts().name,
                conditions_of(device_, bench_.facts(), reference, settings_)};
    }

    /// All cells in order; empty if it was stopped.
    std::optional<std::vector<Cell>> measure(const Reference& reference, const CellStore& store,
                                             Comparison& comparison) {
        std::vector<CellId> missing;
        std::vector<Cell> cells;
        for (const CellId& id : cells_of(settings_)) {
            const bool whole = id.seed != settings_.first_seed || store.has_picture(id);
            if (const std::optional<Cell> known = whole ? store.load(id) : std::nullopt) {
                cells.push_back(*known);
            } else {
                missing.push_back(id);
            }
        }
        comparison.reused_cells += cells.size();
        CostModel cost;
        for (std::size_t i = 0; i < missing.size(); ++i) {
            if (observer_.stopped()) {
                return std::nullopt;
            }
            const Stopwatch watch;
            cells.push_back(measure_cell(missing[i], reference, store, progress_of(missing, i, cost)));
            cost.add(missing[i], watch.seconds());
            ++comparison.measured_cells;
        }
        return cells;
    }

  private:
    /// Reports the progress of all cells while cell `index` is measured. A cell is always finished, even
    /// after a request to stop.
    SceneBench::Progress progress_of(std::span<const CellId> cells, std::size_t index,
                                     const CostModel& cost) const {
        double before = 0, total = 0;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            before += i < index ? static_cast<double>(cells[i].vpls) : 0.0;
            total += static_cast<double>(cells[i].vpls);
        }
        const double own = static_cast<double>(cells[index].vpls);
        const std::optional<double> own_seconds = cost.seconds(cells.subspan(index, 1));
        const std::optional<double> seconds = cost.seconds(cells.subspan(index));
        return [=, this](double fraction) {
            const auto left = seconds ? std::optional(*seconds - fraction * *own_seconds) : std::nullopt;
            observer_.advance((before + fraction * own) / total, left);
            return true;
        };
    }

    Cell measure_cell(const CellId& id, const Reference& reference, const CellStore& store,
                      const SceneBench::Progress& progress) {
        const std::optional<Shot> shot = bench_.shoot(id.method, id.vpls, id.seed, progress);
        const RenderReport& report = shot->report;
        const Cell cell{.id = id,
                        .close_vpls = report.totals.close_vpls,
                        .distant_vpls = report.totals.distant_vpls,
                        .sparse_vpls = report.totals.sparse_vpls,
                        .error = picture_error(shot->indirect, reference),
                        .generate_seconds = report.seconds.generate,
                        .gather_seconds = report.seconds.gather,
                        .image_hash = hex_digits(report.image_hash)};
        if (cell.error.non_finite > 0) {
            say_warning("scene '" + bench_.facts().name + "', " + to_string(id.method) + " with " +
                        std::to_string(id.vpls) + " VPLs: " + std::to_string(cell.error.non_finite) +
                        " pixels are not finite and are left out; please report this");
        }
        if (id.seed == settings_.first_seed) {
            store.save_picture(id, shot->indirect);
        }
        store.save(cell);
        return cell;
    }

    Device& device_;
    SceneBench& bench_;
    const CompareSettings& settings_;
    const CompareObserver& observer_;
};

bool has_light(const Reference& reference) {
    return std::ranges::any_of(reference.picture.values, [](float value) { return value != 0.0f; });
}

Error objection_to_black(const SceneFacts& facts) {
    return {ErrorKind::file, "scene '" + facts.name + "' (" + facts.source +
                                 "): no indirect light reaches the camera, so there is nothing to compare"};
}

}  // namespace

std::vector<std::string> unique_names(std::span<const Scene> scenes) {
    std::vector<std::string> names;
    for (const Scene& scene : scenes) {
        std::string name = scene.name.empty() ? "scene" : scene.name;
        std::ranges::replace_if(
            name,
            [](unsigned char c) {
                return c > 127 || (std::isalnum(c) == 0 && c != '.' && c != '_' && c != '-');
            },
            '-');
        const std::string stem = name;
        for (int number = 2; std::ranges::find(names, name) != names.end(); ++number) {
            name = stem + "-" + std::to_string(number);
        }
        names.push_back(name);
    }
    return names;
}

std::optional<Comparison> compare(Device& device, std::span<const Scene> scenes,
                                  const CompareSettings& settings, const CompareObserver& observer) {
    Comparison comparison{.device = device.entry().name, .driver = device.entry().driver};
    const std::vector<std::string> names = unique_names(scenes);
    const auto reference_files = assign_reference_files(scenes, settings);
    make_folder(settings.output);
    std::optional<Error> objection;  // to the last scene that is left out
    const auto leave_out = [&](const Error& why) {
        objection = why;
        if (scenes.size() > 1) {
            say_warning(std::string(why.what()) + "; it is left out");
        }
    };
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const std::string label =
            names[i] + (scenes.size() > 1 ? fmt::format(" ({} of {})", i + 1, scenes.size()) : "");
        observer.begin(label + ": preparing");
        SceneBench bench(device, scenes[i], names[i], settings, reference_files[i]);
        if (bench.objection()) {
            leave_out(*bench.objection());
            continue;
        }
        SceneRun run(device, bench, settings, observer);
        observer.begin(label + ": reference");
        std::optional<Reference> reference = run.find_reference(reference_files[i]);
        if (!reference) {
            return std::nullopt;
        }
        if (!has_light(*reference)) {
            leave_out(objection_to_black(bench.facts()));
            continue;
        }
        const CellStore store = run.cell_store(*reference);
        observer.begin(label + ": measuring");
        const std::optional<std::vector<Cell>> cells = run.measure(*reference, store, comparison);
        if (!cells) {
            return std::nullopt;
        }
        observer.begin(label + ": figures");
        SceneComparison scene{.facts = bench.facts(), .reference = std::move(*reference)};
        scene.equal_vpls = equal_vpls_rows(settings, *cells);
        scene.equal_rmse = equal_rmse(curves_of(settings, scene.equal_vpls), baseline_index(settings));
        scene.figures = make_figures(bench, scene.reference, store, settings, settings.output / "pictures");
        scene.plots = make_plots(scene.facts.name, settings, scene.equal_vpls, settings.output / "plots");
        if (const std::string remark = noise_remark(scene.reference, scene.equal_vpls); !remark.empty()) {
            say_warning("scene '" + scene.facts.name + "': " + remark);
        }
        comparison.scenes.push_back(std::move(scene));
    }
    if (comparison.scenes.empty() && objection) {
        throw Error(*objection);
    }
    return comparison;
}

}  // namespace nearlight::core
