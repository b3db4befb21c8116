// SPDX-License-Identifier: Apache-2.0
// `nearlight render` on several ranks: how ranks agree on a picture, and what those do that help to make it.
#pragma once

#include <string>
#include <vector>

#include "host/cli/exit_code.h"
#include "host/cli/render_run.h"
#include "host/ranks/hello.h"
#include "host/ranks/post.h"

namespace nearlight::core {

/// The facts in which all ranks must agree, as text.
std::string rank_facts(const RenderRun& run);
/// Throws Error if a rank has other facts than `ours`. The first element of `hellos` is that of rank 1.
void check_ranks(const std::vector<Hello>& hellos, const std::string& ours);

/// Makes bands for the leading rank until that ends the job.
ExitCode help_render(const RenderOptions& options, const GlobalOptions& global, const DeviceChoice& choice,
                     Post& post);

}  // namespace nearlight::core
