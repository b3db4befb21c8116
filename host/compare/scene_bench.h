// SPDX-License-Identifier: Apache-2.0
// One scene on one device, ready to be rendered by any method under equal conditions.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "host/compare/reference.h"
#include "host/compare/settings.h"
#include "host/session/render.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// Seconds of the work that is done once per scene and run.
struct SetupSeconds {
    double build_bvh = 0;
    double compile = 0;  ///< compiling kernels; about 0 for kernels in the driver's cache or ours
};

/// Facts about a scene that are the same for all methods.
struct SceneFacts {
    std::string name;    ///< unique in the comparison, and usable in names of files
    std::string source;  ///< the scene's file
    std::uint64_t hash = 0;
    std::size_t triangles = 0;
    float range = 0;         ///< range of the close range, m
    float clamp_radius = 0;  ///< m
    uint max_depth = 0;      ///< in Mitsuba's counting
    SceneCamera camera{};    ///< with the picture size of the comparison
    SetupSeconds setup{};
};

/// A picture of indirect light, and the report of rendering it.
struct Shot {
    Image indirect;
    RenderReport report;
};

class SceneBench {
  public:
    /// Compiles, builds the tree and renders a first picture with all light, from which the range and the
    /// clamp radius of all methods follow. All arguments must outlive this object.
    SceneBench(Device& device, const Scene& scene, const std::string& name, const CompareSettings& settings,
               const std::optional<std::filesystem::path>& reference_file);

    /// Why there is nothing to compare: nothing emits light, nothing is in view, or paths are too short. Then
    /// no other function may be called but facts().
    [[nodiscard]] const std::optional<Error>& objection() const { return objection_; }
    [[nodiscard]] const SceneFacts& facts() const { return facts_; }
    /// The picture with direct and indirect light, R, G, B.
    [[nodiscard]] const Image& overview() const { return overview_; }
    /// Distance of the first surface from the camera for each pixel, m; 0: none.
    [[nodiscard]] const std::vector<float>& depths() const { return depths_; }

    /// Receives the fraction that is done, 0 to 1. It returns false to stop.
    using Progress = std::function<bool(double fraction)>;
    /// Renders the indirect light alone; empty if `progress` stopped it. Before the first shot of a method,
    /// another one is made and thrown away, because drivers do some work only the first time.
    std::optional<Shot> shoot(const Method& method, uint vpls, uint seed, const Progress& progress);
    /// The VPLs that a shot with the same arguments gathers.
    VplSet sample(const Method& method, uint vpls, uint seed);

    /// Makes passes of this scene's reference.
    PassMaker reference_maker(const ReferenceSpec& spec, const Progress& progress, std::size_t total_samples);
    [[nodiscard]] ReferenceSpec reference_spec() const;

  private:
    struct FirstLook {
        bool surface = false;     ///< whether the camera sees a diffuse surface
        bool close_vpls = false;  ///< whether light reaches the close range
    };
    FirstLook look();
    /// Warns if the first look found no light in the close range.
    [[nodiscard]] std::optional<Error> objection_to(const FirstLook& found) const;
    [[nodiscard]] float choose_clamp_radius(const std::optional<std::filesystem::path>& reference_file) const;
    [[nodiscard]] RenderSettings render_settings(const Method& method, uint vpls, uint seed) const;
    std::optional<Shot> render_indirect(const RenderSettings& settings, const Progress& progress);
    std::optional<Image> trace_pass(const ReferenceSpec& spec, std::size_t index, std::size_t samples,
                                    const Progress& progress) const;

    const Scene& scene_;
    const CompareSettings& settings_;
    Session session_;
    std::optional<Error> objection_;
    SceneFacts facts_;
    Image overview_;
    std::vector<float> depths_;
    std::map<std::string, bool> warm_;  ///< names of the methods that had their first shot
};

}  // namespace nearlight::core
