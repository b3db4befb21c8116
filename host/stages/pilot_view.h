// SPDX-License-Identifier: Apache-2.0
// A pilot view: the receivers of a small picture, which decide the settings that the user left open.
#pragma once

#include <span>
#include <vector>

#include "host/scene/scene.h"
#include "host/stages/camera_pass.h"

namespace nearlight::core {

/// The measure of what a VPL brings to importons. kernels/vpl_contribution.cl has the formulas.
enum class ContributionNorm {
    mean,           ///< the luminance that a VPL brings
    error_of_draw,  ///< what a VPL drawn by chance would add to the picture's error (root of the sum of
                    ///< squares), by few importons
};

/// Importons on a device. Those for ContributionNorm::error_of_draw have squared responses and are marked
/// for squared geometry terms.
struct Importons {
    Buffer<Importon> importons;
    std::size_t count = 0;
};

/// Importons by parts of the picture: consecutive groups of `group_size`. A smaller group is padded with
/// importons that nothing reaches.
struct ImportonGroups {
    Buffer<Importon> importons;
    std::size_t importon_count = 0;  ///< without the padding
    uint group_size = 0;
    uint group_count = 0;
};

struct PilotView {
    const Device* device = nullptr;  ///< the device that all buffers are on
    Buffer<ReceiverPacket> receivers;
    uint packet_count = 0;
    Importons importons;
    Importons few_squared_importons;  ///< few of them, evenly spread, for ContributionNorm::error_of_draw
    ImportonGroups importon_groups;   ///< some of the importons, by parts of the picture
    std::vector<float> distances;     ///< between camera and receivers, ascending, m; empty: nothing in view

    [[nodiscard]] bool is_on(const Device& other) const { return device == &other; }
    [[nodiscard]] const Importons& importons_of(ContributionNorm norm) const;
};

/// Makes one importon for each receiver that reflects light to the camera.
std::vector<Importon> make_importons(const std::vector<ReceiverPacket>& packets,
                                     const std::vector<CameraVertex>& vertices);

/// Uploads the importons to the view, along with its few squared importons and its groups.
void set_importons(Device& device, PilotView& view, std::span<const Importon> importons);

/// Makes a pilot view of about a thousand receivers, which are evenly spread over the picture.
PilotView look_at_scene(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                        const SceneCamera& camera, uint seed);

}  // namespace nearlight::core
