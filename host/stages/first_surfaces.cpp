// SPDX-License-Identifier: Apache-2.0
#include "host/stages/first_surfaces.h"

namespace nearlight::core {

FirstSurfaces::FirstSurfaces(Device& device)
    : program_(device, "first_surfaces.cl"), first_surfaces_(program_, "first_surfaces") {}

void FirstSurfaces::run(const DeviceScene& scene, const Buffer<Camera>& camera, const SampleBlock& block,
                        uint seed, Buffer<uint>& triangles) {
    first_surfaces_.launch_items(block.size(), scene, camera, block.first_column, block.first_row,
                                 block.width, block.row_count, block.first_sample, block.sample_count,
                                 block.in_middle ? 1u : 0u, seed, triangles);
}

}  // namespace nearlight::core
