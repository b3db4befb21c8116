// SPDX-License-Identifier: Apache-2.0
#include "host/cli/compile_notice.h"

#include <gtest/gtest.h>

#include <string>

#include "host/cl/compile/program_compiler.h"
#include "host/cl/devices/device_list.h"
#include "host/cl/program.h"
#include "host/cli/log.h"
#include "tests/cli/terminal.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

/// What a notice of that patience says while a device compiles.
std::string said_while_compiling(const DeviceEntry& entry, std::chrono::milliseconds patience) {
    const test::Terminal terminal;
    set_up_log(Verbosity::normal);
    DeviceOptions options;
    options.cache_dir = "none";
    Device device(entry, options);
    // No cache has a program of these options, neither ours nor the driver's.
    const Program program(device, "camera_pass.cl", {{"NEARLIGHT_TEST_PROCESS", std::to_string(getpid())}});
    {
        const CompileNotice notice(device, patience);
        while (device.compiler().is_busy()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    return terminal.read_all();
}

TEST(CompileNotice, SaysOnATerminalThatKernelsAreBeingCompiledUnlessSomethingElseIsSeenSooner) {
    NEARLIGHT_NEEDS_DEVICE();
    if (const test::Terminal terminal; !test::Terminal::works()) {
        GTEST_SKIP() << "no pseudo-terminal here";
    }
    const DeviceEntry entry = choose_devices(list_devices(), "").front();
    const std::string text = said_while_compiling(entry, std::chrono::milliseconds(0));
    EXPECT_NE(text.find("compiling kernels for " + entry.label()), std::string::npos) << text;
    EXPECT_EQ(said_while_compiling(entry, std::chrono::minutes(1)), "");
}

}  // namespace
}  // namespace nearlight::core
