// SPDX-License-Identifier: Apache-2.0
// Compares the light in VPL sets, by region and depth, with the path tracer.
//
// A set of VPLs can be photographed: what a VPL of reflected power Φ at y adds to the pixel that shows y is
// Φ/π times the pixels that a square metre at y covers, seen from there. In expectation that is the radiance
// of light of the VPL's depth only, summed over pixels: the difference of two path-traced pictures whose
// longest path differs by one. Nothing is gathered, so the sets are tested by themselves. Pixels are in
// separate classes if they show the close range or not.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "host/reference/embree_scene.h"
#include "host/scene/scene.h"
#include "tests/session/convergence.h"

namespace nearlight::core::test {

struct EnergyClass {
    std::size_t camera = 0;
    bool inside = false;  ///< whether the pixels show the close range
    uint depth = 1;       ///< of VPLs; 0: all together
    auto operator<=>(const EnergyClass&) const = default;
};
std::string to_string(const EnergyClass& energy_class);

/// Luminance summed over the pixels of a class.
struct Expected {
    double mean = 0;
    double error = 0;  ///< standard error
};

/// Photographs VPL sets of one scene with several cameras.
class Photographer {
  public:
    /// The cameras contain the sizes of their pictures. Depths go from 1 to `depths`. The scene must be
    /// diffuse and without visible lamps.
    Photographer(const Scene& scene, std::vector<SceneCamera> cameras, const CloseRange& region, uint depths);

    /// The expected light, by path tracing, of the classes that have enough pixels.
    [[nodiscard]] const std::map<EnergyClass, Expected>& truth() const { return truth_; }
    /// The light of a VPL set in the same classes, and the sums over all depths.
    [[nodiscard]] std::map<EnergyClass, double> photograph(const std::vector<Vpl>& vpls) const;

  private:
    struct Film {
        SceneCamera camera;
        Mat4 to_camera;
        std::vector<bool> inside;  ///< per pixel
    };
    void expose(std::size_t camera, const Vpl& vpl, std::map<EnergyClass, double>& sums) const;
    void trace_truth(const Scene& scene, std::size_t camera, const CloseRange& region);

    EmbreeScene embree_;
    std::vector<Film> films_;
    std::map<EnergyClass, Expected> truth_;
    uint depths_;
};

/// The expected light of sets that carry all depths up to `depth`, in classes of depth 0.
std::map<EnergyClass, Expected> light_up_to(uint depth, const std::map<EnergyClass, Expected>& truth);

bool in_region(const CloseRange& region, Vec3 p);

/// Whether photographs of several seeds' sets have the expectation that path tracing shows, in each class;
/// the least likely class decides, with a false alarm in 1 / kFalseAlarm verdicts.
Verdict judge_energies(const std::vector<std::map<EnergyClass, double>>& photographs,
                       const std::map<EnergyClass, Expected>& truth);

}  // namespace nearlight::core::test
