// SPDX-License-Identifier: Apache-2.0
// A reference picture in a file, which `nearlight reference --resume` continues.
#pragma once

#include <filesystem>
#include <optional>

#include "host/image/image_io.h"
#include "host/reference/path_tracer.h"

namespace nearlight::core {

/// The attributes of a reference's file that determine its expectation and its random numbers: its size and
/// all settings except the number of samples.
Metadata reference_identity(const PathTracerSettings& settings, const Scene& scene);

struct StoredReference {
    Image image;
    int batch_size = 0;
    int samples = 0;           ///< minimum number of samples per pixel
    float render_seconds = 0;  ///< rendering time so far
};

/// Reads a reference to resume; empty if the file does not exist. Throws Error(ErrorKind::file), which names
/// the differences, if it was made with other settings than `wanted` (see completed()) or is not a reference.
std::optional<StoredReference> read_stored_reference(const std::filesystem::path& file,
                                                     const PathTracerSettings& wanted, const Scene& scene);

}  // namespace nearlight::core
