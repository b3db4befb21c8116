// SPDX-License-Identifier: Apache-2.0
// EXT_meshopt_compression and KHR_meshopt_compression: buffer views whose bytes are compressed.
#pragma once

#include "host/scene/gltf/gltf_file.h"

namespace nearlight::core::gltf {

/// Whether this build has the library meshoptimizer.
bool can_decode_meshopt();

/// Decodes all compressed views, each into a buffer of its own to which the view refers then, so that
/// accessors read them like any other. Calls fail() if a view is broken or of a kind that the library does
/// not know. The library must be there.
void decode_meshopt(GltfFile& file);

}  // namespace nearlight::core::gltf
