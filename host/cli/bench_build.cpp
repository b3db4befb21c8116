// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_build.h"

#include <algorithm>

#include "host/bench/build_bench.h"
#include "host/cli/bench_scene.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/scene_options.h"

namespace nearlight::core {
namespace {

struct BenchBuildOptions {
    SceneOptions scene;
    ImageSize size{512, 512};
    std::size_t vpls = 32;
    int repeats = 5;
};

nlohmann::ordered_json to_json(const Scene& scene, const BuildBenchResult& result) {
    nlohmann::ordered_json trees = nlohmann::ordered_json::array();
    for (const BuiltTree& tree : result.trees) {
        trees.push_back({{"name", tree.name},
                         {"seconds", tree.seconds.wall},
                         {"processor_seconds", tree.seconds.processor},
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
            {"ratio_processor_seconds", result.ratio_processor_seconds},
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
    text += fmt::format("{:<18}{:>9}{:>11}{:>10}{:>10}{:>9}{:>7}{:>11}{:>11}{:>14}{:>14}\n", "tree",
                        "seconds", "processor", "SAH cost", "nodes", "doubled", "depth", "nodes/ray",
                        "tri./ray", "nodes/packet", "tri./packet");
    for (const BuiltTree& tree : result.trees) {
        text += fmt::format(
            "{:<18}{:>9.3f}{:>11.3f}{:>10.2f}{:>10}{:>7.1f} %{:>7}{:>11.2f}{:>11.2f}{:>14.2f}{:>14.2f}\n",
            tree.name, tree.seconds.wall, tree.seconds.processor, tree.sah_cost, tree.nodes,
            100.0 * tree.duplication, tree.depth, tree.steps.nodes_per_ray, tree.steps.triangles_per_ray,
            tree.steps.nodes_per_packet, tree.steps.triangles_per_packet);
    }
    return text + fmt::format(
                      "nearlight quality / Embree high: build {:.2f}, by processor time {:.2f}; "
                      "steps of a ray {:.3f}, of a packet {:.3f}\n",
                      result.ratio_seconds, result.ratio_processor_seconds, result.ratio_ray_steps,
                      result.ratio_packet_steps);
}

ExitCode run_bench_build(const BenchBuildOptions& options, const GlobalOptions& global) {
    const Scene scene = make_bench_scene(options.scene);
    const BuildBenchResult result = bench_build(scene, {.vpl_count = options.vpls,
                                                        .width = options.size.width,
                                                        .height = options.size.height,
                                                        .repeats = options.repeats,
                                                        .bvh = {}});
    if (global.json) {
        print_json(to_json(scene, result));
    } else {
        print(to_text(scene, result));
    }
    return ExitCode::done;
}

}  // namespace

void add_bench_build(CommandLine& line, CLI::App& group) {
    auto options = std::make_shared<BenchBuildOptions>();
    CLI::App& command = line.add_part(
        group, "build", "Compare trees with Embree's: seconds, cost, and steps of the gather's rays",
        [options](const GlobalOptions& global) { return run_bench_build(*options, global); });
    add_bench_scene_options(command, options->scene);
    add_size_option(command, options->size)->default_str("512x512");
    command.add_option("--vpls", options->vpls, "Number of VPLs; the steps of their shadow rays are counted")
        ->check(CLI::Range(1, 1 << 20))
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Number of builds of each tree; the median counts")
        ->check(CLI::Range(1, 1000))
        ->type_name("N")
        ->capture_default_str();
}

}  // namespace nearlight::core
