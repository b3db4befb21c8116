// SPDX-License-Identifier: Apache-2.0
// The oracle of shared lights, in double precision.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host/base/math.h"
#include "host/scene/scene.h"
#include "kernels/shared/shared_light.h"

namespace nearlight::core {

/// Bundles of receivers with a light for some of them, few enough for each bundle to use all of its lights.
/// Some receivers are absent, some do not share, and some surfaces have the transmission curve 1.
struct SharedLightCase {
    std::vector<ReceiverPacket> receivers;
    std::vector<SharedLight> found;  ///< one for each receiver
    float clamp_radius = 0.0f;
    uint max_edges = 8;
    uint rays_per_receiver = 3;
};

/// Makes the case of some receivers; lights lie at other receivers of the same bundle. `is_clear(a, b)` says
/// whether single precision is sure of what is between two points; lights for which it is not are left out.
SharedLightCase make_shared_lights(std::vector<ReceiverPacket> receivers, float clamp_radius,
                                   const std::function<bool(Vec3, Vec3)>& is_clear);

/// Irradiance of each receiver: Σ_j L_j·(1 − r²/R²)·G·V·T·T / p(j), p(j) = m/π · Σ_s G·V over the receivers s
/// of the bundle that share. `transmission` is T of the curve 1 by the cosine.
std::vector<Vec3> shared_irradiance(const SharedLightCase& data,
                                    const std::function<bool(Vec3, Vec3)>& is_visible,
                                    const std::function<double(double)>& transmission);

/// As make_shared_lights(), with lights on a sphere around the scene.
SharedLightCase make_shared_sky(std::vector<ReceiverPacket> receivers, Vec3 center, float radius,
                                const std::function<bool(Vec3, Vec3)>& is_clear);

/// Irradiance of each receiver from a sky of even radiance: Σ_j w·L·G·V·T / p(j), where w is the balance
/// heuristic of NEARLIGHT_SKY_RAYS · m rays of the bundle, m rays of the receiver and its light samples,
/// which are uniform over the sphere of directions. The other symbols are those of shared_irradiance().
std::vector<Vec3> shared_sky_irradiance(const SharedLightCase& data, Vec3 radiance, uint light_samples,
                                        const std::function<bool(Vec3, Vec3)>& is_visible,
                                        const std::function<double(double)>& transmission);

/// The veils between a light and a receiver, and the part of light that they let through.
struct VeilsBetween {
    uint count;
    double part;
};
using VeilsOracle = std::function<VeilsBetween(Vec3 from, Vec3 to)>;

/// As make_shared_lights(), with lights at receivers of all bundles. Each has the number of veils that stand
/// before the receiver which found it.
SharedLightCase make_veiled_lights(std::vector<ReceiverPacket> receivers, const VeilsOracle& veils,
                                   const std::function<bool(Vec3, Vec3)>& is_clear);

/// Irradiance of each receiver: Σ_j L_j·P·G·V·T·T / p(j), p(j) = m/π · Σ_s G·V, over the receivers s of the
/// bundle that share and that as many veils hide as SharedLight::veils says. P is the part of light that they
/// let through, and the other symbols are those of shared_irradiance(). `is_visible` looks past veils.
std::vector<Vec3> veiled_irradiance(const SharedLightCase& data,
                                    const std::function<bool(Vec3, Vec3)>& is_visible,
                                    const VeilsOracle& veils,
                                    const std::function<double(double)>& transmission);

/// Lights of a case as reflections: radiance arrives at their places, on surfaces with gloss.
struct SharedReflectionCase {
    SharedLightCase lights;
    std::vector<SharedReflection> reflections;  ///< one for each receiver
    std::vector<float> spacing;                 ///< radius (m) of the neighbourhood of each receiver
};

/// As make_shared_lights(), with lights that arrive at the fronts of triangles of the scene. Some of them are
/// delta lights.
SharedReflectionCase make_shared_reflections(std::vector<ReceiverPacket> receivers, const Scene& scene,
                                             const std::function<bool(Vec3, Vec3)>& is_clear);

/// Irradiance of each receiver: Σ_j L_j·S·|cosω|·G·V·T / p(j), p(j) = m/π · Σ_s G·V·(p_L + p_S) over the
/// receivers s of the bundle that share light of j. The materials of the scene have microfacets.
std::vector<Vec3> reflected_irradiance(const SharedReflectionCase& data, const Scene& scene,
                                       const std::function<bool(Vec3, Vec3)>& is_visible,
                                       const std::function<double(double)>& transmission);

}  // namespace nearlight::core
