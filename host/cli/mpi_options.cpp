// SPDX-License-Identifier: Apache-2.0
#include "host/cli/mpi_options.h"

#include "host/ranks/post.h"

namespace nearlight::core {

void add_mpi_option(CLI::App& command, MpiUse& use) {
    const std::map<std::string, MpiUse> uses{
        {"auto", MpiUse::automatic}, {"on", MpiUse::on}, {"off", MpiUse::off}};
    add_choice(command, "--mpi", use, uses,
               "Whether the processes of a job make one picture together: auto (those that `mpirun` or "
               "`srun` started), on, or off (each process makes its own picture)")
        ->default_str("auto");
}

bool joins_job(MpiUse use) {
    return use == MpiUse::on || (use == MpiUse::automatic && is_rank_of_job());
}

}  // namespace nearlight::core
