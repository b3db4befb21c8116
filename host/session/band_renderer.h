// SPDX-License-Identifier: Apache-2.0
// Renders one device's bands of a picture, from the camera to finished rows.
#pragma once

#include <optional>
#include <span>

#include "host/samplers/sampler.h"
#include "host/session/band_sharing.h"
#include "host/session/local_gather.h"
#include "host/session/plan.h"
#include "host/session/view.h"
#include "host/stages/camera_pass.h"
#include "host/stages/film.h"
#include "host/stages/gatherer.h"
#include "host/stages/light_cuts.h"
#include "host/stages/receiver_paths.h"
#include "host/stages/roulette.h"

namespace nearlight::core {

/// The stages that make a band. Construction begins to compile them.
struct BandStages {
    BandStages(Device& on_device, GatherKernel gather_kernel)
        : device(on_device),
          camera_pass(device),
          receiver_paths(device),
          gatherer(device, {.kernel = gather_kernel}),
          film(device) {}

    Device& device;
    CameraPass camera_pass;
    ReceiverPaths receiver_paths;
    Gatherer gatherer;
    Film film;
    // These stages are made when they are first needed.
    std::optional<LocalGather> local_gather{};
    std::optional<Roulette> roulette{};
    std::optional<LightCuts> light_cuts{};
};

/// The parts of a picture's task that are the same for all bands and devices.
struct Picture {
    const View& view;
    const GatherSettings& settings;
    const RayBudget& budget;
    uint seed = 0;
    const RenderPlan& plan;
    const VplSet& vpls;  ///< on one device, and on the host if there are several devices
};

class BandRenderer {
  public:
    /// Uploads the VPLs unless they are on this device. Keeps references to all of its arguments.
    BandRenderer(BandStages& stages, const DeviceScene& scene, const Picture& picture);

    /// Renders the rows of band `index` of picture.plan, with all layers. Returns nothing if cancelled.
    std::optional<FinishedBand> render(uint index, const BandProgress& progress);

  private:
    /// Device memory that all batches use one after the other.
    struct BatchBuffers {
        BatchBuffers(Device& device, std::size_t packets, std::size_t pixels);

        Buffer<ReceiverPacket> receivers;
        Buffer<CameraVertex> vertices;
        Buffer<IrradiancePacket> direct;
        Buffer<IrradiancePacket> indirect;
        GatherSums<Vpl> gathered;
        Buffer<float> sums;
        Buffer<float> layers;
    };

    void trace_receivers(std::size_t packets);
    bool add_batch(const CameraBand& batch, uint row_count, const GatherProgress& progress);
    bool gather_vpls(const CameraBand& batch, const GatherProgress& progress);
    std::optional<VplSelection> select_vpls(std::size_t packets, const VplStrata& strata);
    [[nodiscard]] const VplBuffer& vpls() const;

    BandStages& stages_;
    const DeviceScene& scene_;
    const Picture& picture_;
    Buffer<Camera> camera_;
    Buffer<CloseRange> close_range_;
    VplBuffer own_vpls_;               ///< empty if picture.vpls is on this device
    std::optional<CutTree> cut_tree_;  ///< over the VPLs, if bundles ask cuts
    BatchBuffers buffers_;
};

}  // namespace nearlight::core
