// SPDX-License-Identifier: Apache-2.0
// A small picture's worth of receivers, by which settings are chosen that nobody gave.
#pragma once

#include <span>
#include <vector>

#include "host/scene/scene.h"
#include "host/stages/camera_pass.h"

namespace nearlight::core {

/// What is asked of importons; kernels/vpl_contribution.cl has the formulas.
enum class ContributionNorm {
    mean,               ///< what a VPL brings: luminance
    rough_mean_square,  ///< what it would add to the error of the picture if chosen by chance; few importons
};

/// For rough mean squares, responses are squares, and the importons are marked for squared geometry terms.
struct Importons {
    Buffer<Importon> importons;
    std::size_t count = 0;
};

/// Importons by parts of the picture: groups of `group_size` that follow one another. Where a group has
/// fewer, it is filled up with some that nothing reaches.
struct ImportonGroups {
    Buffer<Importon> importons;
    std::size_t importon_count = 0;  ///< without those that fill up
    uint group_size = 0;
    uint group_count = 0;
};

struct PilotView {
    const Device* device = nullptr;  ///< that all buffers are on
    Buffer<ReceiverPacket> receivers;
    Buffer<CameraVertex> vertices;
    uint packet_count = 0;
    Importons importons;
    Importons few_squared_importons;  ///< few of them, evenly spread
    ImportonGroups importon_groups;   ///< some of them
    std::vector<float> distances;  ///< of the receivers from the camera, ascending, m; empty: nothing in view

    [[nodiscard]] bool is_on(const Device& other) const { return device == &other; }
    [[nodiscard]] const Importons& importons_of(ContributionNorm norm) const;
};

/// What the camera sees of light, one importon for each receiver that reflects any of it.
std::vector<Importon> make_importons(const std::vector<ReceiverPacket>& packets,
                                     const std::vector<CameraVertex>& vertices);

/// Uploads them, the squares of some, and groups.
void set_importons(Device& device, PilotView& view, std::span<const Importon> importons);

/// About a thousand receivers, evenly spread over the view.
PilotView look_at_scene(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                        const SceneCamera& camera, uint seed);

}  // namespace nearlight::core
