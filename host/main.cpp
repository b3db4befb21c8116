// SPDX-License-Identifier: Apache-2.0
// The program `nearlight`: it runs the command that the options name, and turns errors into messages and exit
// codes.
#include <cstdio>
#include <exception>
#include <new>

#include "host/cli/advice.h"
#include "host/cli/bench_command.h"
#include "host/cli/command.h"
#include "host/cli/compare_command.h"
#include "host/cli/devices_command.h"
#include "host/cli/diff_command.h"
#include "host/cli/document_command.h"
#include "host/cli/exit_code.h"
#include "host/cli/info_command.h"
#include "host/cli/merge_command.h"
#include "host/cli/reference_command.h"
#include "host/cli/render_command.h"
#include "host/cli/selftest_command.h"
#include "host/cli/standard_streams.h"
#include "host/cli/tune_command.h"
#include "host/cli/view_command.h"

namespace {

int fail(const char* message, nearlight::core::ExitCode code) {
    std::fprintf(stderr, "nearlight: error: %s\n", message);
    return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
    using nearlight::core::ExitCode;
    nearlight::core::prepare_standard_streams();
    try {
        nearlight::core::CommandLine line;
        nearlight::core::add_render_command(line);
        nearlight::core::add_view_command(line);
        nearlight::core::add_reference_command(line);
        nearlight::core::add_diff_command(line);
        nearlight::core::add_merge_command(line);
        nearlight::core::add_compare_command(line);
        nearlight::core::add_bench_command(line);
        nearlight::core::add_selftest_command(line);
        nearlight::core::add_devices_command(line);
        nearlight::core::add_info_command(line);
        nearlight::core::add_tune_command(line);
        nearlight::core::add_document_command(line);
        return static_cast<int>(line.run(argc, argv));
    } catch (const nearlight::Error& error) {
        return fail(nearlight::core::with_advice(error).c_str(), nearlight::core::exit_code(error.kind()));
    } catch (const std::bad_alloc&) {
        return fail("out of memory on the host; use a smaller --size or fewer --layers",
                    ExitCode::out_of_memory);
    } catch (const std::exception& error) {
        return fail(error.what(), ExitCode::runtime);
    }
}
