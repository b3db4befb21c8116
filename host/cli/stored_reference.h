// SPDX-License-Identifier: Apache-2.0
// A reference picture in a file, which `nearlight reference --resume` goes on from.
#pragma once

#include <filesystem>
#include <optional>

#include "host/image/image_io.h"
#include "host/reference/path_tracer.h"

namespace nearlight::core {

/// What shapes the expectation and the random numbers of a reference, as its file tells it: all settings but
/// the number of samples, and the size.
Metadata reference_identity(const PathTracerSettings& settings, const Scene& scene);

struct StoredReference {
    Image image;
    int batch_size = 0;
    int samples = 0;           ///< per pixel, at least
    float render_seconds = 0;  ///< that it took
};

/// Empty where there is no such file. Throws Error(ErrorKind::file) saying what is different where it was
/// made with other settings than `wanted` (see completed()), or is no reference at all.
std::optional<StoredReference> read_stored_reference(const std::filesystem::path& file,
                                                     const PathTracerSettings& wanted, const Scene& scene);

}  // namespace nearlight::core
