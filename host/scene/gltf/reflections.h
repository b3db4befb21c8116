// SPDX-License-Identifier: Apache-2.0
// How glTF materials reflect: what of them is metal, how rough they are, and how much the rest reflects.
#pragma once

#include "host/scene/gltf/surface_model.h"

namespace nearlight::core::gltf {

/// Reads metalness, roughness and the index of reflections of a surface whose colour has been read.
void read_reflections(const tinygltf::Material& source, const SurfaceContext& context, SurfaceModel& surface);

/// Reads KHR_materials_anisotropy of a surface whose reflections and transmission have been read.
void read_anisotropy(const tinygltf::Material& source, const SurfaceContext& context, SurfaceModel& surface);

}  // namespace nearlight::core::gltf
