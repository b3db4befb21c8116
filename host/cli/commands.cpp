// SPDX-License-Identifier: Apache-2.0
#include "host/cli/commands.h"

#include "host/cli/bench_command.h"
#include "host/cli/compare_command.h"
#include "host/cli/devices_command.h"
#include "host/cli/diff_command.h"
#include "host/cli/document_command.h"
#include "host/cli/info_command.h"
#include "host/cli/merge_command.h"
#include "host/cli/reference_command.h"
#include "host/cli/render_command.h"
#include "host/cli/selftest_command.h"
#include "host/cli/tune_command.h"
#include "host/cli/view_command.h"

namespace nearlight::core {

void add_commands(CommandLine& line) {
    add_render_command(line);
    add_view_command(line);
    add_reference_command(line);
    add_diff_command(line);
    add_merge_command(line);
    add_compare_command(line);
    add_bench_command(line);
    add_selftest_command(line);
    add_devices_command(line);
    add_info_command(line);
    add_tune_command(line);
    add_document_command(line);
}

}  // namespace nearlight::core
