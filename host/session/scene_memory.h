// SPDX-License-Identifier: Apache-2.0
// The memory that a scene takes on the host and on devices, and whether there is enough.
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Estimated bytes of a scene's parts.
struct SceneMemory {
    std::uint64_t geometry = 0;
    std::uint64_t trees = 0;
    std::uint64_t textures = 0;
    std::uint64_t environment_on_host = 0;
    std::uint64_t environment_on_device = 0;

    [[nodiscard]] std::uint64_t on_device() const {
        return geometry + trees + textures + environment_on_device;
    }
};
/// Assumes two triangles per leaf of the trees.
SceneMemory estimate_scene_memory(const Scene& scene);

/// Throws Error(ErrorKind::out_of_memory) if the trees of a loaded scene and its copies on `cpu_devices`
/// devices that share the machine's memory do not fit into `free_bytes`. A system that runs out of memory
/// ends processes without a word, after minutes of work. VPLs and the picture are left out, because they can
/// be made smaller. Devices with memory of their own are not asked: they refuse what does not fit.
void check_scene_memory(const Scene& scene, std::size_t cpu_devices, std::uint64_t free_bytes);

}  // namespace nearlight::core
