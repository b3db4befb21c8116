// SPDX-License-Identifier: Apache-2.0
#include "host/cli/tune_command.h"

#include <filesystem>

#include "host/bench/tuner.h"
#include "host/cli/device_options.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/tunables_output.h"

namespace nearlight::core {
namespace {

struct TuneOptions {
    TunerConfig config;
    DeviceChoice device;
    bool dry_run = false;
    bool reset = false;
};

nlohmann::ordered_json to_json(const TunerTrial& trial) {
    nlohmann::ordered_json json{{"tunable", trial.tunable},
                                {"measured_by", trial.measured_by},
                                {"clock", trial.by_processor ? "processor" : "wall"},
                                {"usual", trial.usual},
                                {"chosen", trial.chosen}};
    for (const TriedValue& one : trial.tried) {
        if (!one.failed_because.empty()) {
            json["candidates"].push_back({{"value", one.value}, {"failed", one.failed_because}});
            continue;
        }
        json["candidates"].push_back({{"value", one.value},
                                      {"seconds", one.median.wall},
                                      {"processor_seconds", one.median.processor},
                                      {"to_usual", one.to_usual.median},
                                      {"deviation", one.to_usual.deviation}});
    }
    return json;
}

nlohmann::ordered_json to_json(const TunerResult& result, const std::string& file) {
    nlohmann::ordered_json json{{"device", result.device},
                                {"usual", to_json(result.usual)},
                                {"chosen", to_json(result.chosen)},
                                {"file", file}};
    for (const TunerTrial& trial : result.trials) {
        json["trials"].push_back(to_json(trial));
    }
    return json;
}

std::string to_text(const TunerTrial& trial) {
    std::string text = fmt::format(
        "{}, measured by the {} ({})\n{:>10} {:>10} {:>13} {:>16}\n", trial.tunable, trial.measured_by,
        trial.by_processor ? "processor time" : "wall clock", "value", "ms", "processor ms", "to the usual");
    for (const TriedValue& one : trial.tried) {
        if (!one.failed_because.empty()) {
            text += fmt::format("{:>10} {}\n", one.value, one.failed_because);
            continue;
        }
        const char* const mark = one.value == trial.chosen  ? "  chosen"
                                 : one.value == trial.usual ? "  usual"
                                                            : "";
        text +=
            fmt::format("{:>10} {:>10.2f} {:>13.2f} {:>9.3f} ± {:.3f}{}\n", one.value, 1e3 * one.median.wall,
                        1e3 * one.median.processor, one.to_usual.median, one.to_usual.deviation, mark);
    }
    return text;
}

ExitCode reset(const Device& device, const GlobalOptions& global) {
    const std::filesystem::path file = tunables_file(device.entry(), device.options().cache_dir);
    std::error_code ignored;
    const bool removed = !file.empty() && std::filesystem::remove(file, ignored);
    spdlog::info("{}", removed ? "removed " + file.string() : "nothing is stored for " + device.name());
    if (global.json) {
        print_json({{"device", device.name()},
                    {"removed", removed ? nlohmann::ordered_json(file.string()) : nlohmann::ordered_json()}});
    }
    return ExitCode::done;
}

ExitCode run_tune(const TuneOptions& options, const GlobalOptions& global) {
    const std::unique_ptr<Device> device = open_device(with_compile_workers(options.device));
    if (options.reset) {
        return reset(*device, global);
    }
    const std::string file =
        options.dry_run ? "" : tunables_file(device->entry(), device->options().cache_dir).string();
    if (file.empty() && !options.dry_run) {
        throw Error(ErrorKind::invalid_argument,
                    "there is no folder to keep tunables in; give one with --cache-dir, or use --dry-run");
    }
    spdlog::info("measuring {}, which takes about half a minute", device->entry().label());
    const TunerResult result = tune(*device, options.config);
    if (!file.empty()) {
        store_tunables(result.chosen, result.kernels, device->entry(), device->options().cache_dir,
                       device->options().kernel_dir);
    }
    if (global.json) {
        print_json(to_json(result, file));
        return ExitCode::done;
    }
    for (const TunerTrial& trial : result.trials) {
        print(to_text(trial));
    }
    print(
        fmt::format("Medians of interleaved runs. Another value replaces the usual one if it takes at least "
                    "3 % less time and the difference exceeds the variation between runs. Pictures are the "
                    "same with all values.\n{}: {}\n",
                    result.device, to_text(result.chosen)));
    if (!file.empty()) {
        spdlog::info("wrote {}; `nearlight tune --reset` removes it", file);
    }
    return ExitCode::done;
}

}  // namespace

void add_tune_command(CommandLine& line) {
    auto options = std::make_shared<TuneOptions>();
    CLI::App& command = line.add_command(
        "tune", "Measure how best to divide work on a device, and keep the result for later runs",
        [options](const GlobalOptions& global) { return run_tune(*options, global); });
    command.add_option("--repeats", options->config.repeats, "Number of runs; the median counts")
        ->check(CLI::Range(1, 1000))
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option("--triangles", options->config.triangles,
                    "Number of triangles in the generated room that is measured")
        ->check(CLI::Range(100, 10'000'000))
        ->type_name("N")
        ->capture_default_str();
    command.add_flag("--dry-run", options->dry_run, "Measure, but keep nothing");
    command.add_flag("--reset", options->reset, "Delete the result that is kept for the device");
    add_device_options(command, options->device);
}

}  // namespace nearlight::core
