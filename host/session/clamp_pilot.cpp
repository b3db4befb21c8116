// SPDX-License-Identifier: Apache-2.0
#include "host/session/clamp_pilot.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "host/base/message.h"
#include "host/base/receivers.h"

namespace nearlight::core {
namespace {

/// Candidates, as multiples of the radius that the pilot starts from. The first must be 1.
constexpr std::array kRadiusMultiples{1.0f, 0.25f, 0.5f, 2.0f, 4.0f};
constexpr std::array<uint, 2> kRaySeeds{0x0c1a3bu, 0x7e57edu};
constexpr double kDarkPart = 0.01;  ///< of the mean light, squared: errors in the dark count less
/// No receiver's relative error counts as more. A single ray that met a lamp's reflection would otherwise
/// decide for the whole picture.
constexpr double kMaxRelativeError = 0.2;

using Packets = std::vector<IrradiancePacket>;

/// The light that reaches the pilot's receivers, and how its estimate varies, for one candidate.
struct PilotLight {
    Packets direct;
    std::array<Packets, 2> rays;  ///< indirect light that one ray brings, for each of kRaySeeds
    Packets vpls;                 ///< sum of what VPLs bring
    Packets vpl_squares;          ///< sum of the squares of what each VPL brings
};

PilotLight light_of(const ClampPilot& pilot, float radius) {
    Device& device = pilot.stages.device;
    const std::size_t packets = pilot.view.packet_count;
    PilotLight light;
    Buffer<IrradiancePacket> direct(device, packets);
    Buffer<IrradiancePacket> indirect(device, packets);
    for (std::size_t i = 0; i < kRaySeeds.size(); ++i) {
        pilot.stages.receiver_paths.run(pilot.scene, pilot.view.receivers, packets,
                                        {.light_samples = 1,
                                         .path_count = 1,
                                         .max_edges = pilot.max_edges,
                                         .clamp_radius = radius,
                                         .seed = pilot.seed ^ kRaySeeds[i]},
                                        direct, indirect);
        light.rays[i] = indirect.download();
    }
    light.direct = direct.download();
    GatherSums<Vpl> sums(device, packets, 1);
    pilot.stages.gatherer.gather<Vpl>({.tree = pilot.scene.tree,
                                       .vpls = pilot.vpls.buffer(),
                                       .vpl_count = pilot.vpls.count(),
                                       .receivers = pilot.view.receivers,
                                       .packet_count = packets,
                                       .clamp_radius = radius,
                                       .group_size = static_cast<uint>(pilot.vpls.count()),
                                       .curves = pilot.scene.curves_in_use()},
                                      sums);
    light.vpls = sums.groups.download();
    light.vpl_squares = sums.squares.download();
    return light;
}

double sum_of(Vec3 v) {
    return double{v.x} + v.y + v.z;
}

/// All light of each receiver, estimated with one candidate.
std::vector<double> light_by_receiver(const PilotLight& light) {
    std::vector<double> sums(light.direct.size() * NEARLIGHT_PACKET_SIZE);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] = sum_of(irradiance_at(light.direct, i)) + sum_of(irradiance_at(light.vpls, i)) +
                  0.5 * (sum_of(irradiance_at(light.rays[0], i)) + sum_of(irradiance_at(light.rays[1], i)));
    }
    return sums;
}

/// The sum over receivers of the squared error, relative to the square of each receiver's light, as far as it
/// counts.
double relative_error(const PilotLight& light, const std::vector<double>& all_light, uint rays_per_pixel) {
    double mean = 0.0;
    for (const double one : all_light) {
        mean += one / static_cast<double>(all_light.size());
    }
    double error = 0.0;
    for (std::size_t i = 0; i < all_light.size(); ++i) {
        const Vec3 change = irradiance_at(light.rays[0], i) - irradiance_at(light.rays[1], i);
        const double of_rays = 0.5 * dot(change, change) / rays_per_pixel;
        const double of_vpls = sum_of(irradiance_at(light.vpl_squares, i));
        const double square = all_light[i] * all_light[i] + kDarkPart * mean * mean + 1e-30;
        error += std::min((of_rays + of_vpls) / square, kMaxRelativeError);
    }
    return error;
}

}  // namespace

float choose_clamp_radius(const ClampPilot& pilot, float radius) {
    std::vector<double> all_light;
    float best_radius = radius;
    double least_error = 0.0;
    for (const float multiple : kRadiusMultiples) {
        const PilotLight light = light_of(pilot, multiple * radius);
        if (all_light.empty()) {
            all_light = light_by_receiver(light);
        }
        const double error = relative_error(light, all_light, pilot.rays_per_pixel);
        say_debug("clamp radius " + std::to_string(multiple * radius) + ": expected error " +
                  std::to_string(error / static_cast<double>(all_light.size())));
        if (multiple == kRadiusMultiples.front() || error < least_error) {
            least_error = error;
            best_radius = multiple * radius;
        }
    }
    return best_radius;
}

}  // namespace nearlight::core
