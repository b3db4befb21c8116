// SPDX-License-Identifier: Apache-2.0
// The light of receivers that VPLs do not bring: direct light, and by rays of the receivers all that a
// bounded gather of Lambertian reflection leaves out.
#pragma once

#include <limits>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "kernels/shared/shared_light.h"

namespace nearlight::core {

/// The most rays that a receiver aims at mirrors and glass.
inline constexpr uint kMaxAimedRays = 64;

struct ReceiverPathSettings {
    /// Samples that each receiver takes of area lights, the sun and the environment, at least 1. Points,
    /// spots, projectors and directional lights need none, unless there are more than
    /// NEARLIGHT_MAX_EXACT_LIGHTS of them: then they are sampled too.
    uint light_samples = 1;
    /// Rays of each receiver. With 0, only direct light is found.
    uint rays = 0;
    /// Rays of each receiver besides these that aim at mirrors and glass, where DeviceScene::caustic_aims has
    /// targets for it, at most kMaxAimedRays. They bring light of lamps over mirrors and glass alone.
    uint aimed_rays = 0;
    /// The maximum number of edges of a path from a light to a receiver that the camera sees without anything
    /// between: 1 is direct light. A receiver behind n mirrors or panes gets n edges less.
    uint max_edges = 1;
    /// The clamp radius R (m) of the gather whose missing light the rays supply. Lambertian reflection at the
    /// distance r has the weight max0(1 − r²/R²). Infinity counts all of it, 0 none.
    float clamp_radius = 0.0f;
    uint seed = 0;
    /// How much of the light that one path brings from a lamp which it met by chance run_sharing() leaves to
    /// `found`, as radiance of the place found (W/m²/sr). The excess stays with the receiver: a bundle would
    /// show it as a tile, where a receiver shows a dot.
    float shared_limit = std::numeric_limits<float>::max();
    bool shares_sky = false;          ///< whether run_sharing() leaves light of the sky to `found`
    bool shares_veiled = false;       ///< whether it leaves Lambertian light of places behind veils there
    bool shares_reflections = false;  ///< whether it leaves light there that rough gloss reflects
};

/// Receivers on a scene, the first `packet_count` packets, and how their paths go.
struct ReceiverBatch {
    const DeviceScene& scene;
    const Buffer<ReceiverPacket>& receivers;
    std::size_t packet_count;
    ReceiverPathSettings settings;
};

/// The lights that receivers find and share with their bundles: one of each kind for each receiver.
struct FoundLights {
    /// Makes room for those that run_sharing() leaves with such settings.
    FoundLights(Device& device, std::size_t packet_count, const ReceiverPathSettings& settings);

    Buffer<SharedLight> near;  ///< places within the clamp radius
    Buffer<SharedLight> sky;
    Buffer<SharedLight> veiled;            ///< places behind veils
    Buffer<SharedLight> reflected;         ///< places with gloss, and the radiance that arrives there
    Buffer<SharedReflection> reflections;  ///< their surfaces
    Buffer<float> spacing;                 ///< radius (m) of the neighbourhood of each receiver
};

/// The squared errors of receivers by light that lamps send over mirrors and glass: squared W/m², summed over
/// the channels, one of each kind for each receiver.
struct CausticErrors {
    std::vector<float> unaimed;  ///< without rays that aim there
    std::vector<float> aimed;    ///< with them
};

class ReceiverPaths {
  public:
    explicit ReceiverPaths(Device& device);

    /// Writes the irradiance (W/m²) of each receiver: `direct` gets what comes straight from lights, and
    /// `indirect` what rays bring over other surfaces.
    void run(const ReceiverBatch& batch, Buffer<IrradiancePacket>& direct,
             Buffer<IrradiancePacket>& indirect);

    /// As run(), except for the Lambertian light of places within the clamp radius, and for other kinds of
    /// light if the settings say so. Where a receiver may share what it finds of these with others
    /// (kernels/lib/shared_light.cl), not `indirect` and `direct` but `found` gets it, and SharedLights,
    /// SharedSky, SharedVeiled and SharedReflections bring it to all of the bundle. The clamp radius must be
    /// finite.
    void run_sharing(const ReceiverBatch& batch, Buffer<IrradiancePacket>& direct,
                     Buffer<IrradiancePacket>& indirect, FoundLights& found);

    /// Estimates the errors of the batch's receivers if they do not aim and if they do, by
    /// NEARLIGHT_CAUSTIC_ERROR_RAYS rays of each. The settings must have rays of both kinds.
    [[nodiscard]] CausticErrors caustic_errors(const ReceiverBatch& batch);

  private:
    void launch(const ReceiverBatch& batch, uint kinds, Buffer<IrradiancePacket>& direct,
                Buffer<IrradiancePacket>& indirect, FoundLights& found);

    Program program_;
    Kernel receiver_paths_;
    Kernel receiver_spacing_;
    Kernel caustic_errors_;
    FoundLights none_found_;
};

}  // namespace nearlight::core
