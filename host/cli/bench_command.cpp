// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_command.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "host/base/log.h"
#include "host/bench/build_bench.h"
#include "host/bench/gather_bench.h"
#include "host/bench/synthetic_scene.h"
#include "host/cli/device_options.h"
#include "host/cli/output.h"
#include "host/cli/scene_options.h"

namespace nearlight {
namespace {

struct BenchOptions {
    std::string part;
    SceneOptions scene;
    DeviceChoice device;
    ImageSize size;
    std::optional<std::size_t> vpls;
    int repeats = 11;
    std::string kernel = "automatic";
    BvhQuality bvh = BvhQuality::quality;  ///< of gather
};

constexpr std::string_view kSpheres = "spheres:";

/// "spheres:N" is a made-up room of N triangles; anything else is a file.
Scene make_scene(const SceneOptions& options) {
    const std::string name = options.file.string();
    if (!name.starts_with(kSpheres)) {
        return load_scene(options);
    }
    std::size_t triangles = 0;
    const char* const end = name.data() + name.size();
    const auto [rest, error] = std::from_chars(name.data() + kSpheres.size(), end, triangles);
    if (error != std::errc() || rest != end || triangles == 0 || triangles > 50'000'000) {
        throw Error(ExitCode::usage, "'" + name + "': give a number of triangles, as in spheres:400000");
    }
    return make_sphere_room(triangles);
}

GatherKernel kernel_of(const std::string& name) {
    return name == "packets" ? GatherKernel::packets
           : name == "rays"  ? GatherKernel::rays
                             : GatherKernel::automatic;
}

nlohmann::ordered_json to_json(const Scene& scene, const GatherBenchResult& result) {
    return {{"scene", scene.name},
            {"triangles", result.triangles},
            {"bvh", to_string(result.bvh)},
            {"pairs", result.pairs},
            {"rays", result.rays},
            {"occluded_fraction", result.occluded_fraction},
            {"disagreements", result.disagreements},
            {"nearlight_mrays", result.nearlight_mrays},
            {"embree1_mrays", result.embree1_mrays},
            {"embree16_mrays", result.embree16_mrays},
            {"ratio_embree1", result.ratio_embree1},
            {"ratio_embree16", result.ratio_embree16},
            {"ratio_embree16_deviation", result.ratio_embree16_deviation},
            {"embree1_mode", result.embree1_mode},
            {"embree16_mode", result.embree16_mode},
            {"device", result.device}};
}

std::string to_text(const Scene& scene, const GatherBenchResult& result) {
    std::string text = fmt::format("{}: {} triangles in a {} tree, device {}\n", scene.name, result.triangles,
                                   to_string(result.bvh), result.device);
    text += fmt::format("{:.1f} M pairs, {:.1f} M of them rays, {:.1f} % occluded, {} disagreements\n",
                        static_cast<double>(result.pairs) * 1e-6, static_cast<double>(result.rays) * 1e-6,
                        100.0 * result.occluded_fraction, result.disagreements);
    text += fmt::format("{:>10} {:>8}\n", "Mrays/s", "ratio");
    text += fmt::format("{:>10.2f} {:>8}  nearlight, all of the gather\n", result.nearlight_mrays, "");
    text += fmt::format("{:>10.2f} {:>8.2f}  Embree {}\n", result.embree1_mrays, result.ratio_embree1,
                        result.embree1_mode);
    text +=
        fmt::format("{:>10.2f} {:>8.2f}  Embree {} (deviation of the ratio {:.2f})\n", result.embree16_mrays,
                    result.ratio_embree16, result.embree16_mode, result.ratio_embree16_deviation);
    return text +
           "Medians of interleaved runs; Embree's time is inside its calls only, in its fastest mode.\n";
}

nlohmann::ordered_json to_json(const Scene& scene, const BuildBenchResult& result) {
    nlohmann::ordered_json trees = nlohmann::ordered_json::array();
    for (const BuiltTree& tree : result.trees) {
        trees.push_back({{"name", tree.name},
                         {"seconds", tree.seconds},
                         {"sah_cost", tree.sah_cost},
                         {"nodes", tree.nodes},
                         {"duplication", tree.duplication},
                         {"depth", tree.depth},
                         {"nodes_per_ray", tree.steps.nodes_per_ray},
                         {"triangles_per_ray", tree.steps.triangles_per_ray},
                         {"nodes_per_packet", tree.steps.nodes_per_packet},
                         {"triangles_per_packet", tree.steps.triangles_per_packet}});
    }
    const TreeSteps& steps = result.trees.front().steps;
    return {{"scene", scene.name},
            {"triangles", result.triangles},
            {"rays", steps.rays},
            {"packets", steps.packets},
            {"occluded", steps.occluded},
            {"trees", trees},
            {"ratio_seconds", result.ratio_seconds},
            {"ratio_ray_steps", result.ratio_ray_steps},
            {"ratio_packet_steps", result.ratio_packet_steps}};
}

std::string to_text(const Scene& scene, const BuildBenchResult& result) {
    const TreeSteps& steps = result.trees.front().steps;
    std::string text = fmt::format(
        "{}: {} triangles; steps of {:.2f} M rays, {:.0f} % occluded, in {} packets\n", scene.name,
        result.triangles, static_cast<double>(steps.rays) * 1e-6,
        100.0 * static_cast<double>(steps.occluded) / std::max(1.0, static_cast<double>(steps.rays)),
        steps.packets);
    text += fmt::format("{:<18}{:>9}{:>10}{:>10}{:>9}{:>7}{:>11}{:>11}{:>14}{:>14}\n", "tree", "seconds",
                        "SAH cost", "nodes", "doubled", "depth", "nodes/ray", "tri./ray", "nodes/packet",
                        "tri./packet");
    for (const BuiltTree& tree : result.trees) {
        text +=
            fmt::format("{:<18}{:>9.3f}{:>10.2f}{:>10}{:>7.1f} %{:>7}{:>11.2f}{:>11.2f}{:>14.2f}{:>14.2f}\n",
                        tree.name, tree.seconds, tree.sah_cost, tree.nodes, 100.0 * tree.duplication,
                        tree.depth, tree.steps.nodes_per_ray, tree.steps.triangles_per_ray,
                        tree.steps.nodes_per_packet, tree.steps.triangles_per_packet);
    }
    return text + fmt::format(
                      "nearlight quality / Embree high: build {:.2f}, steps of a ray {:.3f}, of a packet "
                      "{:.3f}\n",
                      result.ratio_seconds, result.ratio_ray_steps, result.ratio_packet_steps);
}

ExitCode run_build_bench(const BenchOptions& options, const Scene& scene, const GlobalOptions& global) {
    BuildBenchConfig config;
    config.vpl_count = options.vpls.value_or(config.vpl_count);
    config.width = options.size.width > 0 ? options.size.width : config.width;
    config.height = options.size.height > 0 ? options.size.height : config.height;
    config.repeats = options.repeats;
    const BuildBenchResult result = bench_build(scene, config);
    if (global.json) {
        print_json(to_json(scene, result));
    } else {
        print(to_text(scene, result));
    }
    return ExitCode::done;
}

ExitCode run_bench(const BenchOptions& options, const GlobalOptions& global) {
    const Scene scene = make_scene(options.scene);
    if (options.part == "build") {
        return run_build_bench(options, scene, global);
    }
    const std::unique_ptr<Device> device = open_device(options.device);
    const SceneBvhs bvhs = build_scene_bvhs(scene, {.quality = options.bvh});
    GatherBenchConfig config;
    config.vpl_count = options.vpls.value_or(config.vpl_count);
    config.width = options.size.width > 0 ? options.size.width : config.width;
    config.height = options.size.height > 0 ? options.size.height : config.height;
    config.repeats = options.repeats;
    config.gather.kernel = kernel_of(options.kernel);
    GatherBenchResult result = bench_gather(*device, scene, bvhs.opaque, config);
    result.bvh = options.bvh;
    if (global.json) {
        print_json(to_json(scene, result));
    } else {
        print(to_text(scene, result));
    }
    return ExitCode::done;
}

}  // namespace

void add_bench_command(CommandLine& line) {
    auto options = std::make_shared<BenchOptions>();
    CLI::App& command =
        line.add_command("bench", "Measure a part beside the best that others offer, on the same work",
                         [options](const GlobalOptions& global) { return run_bench(*options, global); });
    command
        .add_option("PART", options->part,
                    "gather: shadow rays from VPLs, against Embree; build: trees, beside Embree's")
        ->required()
        ->check(CLI::IsMember({"gather", "build"}));
    add_scene_options(command, options->scene);
    add_device_options(command, options->device);
    add_size_option(command, options->size);
    command.add_option("--vpls", options->vpls, "VPLs (default: 128 for gather, 32 for build)")
        ->check(CLI::Range(1, 1 << 20))
        ->type_name("N");
    command.add_option("--repeats", options->repeats, "Runs of which the median counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command.add_option("--kernel", options->kernel, "Gather kernel")
        ->check(CLI::IsMember({"automatic", "packets", "rays"}))
        ->capture_default_str();
    add_bvh_option(command, options->bvh);
}

}  // namespace nearlight
