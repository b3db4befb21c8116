// SPDX-License-Identifier: Apache-2.0
// Sets of segments as files, for other programs to replay. docs/bench.md describes the format.
#pragma once

#include <filesystem>

#include "host/bench/gather_segments.h"

namespace nearlight::core {

/// Throws Error(ErrorKind::file) where the file cannot be written.
void write_segments(const std::filesystem::path& file, const GatherSegments& segments);

/// Throws Error(ErrorKind::file) for a file that is missing, of another kind or version, truncated or too
/// long, or that contradicts itself: an index out of range, a number that is not finite, a ray to an absent
/// receiver, or another number of rays than the header says.
GatherSegments read_segments(const std::filesystem::path& file);

}  // namespace nearlight::core
