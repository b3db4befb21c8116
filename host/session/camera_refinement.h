// SPDX-License-Identifier: Apache-2.0
// More camera paths for the pixels of a band where the light that these paths bring on their own varies most.
#pragma once

#include <functional>

#include "host/stages/camera_lights.h"
#include "host/stages/compaction.h"
#include "host/stages/splats.h"

namespace nearlight::core {

/// The stages that refine a band, besides the camera pass.
struct RefinementStages {
    explicit RefinementStages(Device& device) : camera_lights(device), compaction(device) {}

    CameraLights camera_lights;
    Compaction compaction;
};

/// With fewer samples a pixel, their variance is too uncertain to choose by.
inline constexpr uint kMinRefinedSamples = 4;

/// Whether pixels may get more camera paths than others.
inline bool may_refine(const GatherSettings& settings) {
    return settings.refine && settings.samples_per_pixel >= kMinRefinedSamples;
}

/// How much a refinement has to do.
struct RefinementSize {
    std::size_t max_pixels = 0;   ///< of a band
    std::size_t max_packets = 0;  ///< of a batch
    uint sample_count = 0;        ///< of each pixel, at least kMinRefinedSamples
    uint splat_reach = 0;         ///< Camera::splat_reach
};

class CameraRefinement {
  public:
    /// Keeps references to the stages. `splat_stage` may be null if samples count in their own pixel alone.
    CameraRefinement(Device& device, RefinementStages& stages, Splats* splat_stage,
                     const RefinementSize& size);

    /// Starts a band, which has these pixels of the picture.
    void begin(const PixelWindow& pixels);
    /// Adds what the camera pass of a batch wrote. Must come before anything else changes the vertices.
    void add(const CameraBatch& batch, const Buffer<Camera>& camera, const Buffer<CameraVertex>& vertices);
    /// Launches the camera pass for the pixels that get more samples, and changes the band's sums of the
    /// film. `input` is that of one of the band's batches, and `output` has room for `max_packets`. Asks
    /// `goes_on` after every launch of the camera pass; returns false if that said no.
    bool finish(CameraPass& camera_pass, const CameraPassInput& input, const CameraPassOutput& output,
                Buffer<float>& sums, const std::function<bool()>& goes_on);

    /// The splats of the camera light of the band's pixels; null if samples count in their own pixel alone.
    [[nodiscard]] const Buffer<CameraSplat>* splats() const;

  private:
    bool add_round(CameraPass& camera_pass, CameraPassInput input, const CameraPassOutput& output,
                   const PixelList& list, uint times, const std::function<bool()>& goes_on);

    Device* device_;
    RefinementStages* stages_;
    Splats* splat_stage_;
    RefinementSize size_;
    PixelWindow pixels_{};
    Buffer<CameraLight> lights_;
    Buffer<CameraLight> added_;  ///< what a round brings to the pixels of one list
    Buffer<uint> rounds_;        ///< that each pixel still gets
    Buffer<uint> listed_;        ///< numbers of the pixels that get the next round
    // Both are empty if samples count in their own pixel alone.
    Buffer<CameraSplat> splats_;
    Buffer<CameraSplat> added_splats_;  ///< like added_
};

}  // namespace nearlight::core
