// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_command.h"

#include <charconv>

#include "host/base/log.h"
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
    std::size_t vpls = 128;
    int repeats = 11;
    std::string kernel = "automatic";
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
    std::string text =
        fmt::format("{}: {} triangles, device {}\n", scene.name, result.triangles, result.device);
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

ExitCode run_bench(const BenchOptions& options, const GlobalOptions& global) {
    const Scene scene = make_scene(options.scene);
    const std::unique_ptr<Device> device = open_device(options.device);
    const SceneBvhs bvhs = build_scene_bvhs(scene);
    GatherBenchConfig config;
    config.vpl_count = options.vpls;
    config.width = options.size.width > 0 ? options.size.width : config.width;
    config.height = options.size.height > 0 ? options.size.height : config.height;
    config.repeats = options.repeats;
    config.gather.kernel = kernel_of(options.kernel);
    const GatherBenchResult result = bench_gather(*device, scene, bvhs.opaque, config);
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
    command.add_option("PART", options->part, "gather: shadow rays from VPLs, against Embree")
        ->required()
        ->check(CLI::IsMember({"gather"}));
    add_scene_options(command, options->scene);
    add_device_options(command, options->device);
    add_size_option(command, options->size);
    command.add_option("--vpls", options->vpls, "VPLs")->check(CLI::Range(1, 1 << 20))->capture_default_str();
    command.add_option("--repeats", options->repeats, "Runs of which the median counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command.add_option("--kernel", options->kernel, "Gather kernel")
        ->check(CLI::IsMember({"automatic", "packets", "rays"}))
        ->capture_default_str();
}

}  // namespace nearlight
