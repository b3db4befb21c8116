// SPDX-License-Identifier: Apache-2.0
#include "host/cli/info_command.h"

#include "host/cli/output.h"
#include "host/cli/scene_options.h"
#include "host/cli/scene_summary.h"

namespace nearlight::core {
namespace {

ExitCode run_info(const SceneOptions& options, const GlobalOptions& global) {
    const Scene scene = load_scene(options);
    if (global.json) {
        print_json(scene_summary_json(scene));
    } else {
        print(scene_summary_text(scene));
    }
    return ExitCode::done;
}

}  // namespace

void add_info_command(CommandLine& line) {
    auto options = std::make_shared<SceneOptions>();
    options->lists_animations = true;
    CLI::App& command = line.add_command(
        "info", "Show what a scene contains, what is approximated, and how much memory it needs",
        [options](const GlobalOptions& global) { return run_info(*options, global); });
    add_scene_options(command, *options);
}

}  // namespace nearlight::core
