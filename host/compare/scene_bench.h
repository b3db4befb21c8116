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

namespace nearlight::core {

/// What was done once for the scene, in this run.
struct SetupSeconds {
    double build_bvh = 0;
    double compile = 0;  ///< kernels; what the driver or the cache had ready takes no time
};

/// What is the same for all methods.
struct SceneFacts {
    std::string name;    ///< unique in the comparison, fit for names of files
    std::string source;  ///< the scene's file
    std::uint64_t hash = 0;
    std::size_t triangles = 0;
    float range = 0;         ///< of the close range, scene units
    float clamp_radius = 0;  ///< scene units
    uint max_depth = 0;      ///< as Mitsuba counts
    SceneCamera camera{};    ///< at the size of the comparison
    SetupSeconds setup{};
};

/// A picture of indirect light and what it took.
struct Shot {
    Image indirect;
    RenderReport report;
};

class SceneBench {
  public:
    /// Compiles, builds the tree and renders a first picture with all light, from which the range and the
    /// clamp radius are decided once for all. Refers to device and scene. Throws Error(ErrorKind::file) where
    /// nothing emits light or nothing is in view.
    SceneBench(Device& device, const Scene& scene, const std::string& name, const CompareSettings& settings,
               const std::optional<std::filesystem::path>& reference_file);

    [[nodiscard]] const SceneFacts& facts() const { return facts_; }
    /// Direct and indirect light, R, G, B.
    [[nodiscard]] const Image& overview() const { return overview_; }
    /// Distance of the first surface from the camera for each pixel, scene units; 0: none.
    [[nodiscard]] const std::vector<float>& depths() const { return depths_; }

    /// How far it is, 0 to 1; false stops.
    using Progress = std::function<bool(double fraction)>;
    /// The indirect light alone. The first shot of a method is preceded by one that is thrown away, which
    /// pays for what drivers do only once. Nothing where `progress` stopped it.
    std::optional<Shot> shoot(const Method& method, uint vpls, uint seed, const Progress& progress);
    /// The VPLs that such a shot gathers.
    VplSet sample(const Method& method, uint vpls, uint seed);

    /// Makes passes of this scene's reference.
    PassMaker reference_maker(const ReferenceSpec& spec, const Progress& progress, std::size_t total_samples);
    [[nodiscard]] ReferenceSpec reference_spec() const;

  private:
    struct FirstLook {
        bool surface = false;     ///< the camera sees something diffuse
        bool close_vpls = false;  ///< what is close is lit
    };
    FirstLook look();
    void check(const FirstLook& found) const;
    [[nodiscard]] float choose_clamp_radius(const std::optional<std::filesystem::path>& reference_file) const;
    [[nodiscard]] RenderSettings render_settings(const Method& method, uint vpls, uint seed) const;
    std::optional<Shot> render_indirect(const RenderSettings& settings, const Progress& progress);
    std::optional<Image> trace_pass(const ReferenceSpec& spec, std::size_t index, std::size_t samples,
                                    const Progress& progress) const;

    const Scene& scene_;
    const CompareSettings& settings_;
    Session session_;
    SceneFacts facts_;
    Image overview_;
    std::vector<float> depths_;
    std::map<std::string, bool> warm_;  ///< methods that had their first shot
};

}  // namespace nearlight::core
