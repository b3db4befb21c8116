// SPDX-License-Identifier: Apache-2.0
// Ctrl-C: finish what is at hand, save, and leave with ExitCode::interrupted.
#pragma once

namespace nearlight::core {

/// From now on a first SIGINT or SIGTERM only makes interrupted() true; a second one ends the program.
/// For commands that look at interrupted() several times a second.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace nearlight::core
