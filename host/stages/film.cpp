// SPDX-License-Identifier: Apache-2.0
#include "host/stages/film.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

Film::Film(Device& device)
    : program_(device, "film.cl", kViewProgram),
      film_add_(program_, "film_add"),
      film_resolve_(program_, "film_resolve") {}

void Film::add(const Buffer<ReceiverPacket>& receivers, const Buffer<CameraVertex>& vertices,
               const ReceivedIrradiance& irradiance, const CameraBatch& batch, uint width, uint row_count,
               Buffer<float>& sums) {
    film_add_.launch_items(static_cast<std::size_t>(width) * row_count, receivers, vertices,
                           irradiance.direct, irradiance.gathered, irradiance.indirect, width, row_count,
                           packet_order(batch, width), batch.first_sample, batch.samples_per_pixel, sums);
}

void Film::resolve(const Buffer<float>& sums, std::size_t pixel_count, uint samples_per_pixel,
                   Buffer<float>& layers) {
    film_resolve_.launch_items(pixel_count, sums, static_cast<uint>(pixel_count), samples_per_pixel, layers);
}

}  // namespace nearlight::core
