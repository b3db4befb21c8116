// SPDX-License-Identifier: Apache-2.0
// Handling of Ctrl-C: commands finish the current step, save, and exit with ExitCode::interrupted.
#pragma once

namespace nearlight::core {

/// After this call a first SIGINT or SIGTERM only makes interrupted() true; a second one ends the program. A
/// command that calls this must check interrupted() several times a second.
void catch_interrupts();
/// Whether a SIGINT or SIGTERM came since catch_interrupts().
[[nodiscard]] bool interrupted();

}  // namespace nearlight::core
