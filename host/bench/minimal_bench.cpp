// SPDX-License-Identifier: Apache-2.0
// nearlight-bench-minimal [TRIANGLES] [VPLS] [SIDE] needs nothing but a compiler and OpenCL. On every OpenCL
// device (or on those that $NEARLIGHT_DEVICE names) it compares both gather kernels with the host's traversal
// in a generated room, pair by pair, and times them. Then it renders a whole picture with every kernel.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "host/base/hash.h"
#include "host/base/median.h"
#include "host/base/message.h"
#include "host/base/receivers.h"
#include "host/base/stopwatch.h"
#include "host/bvh/bvh.h"
#include "host/reference/gather_workload.h"
#include "host/reference/synthetic_scene.h"
#include "host/session/render.h"
#include "host/stages/film_layers.h"
#include "host/stages/gatherer.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr float kClampRadius = 0.05f;
constexpr int kRepeats = 5;
constexpr std::size_t kCheckedVpls = 16;
/// Maximum fraction of rays that may differ, because both answers are right for rays that graze an edge. A
/// kernel with more differences is wrong.
constexpr double kMaxDisagreements = 1e-5;

struct Options {
    std::size_t triangles = 100'000;
    std::size_t vpls = 256;
    std::size_t side = 256;  ///< width and height of the receivers' picture, pixels
};

struct Workload {
    Scene scene;
    Bvh bvh;
    std::vector<Vpl> vpls;
    std::vector<ReceiverPacket> receivers;
};

Options parse(int argc, char** argv) {
    Options options;
    std::size_t* const values[] = {&options.triangles, &options.vpls, &options.side};
    if (argc > 4) {
        throw Error(ErrorKind::invalid_argument, "usage: nearlight-bench-minimal [TRIANGLES] [VPLS] [SIDE]");
    }
    for (int i = 1; i < argc; ++i) {
        const std::string_view text = argv[i];
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *values[i - 1]);
        if (error != std::errc() || end != text.data() + text.size() || *values[i - 1] == 0) {
            throw Error(ErrorKind::invalid_argument, "'" + std::string(text) + "' is not a positive number");
        }
    }
    return options;
}

Workload make_workload(const Options& options) {
    Workload work;
    work.scene = make_sphere_room(options.triangles);
    work.bvh = build_scene_bvh(work.scene);
    work.vpls = make_traced_vpls(work.scene, work.bvh, options.vpls);
    const int side = static_cast<int>(options.side);
    work.receivers = make_camera_receivers(work.scene, work.bvh, side, side);
    return work;
}

/// The input of a gather, on a device.
struct GatherJob {
    GatherJob(Device& device, const Workload& work, GatherKernel kernel, std::size_t vpl_count)
        : tree(upload_tree(device, work.bvh, kernel)),
          vpls(device, std::span(work.vpls).first(std::min(vpl_count, work.vpls.size()))),
          receivers(device, work.receivers),
          sums(device, work.receivers.size()) {}

    [[nodiscard]] GatherInput<Vpl> input() const {
        return {tree, vpls, vpls.count(), receivers, receivers.count(), kClampRadius};
    }

    DeviceTree tree;
    Buffer<Vpl> vpls;
    Buffer<ReceiverPacket> receivers;
    GatherSums<Vpl> sums;
};

/// Whether the kernel's visibility is that of the host's traversal.
bool check_pairs(Device& device, const Workload& work, Gatherer& gatherer) {
    GatherJob job(device, work, gatherer.kernel(), kCheckedVpls);
    const std::vector<GatherPair> pairs = gatherer.gather_recorded(job.input(), job.sums);
    std::size_t rays = 0;
    std::size_t blocked = 0;
    std::size_t disagreements = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (pairs[i] == GatherPair::culled) {
            continue;
        }
        const Vpl& vpl = work.vpls[i / NEARLIGHT_PACKET_SIZE % job.vpls.count()];
        const ReceiverPacket& packet = work.receivers[i / NEARLIGHT_PACKET_SIZE / job.vpls.count()];
        const Vec3 receiver = receiver_at(packet, i % NEARLIGHT_PACKET_SIZE).position;
        const bool expected = occluded(work.bvh, vpl.position, receiver - vpl.position,
                                       NEARLIGHT_SEGMENT_T_MIN, NEARLIGHT_SEGMENT_T_MAX);
        ++rays;
        blocked += expected ? 1 : 0;
        disagreements += expected != (pairs[i] == GatherPair::occluded) ? 1 : 0;
    }
    const bool good =
        rays > 0 && static_cast<double>(disagreements) <= kMaxDisagreements * static_cast<double>(rays);
    std::printf("  %s: %zu rays, %zu blocked, %zu differ from the host's traversal\n",
                good ? "agrees" : "DISAGREES", rays, blocked, disagreements);
    return good;
}

