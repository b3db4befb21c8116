// SPDX-License-Identifier: Apache-2.0
// A room in which the total light of each depth is known, but little of it reaches the camera.
#pragma once

#include <cmath>
#include <vector>

#include "host/samplers/sampler.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core::test {

inline constexpr float kRoomAlbedo = 0.6f;
inline constexpr float kLightFlux = 4 * kPi;  ///< W in each colour channel

inline constexpr float kBenchClampRadius = 0.1f;

/// A closed box of one albedo, in two halves that a gap joins: the light is in one, the camera in the other.
/// No walk leaves the room, so the flux that is reflected at depth d is kLightFlux · kRoomAlbedo^d.
inline Scene divided_room() {
    using namespace small_scenes;
    Scene scene;
    const uint wall = add_two_sided(scene, lambertian({kRoomAlbedo, kRoomAlbedo, kRoomAlbedo}));
    add_quad(scene, {-1, -1, -2}, {0, 0, 4}, {2, 0, 0}, wall);
    add_quad(scene, {-1, 1, -2}, {2, 0, 0}, {0, 0, 4}, wall);
    add_quad(scene, {-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, wall);
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, wall);
    add_quad(scene, {-1, -1, -2}, {0, 2, 0}, {0, 0, 4}, wall);
    add_quad(scene, {1, -1, -2}, {0, 0, 4}, {0, 2, 0}, wall);
    add_quad(scene, {-1, -1, 0}, {0, 2, 0}, {1.5f, 0, 0}, wall);  // the divider
    add_point_light(scene, {-0.3f, 0.2f, -1.2f}, {1, 1, 1});
    set_camera(scene, {0.2, 0.1, 0.3}, {-0.2, -0.1, 2}, 70);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

/// A sampler's input, and functions that sample with it.
class SamplingBench {
  public:
    SamplingBench(Device& device, const Scene& scene)
        : device_(device),
          stages_(device),
          camera_pass_(device),
          scene_(device, scene),
          view_(look_at_scene(device, camera_pass_, scene_.buffers, scene.camera, 1)) {}

    [[nodiscard]] SamplingTask task(SamplerKind sampler, uint vpl_count, uint seed, uint bounce_count = 3) {
        return {.scene = scene_.buffers,
                .view = view_,
                .sampler = sampler,
                .vpl_count = vpl_count,
                .bounce_count = bounce_count,
                .close_fraction = std::nullopt,
                .clamp_radius = kBenchClampRadius,
                .seed = seed};
    }
    [[nodiscard]] VplSet sample(SamplerKind sampler, uint vpl_count, uint seed, uint bounce_count = 3) {
        return sample_vpls(stages_, task(sampler, vpl_count, seed, bounce_count));
    }
    [[nodiscard]] SamplerStages& stages() { return stages_; }
    [[nodiscard]] const PilotView& view() const { return view_; }
    /// The luminance that each VPL of a set brings to the camera.
    [[nodiscard]] std::vector<float> contributions(const VplSet& set) {
        Buffer<float> contributions(device_, set.vpls.count());
        stages_.vpl_contribution.run(scene_.buffers, set.vpls.buffer(), set.vpls.count(), view_,
                                     kBenchClampRadius, contributions);
        return contributions.download();
    }

  private:
    Device& device_;
    SamplerStages stages_;
    CameraPass camera_pass_;
    SceneOnDevice scene_;
    PilotView view_;
};

/// Summed power of the VPLs of a depth, W (green).
inline double power_at_depth(const VplSet& set, uint depth) {
    double sum = 0;
    for (const Vpl& vpl : set.vpls.download()) {
        sum += vpl.depth == depth ? vpl.power.y : 0.0f;
    }
    return sum;
}

}  // namespace nearlight::core::test
