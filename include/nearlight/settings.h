// SPDX-License-Identifier: Apache-2.0
// The settings of a view, of a set of virtual point lights, of a gather, of a session and of an animation.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nearlight/vec3.h"

namespace nearlight {

/// How virtual point lights (VPLs) are chosen.
enum class SamplerKind {
    close_range,        ///< the paper's method: patches close to the camera, sparse light walks elsewhere
    instant_radiosity,  ///< [Keller 1997] quasi-random light walks over the whole scene
    rejection,          ///< [Georgiev & Slusallek 2010] many light walks; VPLs that bring little are rejected
    metropolis,         ///< [Segovia et al. 2007] Markov chains of light paths towards what the camera needs
    bidirectional,      ///< [Segovia et al. 2006] light walks, and rays from what the camera sees
    local,              ///< [Davidovič et al. 2010] light walks with a wide clamp, and local lights per tile
};

/// The rule for deposits of light walks in the close range, for SamplerKind::close_range; docs/method.md
/// explains it.
enum class Policy {
    complete,   ///< those of all depths are candidates, as patches are, with which they share the light
                ///< there; VPLs are drawn from both: unbiased
    paper,      ///< deposits of all depths are dropped: loses light of several bounces
    partition,  ///< deposits of depth 2 and more are kept: unbiased
};

/// Which kernel gathers. Both compute the same sum; visibility may differ for rays that pass an edge of a
/// triangle within rounding.
enum class GatherKernel {
    automatic,  ///< packets on CPUs, rays elsewhere
    packets,    ///< one work-item takes up to 256 receivers in vector registers
    rays,       ///< one work-item takes one receiver
};

/// How much time the bounding volume hierarchy is worth.
enum class BvhQuality {
    fast,     ///< every triangle is in exactly one leaf
    quality,  ///< triangles may be split among leaves: fewer steps per ray, twice the time to build
};

/// Where a camera stands and where it looks.
struct CameraPose {
    Vec3 origin{};             ///< m
    Vec3 target{};             ///< a point in the middle of the picture, m
    std::optional<Vec3> up{};  ///< what points upwards in the picture; empty: as the scene's camera has it
    /// The horizontal field of view of the film in degrees, between 0 and 180, with which an orthographic
    /// camera becomes a perspective one; empty: the scene's.
    std::optional<double> fov_x_degrees{};

    friend bool operator==(const CameraPose&, const CameraPose&) = default;
};

/// What to look at. The scene and a pilot view of about a thousand receivers decide the options that are
/// empty.
struct ViewSettings {
    std::optional<CameraPose> camera{};  ///< empty: the scene's
    std::optional<int> width{};          ///< pixels, 1 to 65536; empty: the scene's
    std::optional<int> height{};         ///< pixels, 1 to 65536; empty: the scene's
    /// Range, m, 1e-6 to 1e9; empty: the close range holds nine tenths of what is seen.
    std::optional<float> range{};
    /// R of the bounded geometry term, m, 0 to 1e9. Empty takes range / 20, and from there Session::sample()
    /// lets a pilot choose a radius of least noise for its VPLs, which counts where rays compensate for it.
    std::optional<float> clamp_radius{};
    /// Whether that pilot runs, which also chooses the number of light samples. It takes about 0.2 s of
    /// processor time. Without it, an empty clamp radius is range / 20.
    bool ray_budget_pilot = true;
    /// The length of the longest light path, as Mitsuba counts: 1 is emission, 2 is direct light; at most
    /// 1024. Empty takes the scene's, which is 256 if its file sets no limit.
    std::optional<std::uint32_t> max_depth{};

    friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

/// How to make VPLs.
struct SamplingSettings {
    SamplerKind sampler = SamplerKind::close_range;
    Policy policy = Policy::complete;
    /// Target number of VPLs that a pixel asks, at most 50 million; light walks decide the exact one.
    std::uint32_t vpl_count = 1000;
    /// Whether the set holds more VPLs than a pixel asks, so that each bundle of receivers asks those that
    /// could bring it most. The sampler `local` ignores it.
    bool cuts = false;
    /// With cuts, the target number of VPLs in the set, 1 to 50 million; empty: 64 times `vpl_count`, but at
    /// most 2^20. Without cuts, or if it is less than `vpl_count`, or if that is 0, the set has `vpl_count`.
    std::optional<std::uint32_t> set_count{};
    /// Share of the close range, 0 to 1; empty: chosen by a pilot. The policy `complete` ignores it with
    /// cuts.
    std::optional<float> close_fraction{};
    /// If it is not empty, the VPLs are those of this PLY file (docs/vpl-files.md), and the members above
    /// count for nothing. A picture of them has a single pass.
    std::filesystem::path file{};

    /// The target number of VPLs in the set.
    [[nodiscard]] std::uint32_t set_count_or_auto() const {
        constexpr std::uint64_t max_auto = 1u << 20u;
        const auto many = static_cast<std::uint32_t>(std::min(std::uint64_t{64} * vpl_count, max_auto));
        const bool has_cuts = cuts && sampler != SamplerKind::local && vpl_count > 0;
        return has_cuts ? std::max(set_count.value_or(many), vpl_count) : vpl_count;
    }

    friend bool operator==(const SamplingSettings&, const SamplingSettings&) = default;

    /// Whether bundles of receivers ask a part of the set only.
    [[nodiscard]] bool asks_part() const { return set_count_or_auto() > vpl_count; }
};

/// A part of a picture, in pixels.
struct PixelWindow {
    std::uint32_t x = 0;       ///< of the leftmost pixel
    std::uint32_t y = 0;       ///< of the topmost pixel
    std::uint32_t width = 0;   ///< at least 1
    std::uint32_t height = 0;  ///< at least 1

    friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

/// How to make pixels from VPLs and emitters.
struct GatherSettings {
    std::uint32_t samples_per_pixel = 16;  ///< 1 to 65536
    /// The number of strata into which the set of VPLs is divided, 1 to 65536. The samples of a pixel take
    /// turns: each asks the VPLs of one stratum, which then count for the whole set, so that `vpl_count` is
    /// what the pixel asks in all. 1 makes every sample ask all VPLs; empty makes as many strata as there are
    /// samples in a pixel, or in a square of `interleave`.
    std::optional<std::uint32_t> strata{};
    /// Above 1, the pixels of each square of interleave × interleave pixels share the strata too, so that a
    /// pixel asks that part of `vpl_count` only. The noise of neighbouring pixels is then independent,
    /// which denoisers need. 1, 2 or 4.
    std::uint32_t interleave = 1;
    /// The part of the picture to make; empty: all of it. Its pixels are those of the whole picture, to the
    /// bit.
    std::optional<PixelWindow> window{};
    /// Samples towards area lights, the sun and the environment, and towards points, spots, projectors and
    /// directional lights if there are more than sixteen of these, 1 to 1 million; empty: 16 to 128, as a
    /// pilot chooses.
    std::optional<std::uint32_t> direct_samples_per_pixel{};
    /// Whether rays of receivers bring back what the clamp radius takes away and what surfaces reflect in
    /// other ways than Lambertian. Without them, the picture lacks that light.
    bool compensate = true;
    /// Rays of receivers, if `compensate` is set, and as many that look for lights in rough reflections; 1 to
    /// 1 million.
    std::uint32_t rays_per_pixel = 64;
    /// Whether pixels at edges of windows and lamps, of their images in mirrors, and of highlights get up to
    /// eight times the camera paths of others, for the light that these paths bring on their own. Pixels with
    /// fewer than four samples do not.
    bool refine = true;
    /// Whether samples count in all pixels whose reconstruction filter reaches them. Neighbours then share
    /// their noise: there is much less of it than where each pixel has its own samples alone, but denoisers
    /// find it harder to tell from the picture. Pictures with fewer than four samples in a pixel, with a
    /// filter that reaches no other pixel, or with one of a radius above 2.5 pixels, do without.
    bool splat = true;
    /// Leaves out the direct light of receivers. The layer of direct light keeps what camera paths bring on
    /// their own: lights that are seen, mirrored or reflected in highlights, and reflections of little
    /// weight.
    bool indirect_only = false;
    /// Bundles of receivers share the light that their rays find. What one path brings from a lamp that it
    /// met by chance stays with its receiver where it is more than this radiance (W/m²/sr): it makes a bright
    /// dot, not a bright tile. Empty: as a pilot chooses.
    std::optional<float> shared_limit{};
    /// The threshold of Russian roulette, as a multiple of the mean that VPLs could bring, 0 to 1000. A
    /// bundle of receivers asks VPLs below it only by chance; 0 makes every bundle ask every VPL. The sampler
    /// `local` ignores it.
    float roulette = 0.0f;
    /// A pixel's only sample goes through its middle, unless this is set: then it lies anywhere in the reach
    /// of the reconstruction filter, so that the mean of many such pictures has smooth edges. The passes of a
    /// picture set it.
    bool spread_single_samples = false;

