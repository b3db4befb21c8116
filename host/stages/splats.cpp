// SPDX-License-Identifier: Apache-2.0
#include "host/stages/splats.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {
namespace {

std::size_t pixel_count(const SplatPixels& pixels) {
    return std::size_t{pixels.width} * pixels.row_count;
}

}  // namespace

Splats::Splats(Device& device)
    : program_(device, "splats.cl", kViewProgram),
      add_(program_, "splats_add"),
      add_camera_light_(program_, "splats_add_camera_light"),
      refine_(program_, "splats_refine"),
      gather_(program_, "splats_gather"),
      none_(device, 0) {}

void Splats::add(const Buffer<CameraVertex>& vertices, const ReceivedIrradiance& irradiance,
                 const Buffer<Camera>& camera, const CameraBatch& batch, const SplatPixels& pixels,
                 bool with_camera_light, Buffer<Splat>& splats) {
    add_.launch_items(pixel_count(pixels), vertices, irradiance.direct, irradiance.gathered,
                      irradiance.indirect, camera, pixels.width, pixels.row_count,
                      packet_order(batch, pixels.width), batch.first_sample, pixels.half_end,
                      with_camera_light ? 1u : 0u, splats);
}

void Splats::add_camera_light(const Buffer<CameraVertex>& vertices, const Buffer<Camera>& camera,
                              const CameraBatch& batch, const SplatPixels& pixels,
                              Buffer<CameraSplat>& splats) {
    add_camera_light_.launch_items(pixel_count(pixels), vertices, camera, pixels.width, pixels.row_count,
                                   packet_order(batch, pixels.width), batch.first_sample, pixels.half_end,
                                   splats);
}

void Splats::refine(const Buffer<uint>& listed, std::size_t first, std::size_t count, uint reach,
                    const Buffer<CameraSplat>& added, float scale, Buffer<CameraSplat>& splats) {
    refine_.launch_items(count, listed, static_cast<uint>(first), static_cast<uint>(count), reach, added,
                         scale, splats);
}

void Splats::gather(const Buffer<Splat>& splats, const Buffer<CameraSplat>* camera_splats,
                    const SplatPixels& pixels, uint reach, Buffer<RowSplat>& rows) {
    gather_.launch_items(pixel_count(pixels), splats, camera_splats != nullptr ? *camera_splats : none_,
                         camera_splats != nullptr ? 1u : 0u, pixels.width, pixels.row_count, reach, rows);
}

}  // namespace nearlight::core
