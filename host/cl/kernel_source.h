// SPDX-License-Identifier: Apache-2.0
// Kernel text with its includes expanded, so that the driver sees one string and no cache can serve a stale
// header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace nearlight::core {

/// Returns the text of kernels/`name`, from `kernel_dir` if that is not empty, else from the binary. Each
/// `#include "…"` line is replaced by the file, whose name is relative to kernels/; a file is included once.
/// `#line` directives give the compiler's messages the right file and line. Throws
/// Error(ErrorKind::kernel_build) for a file that does not exist.
std::string expand_kernel_source(const std::string& name, const std::filesystem::path& kernel_dir = {});

/// A hash of the texts of all kernels, from `kernel_dir` if that is not empty, with what they include. A
/// kernel that misses a file counts as empty.
std::uint64_t kernels_hash(const std::filesystem::path& kernel_dir = {});

}  // namespace nearlight::core
