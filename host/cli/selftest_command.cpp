// SPDX-License-Identifier: Apache-2.0
#include "host/cli/selftest_command.h"

#include <algorithm>

#include "host/cli/device_options.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/selftest/selftest.h"

namespace nearlight::core {
namespace {

struct DeviceReport {
    std::string device;
    std::vector<CheckResult> checks;

    [[nodiscard]] bool pass() const {
        return std::all_of(checks.begin(), checks.end(),
                           [](const CheckResult& check) { return check.pass(); });
    }
};

nlohmann::ordered_json to_json(const CheckResult& check) {
    nlohmann::ordered_json json{{"name", check.name},
                                {"cases", check.cases},
                                {"mismatches", check.mismatches},
                                {"pass", check.pass()}};
    if (!check.problem.empty()) {
        json["problem"] = check.problem;
    }
    return json;
}

nlohmann::ordered_json to_json(const std::vector<DeviceReport>& reports, bool pass) {
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const DeviceReport& report : reports) {
        nlohmann::ordered_json checks = nlohmann::ordered_json::array();
        for (const CheckResult& check : report.checks) {
            checks.push_back(to_json(check));
        }
        devices.push_back({{"device", report.device}, {"checks", checks}, {"pass", report.pass()}});
    }
    return {{"devices", devices}, {"pass", pass}};
}

void print_row(const CheckResult& check) {
    print(fmt::format("  {:<18} {:>9} {:>11}  {}\n", check.name, check.cases, check.mismatches,
                      check.pass() ? "ok" : "FAILED"));
    if (!check.problem.empty()) {
        print(fmt::format("    {}\n", check.problem));
    }
}

/// Tests one device. A device that cannot be opened fails like a check, so that the others are still tested.
DeviceReport test_device(const DeviceEntry& entry, const DeviceOptions& options, bool print_rows) {
    if (print_rows) {
        print(fmt::format("{} ({})\n  {:<18} {:>9} {:>11}\n", entry.name, entry.platform, "kernel", "cases",
                          "mismatches"));
    }
    const auto done = [&](const CheckResult& check) {
        if (print_rows) {
            print_row(check);
        }
    };
    DeviceReport report{.device = entry.name, .checks = {}};
    try {
        Device device(entry, options);
        report.checks = run_selftest(device, done);
    } catch (const Error& error) {
        CheckResult& opening = report.checks.emplace_back();
        opening.name = "open";
        opening.problem = error.what();
        done(opening);
    }
    return report;
}

ExitCode run_selftest_command(const DeviceChoice& asked, const GlobalOptions& global) {
    const DeviceChoice choice = with_compile_workers(asked);
    std::vector<DeviceReport> reports;
    for (const DeviceEntry& entry : choose_devices(list_devices(), choice.device)) {
        reports.push_back(test_device(entry, choice.options, !global.json && !global.quiet));
    }
    const bool pass =
        std::all_of(reports.begin(), reports.end(), [](const DeviceReport& report) { return report.pass(); });
    if (global.json) {
        print_json(to_json(reports, pass));
    } else if (!global.quiet) {
        print(pass ? "All kernels agree with their oracles.\n"
                   : "Some kernels disagree with their oracles.\n");
    }
    return pass ? ExitCode::done : ExitCode::runtime;
}

}  // namespace

void add_selftest_command(CommandLine& line) {
    auto choice = std::make_shared<DeviceChoice>();
    CLI::App& command = line.add_command(
        "selftest", "Compare every kernel with its CPU or Embree oracle, on each device of --device",
        [choice](const GlobalOptions& global) { return run_selftest_command(*choice, global); });
    add_device_options(command, *choice);
}

}  // namespace nearlight::core
