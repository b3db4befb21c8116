// SPDX-License-Identifier: Apache-2.0
// Kernel text with its includes expanded, so that the driver sees one string and no cache can serve a stale
// header.
#pragma once

#include <filesystem>
#include <string>

namespace nearlight::core {

/// The text of kernels/`name`, from `kernel_dir` if that is set, else from the binary. `#include "…"` lines
/// are replaced by the file (relative to kernels/), each once; `#line` directives keep the compiler's
/// messages true. Throws Error(ErrorKind::kernel_build) for a file that does not exist.
std::string expand_kernel_source(const std::string& name, const std::filesystem::path& kernel_dir = {});

}  // namespace nearlight::core
