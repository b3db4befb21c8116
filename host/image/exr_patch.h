// SPDX-License-Identifier: Apache-2.0
// Changing a number in the header of an OpenEXR file that is already written.
#pragma once

#include <filesystem>
#include <string>

namespace nearlight::core {

/// Overwrites the value of the header attribute `name`, which must exist as a single float. Some values, such
/// as the render time, are known only after all rows were streamed. Throws Error(ErrorKind::file).
void patch_exr_float(const std::filesystem::path& file, const std::string& name, float value);

}  // namespace nearlight::core