    [[nodiscard]] std::uint32_t strata_or_auto() const {
        return strata.value_or(samples_per_pixel * interleave * interleave);
    }
};

/// How to make a picture: a view, VPLs for it and a gather, in one pass or several.
struct RenderSettings {
    ViewSettings view{};
    SamplingSettings sampling{};
    GatherSettings gather{};
    std::uint32_t seed = 0;
    /// The number of passes to average, 1 to 1 million, each with random numbers and VPLs of its own. Empty
    /// means one pass, or, if `seconds` or `error` is given, as many as it takes.
    std::optional<std::uint32_t> passes{};
    /// The time limit in seconds, 0 to 1e9, from the call that makes the picture. The last pass has fewer
    /// samples, so that it ends in time; so has the first, if it would take far longer, but never fewer than
    /// two (or `samples_per_pixel`).
    std::optional<double> seconds{};
    /// Makes passes until the relative error of the picture is at most this, 1e-5 to 100, or until there are
    /// `passes`, or 1000. The relative error is the root of the mean of variance ÷ (b² + m²/100) over all
    /// pixels but the thousandth with the largest quotients; b is the mean of the pixel's tile, m that of the
    /// picture.
    std::optional<double> error{};
    /// The samples per pixel of each pass, instead of `passes`: what Picture::pass_samples says of a picture
    /// makes the same picture again. Empty: all passes have `samples_per_pixel`, unless limits end them.
    std::vector<std::uint32_t> pass_samples{};
};

/// How a session gets ready.
struct SessionOptions {
    GatherKernel gather_kernel = GatherKernel::automatic;
    BvhQuality bvh_quality = BvhQuality::quality;
};

/// How the frames of an animation are made.
struct AnimationOptions {
    double fps = 24.0;  ///< frames per second, 0.001 to 1e6: frame N shows the time N / fps
    /// The animations to play: their names, or their numbers counted from 1. Empty: all but those that move
    /// what an earlier one moves.
    std::vector<std::string> animations{};
    /// Where only the camera moves, VPLs are made for the views of every so many frames, and fade from one to
    /// the next, at most 999999; 0: anew for each frame; empty: as many as fps.
    std::optional<int> vpl_keys{};
};

/// How Session::irradiance() estimates the light at points.
struct IrradianceSettings {
    /// Samples per point towards area lights and the environment, 1 to 1 million.
    std::uint32_t direct_samples = 64;
    /// How many short paths to trace from each point, at most 65536. They bring back the light that the
    /// clamp radius of the VPLs takes away; 0 leaves that light out.
    std::uint32_t paths = 16;
};

}  // namespace nearlight
