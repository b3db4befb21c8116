// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_trace.h"

#include <algorithm>

#include "host/bench/trace_bench.h"
#include "host/cli/bench_scene.h"
#include "host/cli/device_options.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/scene_options.h"

namespace nearlight::core {
namespace {

struct BenchTraceOptions {
    SceneOptions scene;
    ImageSize size{512, 512};
    TraceBenchConfig config;
    DeviceChoice device;
};

double mega_rays_per_second(const RaySetResult& set, const RayTracerFigures& tracer) {
    return 1e-6 * static_cast<double>(set.rays) / tracer.median.wall;
}

nlohmann::ordered_json to_json(const RaySetResult& set) {
    nlohmann::ordered_json tracers = nlohmann::ordered_json::array();
    for (const RayTracerFigures& tracer : set.tracers) {
        tracers.push_back({{"tracer", tracer.name},
                           {"mrays_per_second", mega_rays_per_second(set, tracer)},
                           {"seconds", tracer.median.wall},
                           {"processor_seconds", tracer.median.processor},
                           {"differ", tracer.differing}});
    }
    return {{"rays", set.name},
            {"count", set.rays},
            {"hits", set.hits},
            {"tracers", tracers},
            {"best_of_embree", set.best},
            {"ratio", set.ratio},
            {"ratio_processor", set.ratio_processor},
            {"agrees", set.agrees}};
}

nlohmann::ordered_json to_json(const Scene& scene, const TraceBenchResult& result) {
    nlohmann::ordered_json json{
        {"scene", scene.name}, {"device", result.device}, {"triangles", result.triangles}};
    for (const RaySetResult& set : result.sets) {
        json["sets"].push_back(to_json(set));
    }
    return json;
}

std::string to_text(const RaySetResult& set) {
    std::string text = fmt::format("\n{}: {:.2f} M rays, {:.0f} % of them hit\n{:>10} {:>12} {:>8}\n",
                                   set.name, 1e-6 * static_cast<double>(set.rays),
                                   100.0 * static_cast<double>(set.hits) / static_cast<double>(set.rays),
                                   "Mrays/s", "processor s", "differ");
    for (const RayTracerFigures& tracer : set.tracers) {
        text += fmt::format("{:>10.2f} {:>12.3f} {:>8}  {}\n", mega_rays_per_second(set, tracer),
                            tracer.median.processor, tracer.differing, tracer.name);
    }
    text += fmt::format("nearlight {:.2f} times as fast as {}", set.ratio, set.best);
    if (set.ratio_processor > 0.0) {
        text += fmt::format(", {:.2f} by processor time", set.ratio_processor);
    }
    return text + (set.agrees ? "\n" : "; ITS HITS DIFFER FROM EMBREE'S\n");
}

std::string to_text(const Scene& scene, const TraceBenchResult& result) {
    std::string text =
        fmt::format("{}: {} triangles, device {}\n", scene.name, result.triangles, result.device);
    for (const RaySetResult& set : result.sets) {
        text += to_text(set);
    }
    return text +
           "\nMedians of interleaved runs, for closest hits. Embree's time is only that inside its calls.\n";
}

ExitCode run_bench_trace(const BenchTraceOptions& options, const GlobalOptions& global) {
    const DeviceChoice choice = with_compile_workers(options.device);
    const Scene scene = make_bench_scene(options.scene);
    const std::unique_ptr<Device> device = open_device(choice);
    TraceBenchConfig config = options.config;
    config.width = options.size.width;
    config.height = options.size.height;
    const TraceBenchResult result = bench_trace(*device, scene, config);
    if (global.json) {
        print_json(to_json(scene, result));
    } else {
        print(to_text(scene, result));
    }
    const bool agree = std::ranges::all_of(result.sets, [](const RaySetResult& set) { return set.agrees; });
    return agree ? ExitCode::done : ExitCode::runtime;
}

}  // namespace

void add_bench_trace(CommandLine& line, CLI::App& group) {
    auto options = std::make_shared<BenchTraceOptions>();
    CLI::App& command =
        line.add_part(group, "trace", "Trace rays of the camera and of light walks, and compare with Embree",
                      [options](const GlobalOptions& global) { return run_bench_trace(*options, global); });
    add_bench_scene_options(command, options->scene);
    add_size_option(command, options->size)->default_str("512x512");
    command.add_option("--rays", options->config.walk_rays, "Number of rays of light walks")
        ->check(CLI::Range(1, 1 << 26))
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--repeats", options->config.repeats, "Number of runs; the median counts")
        ->check(CLI::Range(1, 1000))
        ->type_name("N")
        ->capture_default_str();
    add_device_options(command, options->device);
}

}  // namespace nearlight::core
