// SPDX-License-Identifier: Apache-2.0
// Files of segments, which other programs can replay. docs/bench.md describes the format.
#pragma once

#include <filesystem>

#include "host/bench/gather_segments.h"

namespace nearlight::core {

/// Writes the segments. Throws Error(ErrorKind::file) if the file cannot be written.
void write_segments(const std::filesystem::path& file, const GatherSegments& segments);

/// Reads segments. Throws Error(ErrorKind::file) for a file that is missing, of another kind or version,
/// truncated or too long, or that contradicts itself: an index out of range, a number that is not finite, a
/// ray to an absent receiver, or a number of rays that differs from the header's.
GatherSegments read_segments(const std::filesystem::path& file);

}  // namespace nearlight::core
