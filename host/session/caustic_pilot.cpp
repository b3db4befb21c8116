// SPDX-License-Identifier: Apache-2.0
#include "host/session/caustic_pilot.h"

#include <algorithm>
#include <string>
#include <vector>

#include "host/base/message.h"
#include "host/base/receivers.h"

namespace nearlight::core {
namespace {

constexpr uint kSeeds = 6;
/// About as many as the samples of a pixel have.
constexpr uint kRays = 4;
/// Aimed rays pay if the variance is at most this part of that without them: they take time, and VPLs make
/// noise of their own.
constexpr double kMaxVariance = 0.6;

/// Sums over the seeds of what a receiver gets, and of the squares.
struct Moments {
    double sum = 0.0;
    double squares = 0.0;

    void add(double x) {
        sum += x;
        squares += x * x;
    }
    [[nodiscard]] double variance() const { return (squares - sum * sum / kSeeds) / (kSeeds - 1); }
};

/// The variance of what the rays of a receiver bring, summed over all receivers. Not relative to what each
/// receiver gets: where lamps are found by chance, a few seeds do not tell that.
double sum_of_variances(Device& device, ReceiverPaths& paths, const DeviceScene& scene, const PilotView& view,
                        ReceiverPathSettings settings, uint seed) {
    Buffer<IrradiancePacket> direct(device, view.packet_count);
    Buffer<IrradiancePacket> indirect(device, view.packet_count);
    std::vector<Moments> moments(std::size_t{view.packet_count} * NEARLIGHT_PACKET_SIZE);
    for (uint i = 0; i < kSeeds; ++i) {
        settings.seed = seed + i;
        paths.run({scene, view.receivers, view.packet_count, settings}, direct, indirect);
        const std::vector<IrradiancePacket> light = indirect.download();
        for (std::size_t receiver = 0; receiver < moments.size(); ++receiver) {
            moments[receiver].add(luminance(irradiance_at(light, receiver)));
        }
    }
    double sum = 0.0;
    for (const Moments& of_receiver : moments) {
        sum += of_receiver.variance();
    }
    return sum;
}

}  // namespace

bool caustic_aims_pay(Device& device, ReceiverPaths& paths, const DeviceScene& scene, const PilotView& view,
                      uint max_edges, uint seed) {
    if (scene.caustic_aims.table.size == 0 || view.packet_count == 0) {
        return false;
    }
    // The radius is so small that VPLs bring all Lambertian light.
    ReceiverPathSettings settings{.path_count = kRays, .max_edges = max_edges, .clamp_radius = 1e-6f};
    const double without = sum_of_variances(device, paths, scene, view, settings, seed);
    settings.aimed_count = 1;
    const double with = sum_of_variances(device, paths, scene, view, settings, seed);
    const bool pays = with < kMaxVariance * without;
    say_debug("rays that aim at mirrors and glass leave " + std::to_string(with / std::max(without, 1e-30)) +
              " of the variance: receivers " + (pays ? "aim" : "do not aim"));
    return pays;
}

}  // namespace nearlight::core
