// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_gather.h"

#include <optional>

#include "host/bench/gather_bench.h"
#include "host/bench/segment_file.h"
#include "host/cli/bench_gather_text.h"
#include "host/cli/bench_scene.h"
#include "host/cli/device_options.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/scene_options.h"

namespace nearlight::core {
namespace {

struct BenchGatherOptions {
    SceneOptions scene;
    std::filesystem::path dump;
    std::filesystem::path replay;
    DeviceChoice device;
    ImageSize size{512, 512};
    std::size_t vpls = 128;
    int repeats = 11;
    std::optional<GatherKernel> kernel;  ///< `automatic`: all that there are
    bool rendered = false;
    float roulette = 0.0f;
    BvhQuality bvh = BvhQuality::quality;
};

GatherSegments make_segments(const BenchGatherOptions& options, Device& device) {
    if (!options.replay.empty()) {
        return read_segments(options.replay);
    }
    const Scene scene = make_bench_scene(options.scene);
    const Bvh bvh = build_scene_bvh(scene, {.quality = options.bvh});
    const auto [width, height] = options.size;
    return options.rendered ? make_rendered_segments(device, scene, bvh, options.vpls, width, height)
                            : make_camera_segments(scene, bvh, options.vpls, width, height);
}

/// The kernels that take part. On a GPU, the kernel that is for CPUs takes minutes.
GatherKernel kernel_of(const BenchGatherOptions& options, const Device& device) {
    return options.kernel.value_or(device.is_cpu() ? GatherKernel::automatic : GatherKernel::rays);
}

nlohmann::ordered_json to_json(const Vec3& v) {
    return {v.x, v.y, v.z};
}

nlohmann::ordered_json to_json(const Disagreement& item) {
    return {{"tracer", item.tracer},
            {"packet", item.packet},
            {"lane", item.lane},
            {"vpl", item.vpl},
            {"from", to_json(item.from)},
            {"to", to_json(item.to)},
            {"about", item.is_culling ? "culling" : "occlusion"},
            {"tracer_says", item.tracer_says},
            {item.is_culling ? "least_cosine" : "edge_distance", item.distance},
            {"at_margin", item.is_at_margin},
            {"excused", item.excused}};
}

nlohmann::ordered_json to_json(const TracerFigures& tracer, std::uint64_t pairs) {
    return {{"tracer", tracer.name},
            {"rays", tracer.rays},
            {"occluded", tracer.occluded},
            {"disagreements", tracer.disagreements},
            {"wrong", tracer.is_wrong},
            {"seconds", tracer.median.wall},
            {"processor_seconds", tracer.median.processor},
            {"mpairs_per_second", millions(pairs) / tracer.median.wall},
            {"mrays_per_second", millions(tracer.rays) / tracer.median.wall}};
}

nlohmann::ordered_json to_json(const Ratio& ratio) {
    return {{"median", ratio.median}, {"deviation", ratio.deviation}};
}

nlohmann::ordered_json to_json(const std::string& name, BvhQuality bvh, const GatherBenchResult& result) {
    nlohmann::ordered_json json{{"segments", name},
                                {"triangles", result.triangles},
                                {"bvh", to_string(bvh)},
                                {"device", result.device},
                                {"pairs", result.pairs},
                                {"after_culling", result.after_culling},
                                {"rays_traced", result.tracers[result.ours].rays}};
    for (const TracerFigures& tracer : result.tracers) {
        json["tracers"].push_back(to_json(tracer, result.pairs));
    }
    json["fastest"] = {{"nearlight", result.tracers[result.ours].name},
                       {"embree1", result.tracers[result.embree1].name},
                       {"embree16", result.tracers[result.embree16].name}};
    json["ratio_embree1"] = to_json(result.wall1);
    json["ratio_embree16"] = to_json(result.wall16);
    if (result.processor16.median > 0.0) {
        json["processor_ratio_embree1"] = to_json(result.processor1);
        json["processor_ratio_embree16"] = to_json(result.processor16);
    }
    if (result.roulette) {
        json["ratio_roulette"] = to_json(result.wall_roulette);
        if (result.processor_roulette.median > 0.0) {
            json["processor_ratio_roulette"] = to_json(result.processor_roulette);
        }
    }
    json["edge_tolerance"] = result.edge_tolerance;
    json["disagreements"] = nlohmann::ordered_json::array();
    for (const Disagreement& item : result.disagreements) {
        json["disagreements"].push_back(to_json(item));
    }
    json["agrees"] = result.agrees;
    return json;
}

ExitCode run_bench_gather(const BenchGatherOptions& options, const GlobalOptions& global) {
    if (options.scene.file.empty() == options.replay.empty()) {
        throw Error(ErrorKind::invalid_argument,
                    "give either a SCENE, from which segments are made, or --replay FILE");
    }
    const std::unique_ptr<Device> device = open_device(with_compile_workers(options.device));
    const GatherSegments segments = make_segments(options, *device);
    if (!options.dump.empty()) {
        write_segments(options.dump, segments);
        spdlog::info("wrote {}", options.dump.string());
    }
    const Bvh bvh = build_scene_bvh(segments.geometry, {.quality = options.bvh});
    const GatherBenchResult result = bench_gather(
        *device, segments, bvh,
        {.repeats = options.repeats, .kernel = kernel_of(options, *device), .roulette = options.roulette});
    if (global.json) {
        print_json(to_json(segments.geometry.name, options.bvh, result));
    } else {
        print(gather_bench_text(segments.geometry.name, options.bvh, result));
    }
    return result.agrees ? ExitCode::done : ExitCode::runtime;
}

}  // namespace

void add_bench_gather(CommandLine& line, CLI::App& group) {
    auto options = std::make_shared<BenchGatherOptions>();
    CLI::App& command = line.add_part(
        group, "gather",
        "Trace shadow rays from VPLs to receivers and compare with Embree; fails if hits differ",
        [options](const GlobalOptions& global) { return run_bench_gather(*options, global); });
    add_bench_scene_options(command, options->scene);
    command
        .add_option("--dump", options->dump,
                    "Write the segments to a file for other programs to replay (format: docs/bench.md)")
        ->type_name("FILE");
    command
        .add_option("--replay", options->replay, "Read the segments from a file of --dump instead of a scene")
        ->type_name("FILE");
    add_size_option(command, options->size)->default_str("512x512");
    command.add_option("--vpls", options->vpls, "Number of VPLs")
        ->check(CLI::Range(1, 1 << 20))
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Number of runs; the median counts")
        ->check(CLI::Range(1, 1000))
        ->type_name("N")
        ->capture_default_str();
    std::map<std::string, GatherKernel> kernels{kGatherKernels.begin(), kGatherKernels.end()};
    kernels.erase(to_string(GatherKernel::automatic));
    kernels.emplace("all", GatherKernel::automatic);
    add_choice(command, "--kernel", options->kernel, kernels,
               "Gather kernels of nearlight that take part (default: all, but on GPUs rays)");
    command.add_flag("--rendered", options->rendered,
                     "Use the VPLs of a render instead of those of plain light walks");
    command
        .add_option(
            "--roulette", options->roulette,
            "Threshold: nearlight's kernels also run with Russian roulette (see `nearlight render --help`)")
        ->check(number_from(0, 1000))
        ->type_name("T");
    add_bvh_option(command, options->bvh);
    add_device_options(command, options->device);
}

}  // namespace nearlight::core
