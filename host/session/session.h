// SPDX-License-Identifier: Apache-2.0
// A scene on devices, and the three steps of a picture, each of which gives its product away: look, sample,
// gather.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "host/samplers/sampler.h"
#include "host/session/device_pool.h"
#include "host/session/view.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// Of getting a scene ready.
struct SessionSeconds {
    double build_bvh = 0;
    double upload = 0;  ///< of scene and trees, whose wide form is made meanwhile
    double total = 0;
};

/// How far a gather is, 0 to 1. Returns false to stop.
using GatherFraction = BandProgress;
/// Finished rows, top to bottom: a multiple of width · NEARLIGHT_LAYER_CHANNELS floats, channels as
/// layer_channels() names them.
using RowSink = std::function<void(std::span<const float> rows)>;

struct GatherOutcome {
    std::vector<BandShare> shares;  ///< of the picture, by device
    std::size_t local_lights = 0;   ///< of all tiles
    bool interrupted = false;       ///< by `progress`: rows are missing at the bottom
};

/// Ready from construction on: tree built, everything uploaded; kernels compile until they are first
/// launched. Views and VPLs are made on the first device, rows on all. Devices of one type give the same bits
/// as each of them alone. A device that fails is left out from then on, with a warning; when none is left,
/// its error is thrown. For one thread at a time.
class Session {
  public:
    /// Refers to `devices` (one or more) and `scene`, which must outlive it.
    Session(std::span<Device* const> devices, const Scene& scene, const SessionOptions& options = {});
    Session(Device& device, const Scene& scene, const SessionOptions& options = {});

    /// Decides what the settings leave open, by a pilot of about a thousand receivers.
    View look(const ViewSettings& settings, uint seed);

    /// VPLs for that view, on the leading device.
    VplSet sample(const View& view, const SamplingSettings& settings, uint seed);

    /// Camera pass, direct light, the light of the VPLs, film. Rows come in order, in the caller's thread.
    GatherOutcome gather(const View& view, const VplSet& vpls, const GatherSettings& settings, uint seed,
                         const RowSink& sink, const GatherFraction& progress);

    /// W/m² that arrive at points (m) on the side of their unit normals: direct light, the light of `vpls`
    /// under the view's clamp radius, and by short paths what that radius takes away. In expectation that is
    /// all light of the view's depth, if `vpls` are of an unbiased sampler. One value a point; `points` and
    /// `normals` have the same length, else Error(ErrorKind::invalid_argument).
    std::vector<Vec3> irradiance(std::span<const Vec3> points, std::span<const Vec3> normals,
                                 const View& view, const VplSet& vpls, const IrradianceSettings& settings,
                                 uint seed);

    /// Of getting ready; zeros when asked again, so that only one picture is charged with it.
    [[nodiscard]] SessionSeconds take_seconds() { return std::exchange(seconds_, {}); }
    /// While anything was compiled or loaded, since this was asked before or the device was opened. Other
    /// work goes on meanwhile.
    [[nodiscard]] double new_compile_seconds();
    /// Allocated at most, all devices together.
    [[nodiscard]] std::size_t peak_bytes() const { return pool_.peak_bytes(); }
    /// The scene as the leading device has it, for who runs single stages.
    [[nodiscard]] const DeviceScene& device_scene() const { return pool_.leader().scene; }

  private:
    const Scene& scene_;
    DevicePool pool_;
    SessionSeconds seconds_;
    double told_compile_seconds_ = 0;
};

/// Begins to compile what a render with these settings needs, so that it goes on while the scene is loaded. A
/// Session on the same devices finds it compiled or waits for the rest.
void begin_compiling(std::span<Device* const> devices, const SessionOptions& options,
                     const SamplingSettings& settings);

}  // namespace nearlight::core
