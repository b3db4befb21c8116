// SPDX-License-Identifier: Apache-2.0
// The option by which processes that mpirun starts make one picture, or each its own.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

enum class MpiUse { automatic, on, off };

void add_mpi_option(CLI::App& command, MpiUse& use);
/// Whether this process is to join the others of its job.
bool joins_job(MpiUse use);

}  // namespace nearlight::core
