// SPDX-License-Identifier: Apache-2.0
// Renders one device's bands of a picture, from the camera to finished rows.
#pragma once

#include <optional>
#include <type_traits>

#include "host/samplers/sampler.h"
#include "host/session/band_sharing.h"
#include "host/session/camera_refinement.h"
#include "host/session/local_gather.h"
#include "host/session/plan.h"
#include "host/stages/camera_pass.h"
#include "host/stages/film.h"
#include "host/stages/gatherer.h"
#include "host/stages/light_cuts.h"
#include "host/stages/receiver_paths.h"
#include "host/stages/roulette.h"
#include "host/stages/shared_lights.h"
#include "host/stages/shared_reflections.h"
#include "host/stages/shared_sky.h"
#include "host/stages/shared_veiled.h"
#include "host/stages/splats.h"

namespace nearlight::core {

/// The stages that make a band. Construction begins to compile them.
struct BandStages {
    BandStages(Device& on_device, GatherKernel gather_kernel)
        : device(on_device),
          camera_pass(device),
          receiver_paths(device),
          shared_light_lists(device, gather_kernel),
          shared_lights(device),
          gatherer(device, {.kernel = gather_kernel}),
          film(device) {}

    /// Makes the stages that only some scenes need, if `scene` does.
    void expect(const DeviceScene& scene);

    Device& device;
    CameraPass camera_pass;
    ReceiverPaths receiver_paths;
    SharedLightLists shared_light_lists;
    SharedLights shared_lights;
    Gatherer gatherer;
    Film film;
    // expect() makes these stages.
    std::optional<SharedSky> shared_sky{};
    std::optional<SharedVeiled> shared_veiled{};
    std::optional<SharedReflections> shared_reflections{};
    // These stages are made when they are first needed.
    std::optional<LocalGather> local_gather{};
    std::optional<Roulette> roulette{};
    std::optional<LightCuts> light_cuts{};
    std::optional<RefinementStages> refinement{};
    std::optional<Splats> splats{};
};

/// What, besides the scene and the VPLs, all bands of a picture have in common. It consists of plain numbers,
/// so that its bytes can be sent to another process of the same program.
struct PictureTask {
    Camera camera{};
    CloseRange close_range{};
    uint max_depth = 0;  ///< maximum path length, as Mitsuba counts it
    GatherSettings settings{};
    RayBudget budget{};
    uint seed = 0;
    RenderPlan plan{};
    std::size_t asked_count = 0;            ///< VplSet::asked_count
    std::optional<LocalLightPlan> local{};  ///< VplSet::local
    bool shares_sky = false;                ///< whether bundles share light of the sky
};
static_assert(std::is_trivially_copyable_v<PictureTask>);

class BandRenderer {
  public:
    /// Uploads the VPLs unless they are on this device; they must be on the host too if several devices make
    /// the picture. The stages must expect the scene. Keeps references to all of its arguments.
    BandRenderer(BandStages& stages, const DeviceScene& scene, const PictureTask& picture,
                 const VplBuffer& vpls);

    /// Renders the rows of band `index` of picture.plan, with all layers and splats (splat_rows.h). Returns
    /// nothing if cancelled.
    std::optional<FinishedBand> render(uint index, const WorkProgress& progress);

  private:
    /// Device memory that all batches use one after the other.
    struct BatchBuffers {
        BatchBuffers(Device& device, std::size_t packets, std::size_t pixels,
                     const ReceiverPathSettings& paths, uint reach);

        Buffer<ReceiverPacket> receivers;
        Buffer<CameraVertex> vertices;
        Buffer<SeenSurface> seen;  ///< as many as vertices where bundles share light of the sky, else none
        Buffer<IrradiancePacket> direct;
        Buffer<IrradiancePacket> indirect;
        FoundLights found;
        GatherSums<Vpl> gathered;
        Buffer<float> sums;
        Buffer<float> layers;
        // Both have no elements where samples count in their own pixel alone.
        Buffer<Splat> splats;
        Buffer<RowSplat> row_splats;
    };

    [[nodiscard]] uint reach() const { return picture_.camera.splat_reach; }
    [[nodiscard]] SplatPixels splat_pixels(uint row_count) const;
    void trace_receivers(std::size_t packets);
    void trace_sharing_receivers(std::size_t packets);
    [[nodiscard]] CameraPassInput camera_input(const CameraBatch& batch) const;
    CameraPassOutput camera_output();
    bool add_batch(const CameraBatch& batch, uint row_count, const GatherProgress& progress);
    void add_to_film(const CameraBatch& batch, uint row_count);
    bool refine(const CameraBatch& batch, const WorkProgress& progress);
    std::vector<float> finished_rows(uint row_count);
    bool gather_vpls(const CameraBatch& batch, const GatherProgress& progress);
    std::optional<VplSelection> select_vpls(std::size_t packets, const VplStrata& strata);
    [[nodiscard]] const VplBuffer& vpls() const;

    BandStages& stages_;
    const DeviceScene& scene_;
    const PictureTask& picture_;
    const VplBuffer& given_vpls_;
    Buffer<Camera> camera_;
    Buffer<CloseRange> close_range_;
    VplBuffer own_vpls_;               ///< empty if given_vpls_ are on this device
    std::optional<CutTree> cut_tree_;  ///< over the VPLs, if bundles ask cuts
    ReceiverPathSettings paths_;
    BatchBuffers buffers_;
    std::optional<CameraRefinement> refinement_;  ///< empty if no pixel may get more camera paths
};

}  // namespace nearlight::core
