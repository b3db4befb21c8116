// SPDX-License-Identifier: Apache-2.0
#include "host/stages/camera_lights.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

CameraLights::CameraLights(Device& device)
    : program_(device, "camera_lights.cl", kViewProgram),
      add_(program_, "camera_lights_add"),
      rounds_(program_, "camera_lights_rounds"),
      refine_(program_, "camera_lights_refine") {}

void CameraLights::add(const Buffer<CameraVertex>& vertices, const CameraBatch& batch, uint width,
                       uint row_count, uint half_end, Buffer<CameraLight>& lights) {
    add_.launch_items(std::size_t{width} * row_count, vertices, width, row_count, packet_order(batch, width),
                      batch.first_sample, half_end, lights);
}

void CameraLights::choose(const Buffer<CameraLight>& lights, const Buffer<float>& sums,
                          const CameraLightBand& band, Buffer<uint>& rounds) {
    rounds_.launch_items(std::size_t{band.width} * band.row_count, lights, sums, band.width, band.row_count,
                         band.sample_count, rounds);
}

void CameraLights::refine(const Buffer<uint>& pixels, std::size_t first, std::size_t count,
                          const Buffer<CameraLight>& added, float scale, Buffer<CameraLight>& lights,
                          Buffer<float>& sums, Buffer<uint>& rounds) {
    refine_.launch_items(count, pixels, static_cast<uint>(first), static_cast<uint>(count), added, scale,
                         lights, sums, rounds);
}

}  // namespace nearlight::core
