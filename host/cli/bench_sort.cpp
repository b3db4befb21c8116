// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_sort.h"

#include <algorithm>

#include "host/bench/sort_bench.h"
#include "host/cli/device_options.h"
#include "host/cli/log.h"
#include "host/cli/output.h"

namespace nearlight::core {
namespace {

struct BenchSortOptions {
    SortBenchConfig config;
    DeviceChoice device;
};

nlohmann::ordered_json to_json(const SortBenchResult& result) {
    nlohmann::ordered_json json{{"device", result.device}, {"count", result.count}};
    for (const SortFigures& figures : result.figures) {
        json["figures"].push_back({{"name", figures.name},
                                   {"seconds", figures.median.wall},
                                   {"processor_seconds", figures.median.processor},
                                   {"is_right", figures.is_right}});
    }
    for (const SortRatio& ratio : result.ratios) {
        json["ratios"].push_back(
            {{"name", ratio.name}, {"wall", ratio.wall}, {"processor", ratio.processor}});
    }
    return json;
}

std::string to_text(const SortBenchResult& result) {
    std::string text =
        fmt::format("{} keys, device {}\n{:>10} {:>12}\n", result.count, result.device, "ms", "processor ms");
    for (const SortFigures& figures : result.figures) {
        text += fmt::format("{:>10.2f} {:>12.2f}  {}{}\n", 1e3 * figures.median.wall,
                            1e3 * figures.median.processor, figures.name, figures.is_right ? "" : ": WRONG");
    }
    text += fmt::format("{:>10} {:>12}\n", "rate ratio", "by processor");
    for (const SortRatio& ratio : result.ratios) {
        text += fmt::format("{:>10.2f} {:>12.2f}  {}\n", ratio.wall, ratio.processor, ratio.name);
    }
    return text + "Medians of interleaved runs; above 1, ours is faster.\n";
}

ExitCode run_bench_sort(const BenchSortOptions& options, const GlobalOptions& global) {
    const std::unique_ptr<Device> device = open_device(with_compile_workers(options.device));
    const SortBenchResult result = bench_sort(*device, options.config);
    if (global.json) {
        print_json(to_json(result));
    } else {
        print(to_text(result));
    }
    const bool right = std::all_of(result.figures.begin(), result.figures.end(),
                                   [](const SortFigures& figures) { return figures.is_right; });
    return right ? ExitCode::done : ExitCode::runtime;
}

}  // namespace

void add_bench_sort(CommandLine& line, CLI::App& group) {
    auto options = std::make_shared<BenchSortOptions>();
    CLI::App& command = line.add_part(
        group, "sort", "Compare radix sort and prefix sum with TBB, the standard library and plain copying",
        [options](const GlobalOptions& global) { return run_bench_sort(*options, global); });
    command.add_option("--count", options->config.count, "Number of keys")
        ->check(CLI::Range(1, 1 << 28))
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--repeats", options->config.repeats, "Number of runs; the median counts")
        ->check(CLI::Range(1, 1000))
        ->type_name("N")
        ->capture_default_str();
    add_device_options(command, options->device);
}

}  // namespace nearlight::core
