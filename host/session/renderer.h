// SPDX-License-Identifier: Apache-2.0
// The main path: a scene becomes a picture.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "host/session/band_sharing.h"
#include "host/session/settings.h"
#include "host/session/view.h"

namespace nearlight::core {

/// Stage ("gathering") and how far it is, 0 to 1. Returns false to stop.
using RenderProgress = std::function<bool(const std::string& stage, double fraction)>;
/// Finished rows, top to bottom: a multiple of width · NEARLIGHT_LAYER_CHANNELS floats, channels as
/// layer_channels() names them.
using RowSink = std::function<void(std::span<const float> rows)>;

struct RenderSeconds {
    double build_bvh = 0;
    double compile = 0;   ///< while anything was compiled or loaded; the others go on meanwhile
    double upload = 0;    ///< of scene and trees, whose wide form is made meanwhile
    double generate = 0;  ///< pilot and VPLs
    double gather = 0;    ///< camera pass, direct light, gather, film
    double total = 0;
};

struct RenderReport {
    int width = 0;
    int height = 0;
    float range = 0;
    float clamp_radius = 0;
    uint max_depth = 0;
    uint passes = 0;  ///< that were begun
    // Of all passes together:
    std::size_t close_vpls = 0;
    std::size_t distant_vpls = 0;
    std::size_t sparse_vpls = 0;   ///< that only lit other VPLs
    std::size_t candidates = 0;    ///< that VPLs were chosen from; 0: there was no choice
    std::size_t local_lights = 0;  ///< of all tiles
    float close_fraction = 0;      ///< of the first pass
    RenderSeconds seconds;
    std::vector<BandShare> shares;  ///< of the picture, by device
    std::size_t device_bytes = 0;   ///< most at any time, all devices together
    std::uint64_t image_hash = 0;   ///< of the beauty's bits; equal pictures have equal hashes
    bool interrupted = false;       ///< the last pass is not whole; rows that no pass reached were not sent
};

/// Called when all settings are decided and before the first row, so that files can be opened with the right
/// size and metadata, and VPLs (of the first pass) be looked at. Of several passes rows come after the last.
using RenderStart = std::function<void(const RenderReport&, const View&, const VplSet&)>;

/// Begins to compile what a render with these settings needs, so that it goes on while the scene is loaded. A
/// Renderer of the same device finds it compiled or waits for the rest.
void begin_compiling(std::span<Device* const> devices, const RenderSettings& settings);

/// A scene on one or several devices, ready for any number of pictures: tree built, everything uploaded;
/// kernels compile until they are first launched. VPLs are made on the first device, bands of the picture on
/// all. Devices of one type give the same bits as each of them alone.
class Renderer {
  public:
    /// Refers to `devices` (one or more) and `scene`, which must outlive it. A device that fails here or in a
    /// picture is left out from then on, with a warning; when none is left, its error is thrown.
    Renderer(std::span<Device* const> devices, const Scene& scene,
             GatherKernel gather_kernel = GatherKernel::automatic,
             BvhQuality bvh_quality = BvhQuality::quality);
    Renderer(Device& device, const Scene& scene, GatherKernel gather_kernel = GatherKernel::automatic,
             BvhQuality bvh_quality = BvhQuality::quality);
    ~Renderer();

    /// A picture, or the mean of several. The report's seconds of building and compiling are the
    /// constructor's, once; so its total is what a render takes from the scene on.
    RenderReport render(const RenderSettings& settings, const RenderStart& start, const RowSink& sink,
                        const RenderProgress& progress);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The only picture of a scene.
RenderReport render(std::span<Device* const> devices, const Scene& scene, const RenderSettings& settings,
                    const RenderStart& start, const RowSink& sink, const RenderProgress& progress);
RenderReport render(Device& device, const Scene& scene, const RenderSettings& settings,
                    const RenderStart& start, const RowSink& sink, const RenderProgress& progress);

}  // namespace nearlight::core
