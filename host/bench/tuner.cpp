// SPDX-License-Identifier: Apache-2.0
#include "host/bench/tuner.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "host/base/hash.h"
#include "host/base/random.h"
#include "host/bench/gather_segments.h"
#include "host/reference/synthetic_scene.h"
#include "host/session/session.h"
#include "host/stages/camera_pass.h"
#include "host/stages/gatherer.h"
#include "host/stages/morton_sort.h"
#include "host/stages/receiver_paths.h"

namespace nearlight::core {
namespace {

/// Maximum time of a value that replaces the usual one, as a fraction of the usual one's time.
constexpr double kWorthIt = 0.97;

/// The work that is timed, and the hash of its result.
struct Work {
    std::function<void()> run;
    std::function<std::uint64_t()> hash;
};

/// One tunable, and the work whose time depends on it.
struct Trial {
    std::uint32_t Tunables::*value;
    std::string measured_by;
    /// Whether processor time decides. It is more reliable than the wall clock on a machine with other load,
    /// but does not show how evenly work is divided.
    bool by_processor;
    std::uint32_t min, max;           ///< all powers of two between them are tried
    std::function<Work()> make_work;  ///< called with the device set to the value that is tried
};

template <typename T>
std::uint64_t hash_of(const Buffer<T>& buffer) {
    const std::vector<T> values = buffer.download();
    return hash64(std::as_bytes(std::span(values)));
}

/// The generated room, on the host and on the device.
struct Room {
    Room(Device& device, const TunerConfig& config)
        : scene(make_sphere_room(config.triangles)),
          session(device, scene, {.bvh_quality = BvhQuality::fast}),
          view(session.look({.width = config.size, .height = config.size}, 0)),
          segments(make_camera_segments(scene, build_scene_bvh(scene), config.vpl_count, config.size,
                                        config.size)) {}
    Scene scene;
    Session session;
    View view;
    GatherSegments segments;
};

Work gather_work(Device& device, const Room& room) {
    struct State {
        State(Device& on, const Room& of)
            : gatherer(on),
              vpls(on, of.segments.vpls),
              receivers(on, of.segments.receivers),
              sums(on, of.segments.receivers.size()) {}
        Gatherer gatherer;
        Buffer<Vpl> vpls;
        Buffer<ReceiverPacket> receivers;
        GatherSums<Vpl> sums;
    };
    const auto state = std::make_shared<State>(device, room);
    return {[state, &room] {
                state->gatherer.gather(
                    {room.session.device_scene().tree, state->vpls, state->vpls.count(), state->receivers,
                     state->receivers.count(), room.segments.clamp_radius},
                    state->sums);
            },
            [state] { return hash_of(state->sums.light); }};
}

/// The kernels that trace rays from the camera and to the lights.
Work picture_work(Device& device, const Room& room) {
    struct State {
        State(Device& on, const Room& of)
            : camera_pass(on),
              receiver_paths(on),
              camera(on, std::span(&of.view.camera, 1)),
              close_range(on, std::span(&of.view.close_range, 1)),
              batch{.tile_row_count = tiles_across(of.view.camera.height)},
              packets(packet_count(batch, of.view.camera.width)),
              receivers(on, packets),
              vertices(on, packets * NEARLIGHT_PACKET_SIZE),
              direct(on, packets),
              indirect(on, packets) {}
        CameraPass camera_pass;
        ReceiverPaths receiver_paths;
        Buffer<Camera> camera;
        Buffer<CloseRange> close_range;
        CameraBatch batch;
        std::size_t packets;
        Buffer<ReceiverPacket> receivers;
        Buffer<CameraVertex> vertices;
        Buffer<IrradiancePacket> direct, indirect;
    };
    const auto state = std::make_shared<State>(device, room);
    return {
        [state, &room] {
            State& s = *state;
            const DeviceScene& scene = room.session.device_scene();
            s.camera_pass.run({scene, s.camera, room.view.camera.width, s.close_range, s.batch, 1},
                              {s.receivers, s.vertices});
            s.receiver_paths.run(
                {scene, s.receivers, s.packets, {.light_samples = 4, .rays = 1, .max_edges = 3, .seed = 1}},
                s.direct, s.indirect);
        },
        [state] { return hash_of(state->direct); }};
}

Work sort_work(Device& device, std::size_t count) {
    struct State {
        State(Device& on, std::size_t n) : sort(on), numbers(n), keys(on, n), values(on, n) {
            Pcg32 random(1);
            std::ranges::generate(numbers, [&] { return random.next(); });
        }
        MortonSort sort;
        std::vector<uint> numbers;
        Buffer<uint> keys, values;
    };
    const auto state = std::make_shared<State>(device, count);
    return {[state] {
                state->keys.upload(state->numbers);
                state->values.upload(state->numbers);
                state->sort.sort(state->keys, state->values, state->numbers.size());
            },
            [state] { return hash_of(state->keys); }};
}

std::vector<Trial> make_trials(Device& device, const Room& room, const TunerConfig& config) {
    const bool cpu = device.is_cpu();
    std::vector<Trial> trials;
    const auto picture = [&] { return picture_work(device, room); };
    const auto gather = [&] { return gather_work(device, room); };
    if (choose_kernel(GatherKernel::automatic, device) == GatherKernel::packets) {
        trials.push_back({&Tunables::beam_width, "gather", cpu, 16, 256, gather});
        trials.push_back({&Tunables::local_size, "camera pass and direct light", cpu, 1, 64, picture});
    } else {
        trials.push_back({&Tunables::local_size, "gather", cpu, 32, 256, gather});
    }
    trials.push_back({&Tunables::runs_per_unit, "radix sort", false, cpu ? 1u : 16u, cpu ? 16u : 512u,
                      [&device, count = config.sort_count] { return sort_work(device, count); }});
    return trials;
}

/// A value that is tried, with its work and its times.
struct Runner {
    Tunables tunables{};
    Work work;
    std::vector<Seconds> runs;
};

Seconds timed(Device& device, const Runner& runner) {
    device.set_tunables(runner.tunables);
    const TwoClocks clocks(TwoClocks::Of::process);
    runner.work.run();
    device.finish();
    return clocks.seconds();
}

/// Runners for all values. The runner of a value that the device refuses has no work.
std::vector<Runner> make_runners(Device& device, const Trial& trial, const Tunables& base,
                                 std::vector<TriedValue>& tried) {
    std::vector<Runner> runners;
    for (TriedValue& one : tried) {
        Runner runner{.tunables = base, .work = {}, .runs = {}};
        runner.tunables.*trial.value = one.value;
        try {
            device.set_tunables(runner.tunables);
            runner.work = trial.make_work();
            timed(device, runner);  // compiles and warms up
        } catch (const Error& error) {
            one.failed_because = error.what();
            runner.work = {};
        }
        runners.push_back(std::move(runner));
    }
    return runners;
}

void check_results(const Trial& trial, std::span<const Runner> runners) {
    std::optional<std::uint64_t> first;
    for (const Runner& runner : runners) {
        if (!runner.work.run) {
            continue;
        }
        const std::uint64_t hash = runner.work.hash();
        if (hash != first.value_or(hash)) {
            throw Error(ErrorKind::failure,
                        "the result of the " + trial.measured_by +
                            " depends on a tunable, which it must not: please report this");
        }
        first = hash;
    }
}

std::vector<TriedValue> values_to_try(const Trial& trial, std::uint32_t usual) {
    std::vector<TriedValue> tried{{.value = usual}};
    for (std::uint32_t value = trial.min; value <= trial.max; value *= 2) {
        if (value != usual) {
            tried.push_back({.value = value});
        }
    }
    std::ranges::sort(tried, {}, &TriedValue::value);
    return tried;
}

/// Fills in the figures and returns the fastest value.
std::uint32_t decide(const Trial& trial, std::span<const Runner> runners, std::uint32_t usual,
                     std::vector<TriedValue>& tried) {
    const auto of_usual =
        static_cast<std::size_t>(std::ranges::find(tried, usual, &TriedValue::value) - tried.begin());
    const auto clock = trial.by_processor ? &Seconds::processor : &Seconds::wall;
    std::uint32_t best = usual;
    double best_ratio = kWorthIt;
    for (std::size_t i = 0; i < tried.size(); ++i) {
        TriedValue& one = tried[i];
        const std::vector<Seconds>& runs = runners[i].runs;
        if (runs.empty() || runners[of_usual].runs.empty()) {
            continue;
        }
        one.median = medians(runs);
        one.to_usual = ratio(runs, runners[of_usual].runs, clock);
        const double surely = one.to_usual.median + 2.0 * one.to_usual.deviation;
        if (one.value != usual && surely < 1.0 && one.to_usual.median < best_ratio) {
            best = one.value;
            best_ratio = one.to_usual.median;
        }
    }
    return best;
}

TunerTrial run_trial(Device& device, const Trial& trial, const Tunables& base, int repeats) {
    TunerTrial result{.tunable = {},
                      .measured_by = trial.measured_by,
                      .by_processor = trial.by_processor,
                      .usual = base.*trial.value,
                      .tried = values_to_try(trial, base.*trial.value)};
    result.tunable = std::ranges::find(tunable_fields(), trial.value, &TunableField::value)->name;
    std::vector<Runner> runners = make_runners(device, trial, base, result.tried);
    check_results(trial, runners);
    for (int repeat = 0; repeat < repeats; ++repeat) {
        for (Runner& runner : runners) {
            if (runner.work.run) {
                runner.runs.push_back(timed(device, runner));
            }
        }
    }
    result.chosen = decide(trial, runners, result.usual, result.tried);
    return result;
}

}  // namespace

TunerResult tune(Device& device, const TunerConfig& config) {
    TunerResult result;
    result.device = device.entry().label();
    result.usual = result.chosen = tunables_row(device.entry().kind).values;
    result.kernels = {"gather_packets.cl", "gather_rays.cl", "camera_pass.cl",
                      "receiver_paths.cl", "morton_sort.cl", "prefix_scan.cl"};
    device.set_tunables(result.usual);
    const Room room(device, config);
    for (const Trial& trial : make_trials(device, room, config)) {
        result.trials.push_back(run_trial(device, trial, result.chosen, config.repeats));
        result.chosen.*trial.value = result.trials.back().chosen;
        device.set_tunables(result.chosen);
    }
    return result;
}

}  // namespace nearlight::core
