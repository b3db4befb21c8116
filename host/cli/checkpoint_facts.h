// SPDX-License-Identifier: Apache-2.0
// What a checkpoint says of its picture, and whether it is that of another one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/cl/device.h"
#include "host/cli/checkpoint_file.h"
#include "host/scene/scene.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// The facts that are known before the first pass: all but metadata, look and place.
CheckpointFacts checkpoint_facts(const Scene& scene, std::uint64_t scene_hash, const RenderSettings& settings,
                                 const SessionOptions& options,
                                 const std::vector<std::unique_ptr<Device>>& devices);

/// What tells facts of one kind apart: "it has NAME THEIRS, and not OURS" for the first of `ours` that
/// differs.
std::optional<std::string> first_difference(const nlohmann::ordered_json& theirs,
                                            const nlohmann::ordered_json& ours);

/// What tells the picture of `theirs` apart from that of `ours`, as the end of a sentence about `theirs`,
/// such as "it has --vpls 500, and not 1000". Nothing, if passes of both have the same mean.
std::optional<std::string> difference_of_pictures(const CheckpointFacts& theirs, const CheckpointFacts& ours);
/// In the same way, what may make the bits of passes differ where the pictures are the same.
std::optional<std::string> difference_of_bits(const CheckpointFacts& theirs, const CheckpointFacts& ours);

/// What `sum`, to which the passes of `part` are added, says of its bits where the two differ: "several".
void mark_differences_of_bits(const CheckpointFacts& part, CheckpointFacts& sum);

/// Whether the mean of passes depends on the range and the clamp radius that pass 0 has chosen.
bool mean_depends_on_choice(const CheckpointFacts& facts);

}  // namespace nearlight::core
