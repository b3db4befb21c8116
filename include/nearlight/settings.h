// SPDX-License-Identifier: Apache-2.0
// What can be asked of a view, of a set of virtual point lights, and of a gather.
#pragma once

#include <cstdint>
#include <optional>

namespace nearlight {

/// How virtual point lights (VPLs) are chosen.
enum class SamplerKind {
    close_range,        ///< the paper's: patches close to the camera, sparse light walks elsewhere
    instant_radiosity,  ///< [Keller 1997] quasi-random light walks over the whole scene
    rejection,          ///< [Georgiev & Slusallek 2010] of many walks, those that the camera needs
    metropolis,         ///< [Segovia et al. 2007] Markov chains of light paths towards what the camera needs
    bidirectional,      ///< [Segovia et al. 2006] light walks, and rays from what the camera sees
    local,              ///< [Davidovič et al. 2010] light walks under a wide clamp, and lights of each tile
};

/// What becomes of sparse deposits in the close range, for SamplerKind::close_range; docs/method.md has the
/// reasons.
enum class Policy {
    complete,   ///< patches carry light of all depths, so no deposits are needed there: unbiased
    paper,      ///< deposits are dropped, whatever their depth: loses light of several bounces
    partition,  ///< deposits of depth 2 and more are kept: unbiased
};

/// Which kernel gathers. Both compute the same sum; visibility may differ for rays that meet an edge of a
/// triangle within rounding.
enum class GatherKernel {
    automatic,  ///< packets on CPUs, rays elsewhere
    packets,    ///< one work-item takes up to 256 receivers in vector registers
    rays,       ///< one work-item takes one receiver
};

/// How much time the bounding volume hierarchy is worth.
enum class BvhQuality {
    fast,     ///< every triangle stands in one leaf
    quality,  ///< a triangle may be cut and stand in several: fewer steps a ray, twice the time to build
};

/// What to look at. Empty options are decided by the scene and by a pilot view of about 1000 receivers.
struct ViewSettings {
    std::optional<int> width{};           ///< pixels; empty: the scene's
    std::optional<int> height{};          ///< pixels; empty: the scene's
    std::optional<float> range{};         ///< of the close range, m; empty: holds nine tenths of what is seen
    std::optional<float> clamp_radius{};  ///< R of the bounded geometry term, m; empty: range / 20
    /// As Mitsuba counts: 1 is emission, 2 direct light; empty: the scene's, or 8.
    std::optional<std::uint32_t> max_depth{};
};

/// Which VPLs to make.
struct SamplingSettings {
    SamplerKind sampler = SamplerKind::close_range;
    Policy policy = Policy::complete;
    std::uint32_t vpl_count = 1000;         ///< to aim at; light walks decide how many there are exactly
    std::optional<float> close_fraction{};  ///< of vpl_count for the close range, [0, 1]; empty: by pilot
};

/// How to make pixels of VPLs and emitters.
struct GatherSettings {
    std::uint32_t samples_per_pixel = 4;
    std::uint32_t direct_samples_per_pixel = 64;  ///< for area lights and the environment
    bool indirect_only = false;                   ///< the layer of direct light holds emission only
    /// Russian roulette: a VPL that could bring less than this many times the mean of all is asked about by
    /// chance; 0: every VPL is asked about.
    float roulette = 0.0f;
};

/// A picture: a view, VPLs for it, and a gather, once or several times.
struct RenderSettings {
    ViewSettings view{};
    SamplingSettings sampling{};
    GatherSettings gather{};
    std::uint32_t seed = 0;
    /// Passes to average, each with random numbers and VPLs of its own; empty: one, or, where `seconds` is
    /// given, as many as fit.
    std::optional<std::uint32_t> passes{};
    /// No pass but the first is begun that, to judge by those before it, would end so long after the start.
    std::optional<double> seconds{};
};

/// How a session gets ready.
struct SessionOptions {
    GatherKernel gather_kernel = GatherKernel::automatic;
    BvhQuality bvh_quality = BvhQuality::quality;
};

/// How Session::irradiance() estimates the light at points.
struct IrradianceSettings {
    std::uint32_t direct_samples = 64;  ///< for each point, towards area lights and the environment
    /// How many short paths to trace from each point. They bring back the light that the view's clamp radius
    /// takes away; 0 leaves that light out.
    std::uint32_t paths = 16;
};

}  // namespace nearlight
