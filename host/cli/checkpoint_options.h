// SPDX-License-Identifier: Apache-2.0
// The options of `nearlight render` by which long renders are kept, gone on with and divided into jobs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/cli/checkpoint_facts.h"
#include "host/cli/command.h"
#include "host/session/render.h"

namespace nearlight::core {

struct CheckpointOptions {
    std::filesystem::path file;  ///< empty: no checkpoint is written
    bool resumes = false;
    std::optional<double> seconds;  ///< the fewest between two files
    uint first_pass = 0;
};

/// Adds --checkpoint, --resume, --checkpoint-every and --first-pass. Options of VPL files must have been
/// added before.
void add_checkpoint_options(CLI::App& command, CheckpointOptions& options);

/// Throws Error(ErrorKind::invalid_argument) if the checkpoint is one of `outputs`, and
/// Error(ErrorKind::file) if it cannot be written.
void check_checkpoint_file(const std::filesystem::path& file, const std::vector<std::string>& outputs);
/// Throws Error(ErrorKind::file), whose message ends with `advice`, if there is a file, whatever it holds:
/// the work in a checkpoint is not to be lost by a mistake.
void refuse_existing_checkpoint(const std::filesystem::path& file, const char* advice);

/// Checks before any work starts that the checkpoint can be written and replaces no file by mistake. Throws
/// Error(ErrorKind::file) and, if it is one of `outputs`, Error(ErrorKind::invalid_argument).
void check_checkpoint(const CheckpointOptions& options, const std::vector<std::string>& outputs);

/// Warns of a --checkpoint-every that has nothing to write.
void warn_of_idle_interval(const CheckpointOptions& options, const RenderSettings& settings);

/// Opens the checkpoint to go on from, if that is wanted and there is one. Throws Error(ErrorKind::file).
std::optional<CheckpointReader> open_checkpoint(const CheckpointOptions& options);

/// Where the passes begin. Throws Error(ErrorKind::file) if the checkpoint belongs to another picture than
/// `ours`, or has not the size of the rendered part `window`, and Error(ErrorKind::invalid_argument) if it
/// has more passes than are asked for.
PassStart pass_start(const CheckpointOptions& options, std::optional<CheckpointReader>& reader,
                     const CheckpointFacts& ours, const RenderSettings& settings, const PixelWindow& window);

}  // namespace nearlight::core
