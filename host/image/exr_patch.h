// SPDX-License-Identifier: Apache-2.0
// Changing a number in the header of an OpenEXR file that is already written.
#pragma once

#include <filesystem>
#include <string>

namespace nearlight::core {

/// Overwrites the value of the header attribute `name`, which must be there as a single float. For what is
/// known only at the end, such as the render time, while rows were streamed. Throws Error(ErrorKind::file).
void patch_exr_float(const std::filesystem::path& file, const std::string& name, float value);

}  // namespace nearlight::core
