// SPDX-License-Identifier: Apache-2.0
// The program `nearlight`: it runs the command that the options name, and turns errors into messages and exit
// codes.
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "host/base/printable.h"
#include "host/cli/advice.h"
#include "host/cli/command.h"
#include "host/cli/commands.h"
#include "host/cli/exit_code.h"
#include "host/cli/standard_streams.h"

namespace {

int fail(std::string_view message, nearlight::core::ExitCode code) {
    std::fprintf(stderr, "nearlight: error: %s\n", nearlight::core::printable_line(message).c_str());
    return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
    using nearlight::core::ExitCode;
    nearlight::core::prepare_standard_streams();
    try {
        nearlight::core::CommandLine line;
        nearlight::core::add_commands(line);
        return static_cast<int>(line.run(argc, argv));
    } catch (const nearlight::Error& error) {
        return fail(nearlight::core::with_advice(error), nearlight::core::exit_code(error.kind()));
    } catch (const std::bad_alloc&) {
        return fail("out of memory on the host; use a smaller --size or fewer --layers",
                    ExitCode::out_of_memory);
    } catch (const std::system_error& error) {
        if (error.code() != std::errc::resource_unavailable_try_again) {
            return fail(error.what(), ExitCode::runtime);
        }
        return fail(
            "a thread cannot be started; raise the limit of memory (ulimit -v) or of processes (ulimit -u)",
            ExitCode::out_of_memory);
    } catch (const std::exception& error) {
        return fail(error.what(), ExitCode::runtime);
    }
}
