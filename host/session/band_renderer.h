// SPDX-License-Identifier: Apache-2.0
// One device's part in a picture: bands of it, from the camera to finished rows.
#pragma once

#include <optional>
#include <span>

#include "host/samplers/sampler.h"
#include "host/session/band_sharing.h"
#include "host/session/local_gather.h"
#include "host/session/plan.h"
#include "host/session/view.h"
#include "host/stages/camera_pass.h"
#include "host/stages/direct_light.h"
#include "host/stages/film.h"
#include "host/stages/gatherer.h"
#include "host/stages/roulette.h"

namespace nearlight::core {

/// The stages of a band, compiling from construction on.
struct BandStages {
    BandStages(Device& on_device, GatherKernel gather_kernel)
        : device(on_device),
          camera_pass(device),
          direct_light(device),
          gatherer(device, {.kernel = gather_kernel}),
          film(device) {}

    Device& device;
    CameraPass camera_pass;
    DirectLight direct_light;
    Gatherer gatherer;
    Film film;
    // Made when first wanted:
    std::optional<LocalGather> local_gather{};
    std::optional<Roulette> roulette{};
};

/// What is the same for all bands and devices.
struct Picture {
    const View& view;
    const GatherSettings& settings;
    uint seed = 0;
    const RenderPlan& plan;
    const VplSet& vpls;  ///< on one device; every other one has the host's copy
};

class BandRenderer {
  public:
    /// Uploads the VPLs unless they are on this device. Refers to all of its arguments.
    BandRenderer(BandStages& stages, const DeviceScene& scene, const Picture& picture);

    /// Rows of all layers of band `index` of picture.plan; empty if cancelled.
    std::optional<FinishedBand> render(uint index, const BandProgress& progress);

  private:
    /// Device memory that all batches use in turn.
    struct BatchBuffers {
        BatchBuffers(Device& device, std::size_t packets, std::size_t pixels);

        Buffer<ReceiverPacket> receivers;
        Buffer<CameraVertex> vertices;
        Buffer<IrradiancePacket> direct;
        GatherSums<Vpl> indirect;
        Buffer<float> sums;
        Buffer<float> layers;
    };

    bool add_batch(const CameraBand& batch, uint row_count, const GatherProgress& progress);
    bool gather_indirect(const CameraBand& batch, const GatherProgress& progress);
    std::optional<VplSelection> select_vpls(const CameraBand& batch);
    [[nodiscard]] const VplBuffer& vpls() const;

    BandStages& stages_;
    const DeviceScene& scene_;
    const Picture& picture_;
    Buffer<PinholeCamera> camera_;
    Buffer<CloseRange> close_range_;
    VplBuffer own_vpls_;  ///< empty where the set itself is on this device
    BatchBuffers buffers_;
};

}  // namespace nearlight::core