void time_gather(Device& device, const Workload& work, Gatherer& gatherer) {
    GatherJob job(device, work, gatherer.kernel(), work.vpls.size());
    std::vector<double> seconds;
    for (int i = 0; i <= kRepeats; ++i) {
        const Stopwatch watch;
        gatherer.gather(job.input(), job.sums);
        device.finish();
        seconds.push_back(watch.seconds());
    }
    seconds.erase(seconds.begin());  // the first run warms up
    const double pairs =
        static_cast<double>(work.receivers.size() * NEARLIGHT_PACKET_SIZE * job.vpls.count());
    const double middle = median(seconds);
    std::printf("  %.3f s for %.1f M pairs: %.1f M pairs/s (median of %d)\n", middle, pairs * 1e-6,
                pairs / middle * 1e-6, kRepeats);
}

/// Renders a picture, and checks that every pixel is finite and that not all are black.
bool check_picture(Device& device, const Workload& work, SamplerKind sampler) {
    const RenderSettings settings{.view = {.width = 128, .height = 128}, .sampling = {.sampler = sampler}};
    double sum = 0.0;
    bool finite = true;
    const auto take_rows = [&](std::span<const float> rows) {
        for (std::size_t i = 0; i < rows.size(); i += NEARLIGHT_LAYER_CHANNELS) {
            for (const float value : rows.subspan(i + NEARLIGHT_LAYER_BEAUTY, NEARLIGHT_CHANNELS_RGB)) {
                finite = finite && std::isfinite(value) && value >= 0.0f;
                sum += value;
            }
        }
    };
    Session session(device, work.scene);
    const RenderReport report = render(session, settings, {.rows = take_rows});
    const bool good = finite && sum > 0.0;
    std::printf("picture by %s: %s, %zu close and %zu distant VPLs, %.2f s, mean %.5f, hash %s\n",
                to_string(sampler).c_str(), good ? "good" : "BAD", report.totals.close_vpls,
                report.totals.distant_vpls, report.seconds.total, sum / (3.0 * 128 * 128),
                hex_digits(report.image_hash).c_str());
    return good;
}

bool run_on(const DeviceEntry& entry, const Workload& work) {
    Device device(entry, {.kernel_dir = {}, .cache_dir = "none"});
    std::printf("device %d: %s (%s), driver %s\n", entry.index, entry.name.c_str(), entry.platform.c_str(),
                entry.driver.c_str());
    bool good = true;
    for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
        std::printf("gather kernel %s\n", to_string(kernel));
        Gatherer gatherer(device, {.kernel = kernel});
        good = check_pairs(device, work, gatherer) && good;
        time_gather(device, work, gatherer);
    }
    for (const SamplerEntry& sampler : all_samplers()) {
        good = check_picture(device, work, sampler.kind) && good;
    }
    return good;
}

int run(const Options& options) {
    const char* const chosen = std::getenv("NEARLIGHT_DEVICE");
    const std::vector<DeviceEntry> devices =
        choose_devices(list_devices(), chosen == nullptr ? "all" : chosen);
    const Workload work = make_workload(options);
    std::printf("%zu triangles, %zu VPLs, %zu receivers\n", work.scene.triangles.size(), work.vpls.size(),
                work.receivers.size() * NEARLIGHT_PACKET_SIZE);
    bool good = true;
    for (const DeviceEntry& entry : devices) {
        good = run_on(entry, work) && good;
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace nearlight::core

int main(int argc, char** argv) {
    nearlight::core::set_message_sink([](nearlight::MessageLevel level, std::string_view text) {
        if (level != nearlight::MessageLevel::debug) {
            const char* const name = level == nearlight::MessageLevel::error ? "error" : "warning";
            std::fprintf(stderr, "%s: %.*s\n", name, static_cast<int>(text.size()), text.data());
        }
    });
    try {
        return nearlight::core::run(nearlight::core::parse(argc, argv));
    } catch (const nearlight::Error& error) {
        std::fprintf(stderr, "nearlight-bench-minimal: error: %s\n", error.what());
        return EXIT_FAILURE;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nearlight-bench-minimal: error: %s\n", error.what());
        return EXIT_FAILURE;
    }
}
