// SPDX-License-Identifier: Apache-2.0
// Handling of Ctrl-C and of a terminal that is closed: commands finish the current step, save, and exit with
// ExitCode::interrupted.
#pragma once

namespace nearlight::core {

/// After this call a first SIGINT, SIGTERM or SIGHUP only makes interrupted() true. Another one ends the
/// program if it comes more than 0.3 seconds later. A SIGHUP that the program was started to ignore, as by
/// `nohup`, stays ignored. A command that calls this must check interrupted() between its steps, most of
/// which take less than a second; making the VPLs of a pass is one step, and takes longer where there are
/// many.
void catch_interrupts();
/// Whether one of these signals came since catch_interrupts().
[[nodiscard]] bool interrupted();

}  // namespace nearlight::core
