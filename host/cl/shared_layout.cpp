// SPDX-License-Identifier: Apache-2.0
#include "host/cl/shared_layout.h"

#include <cstddef>

#include "kernels/shared/film_layers.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

#define SIZE(Type) \
    { #Type " size", sizeof(Type) }
#define OFFSET(Type, member) \
    { #Type "." #member, offsetof(Type, member) }
#define VALUE(expression) \
    { #expression, expression }
#define LAYER_PLACES(constant, name, channels, samples, passes) \
    , VALUE(NEARLIGHT_LAYER_##constant), VALUE(NEARLIGHT_SUM_##constant)

std::vector<LayoutFact> shared_layout() {
    return {
        SIZE(BvhNode),
        OFFSET(BvhNode, left),
        OFFSET(BvhNode, right_max),
        SIZE(BvhTriangle),
        OFFSET(BvhTriangle, normal),
        SIZE(WideNode),
        OFFSET(WideNode, high),
        OFFSET(WideNode, child),
        SIZE(TriangleBlock),
        OFFSET(TriangleBlock, edge2),
        SIZE(RayQuery),
        OFFSET(RayQuery, t_max),
        SIZE(RayHit),
        OFFSET(RayHit, slot),
        SIZE(Vertex),
        OFFSET(Vertex, v),
        SIZE(Triangle),
        OFFSET(Triangle, material),
        SIZE(Material),
        OFFSET(Material, eta),
        OFFSET(Material, transmission),
        OFFSET(Material, base_saturation),
        SIZE(Texture),
        OFFSET(Texture, v_offset),
        OFFSET(Texture, color1),
        SIZE(Emitter),
        OFFSET(Emitter, radiance),
        OFFSET(Emitter, cutoff_angle),
        SIZE(Environment),
        OFFSET(Environment, scene_center),
        SIZE(PinholeCamera),
        OFFSET(PinholeCamera, step_y),
        SIZE(Vpl),
        OFFSET(Vpl, power),
        SIZE(Importon),
        OFFSET(Importon, response),
        SIZE(SurfaceSample),
        OFFSET(SurfaceSample, v),
        SIZE(ReceiverPacket),
        OFFSET(ReceiverPacket, nz),
        SIZE(IrradiancePacket),
        OFFSET(IrradiancePacket, b),
        SIZE(ImportancePacket),
        OFFSET(ImportancePacket, b),
        SIZE(GatherParams),
        OFFSET(GatherParams, group_size),
        OFFSET(GatherParams, recorded_vpls),
        SIZE(CameraVertex),
        OFFSET(CameraVertex, emitted),
        SIZE(CloseRange),
        OFFSET(CloseRange, range),
        SIZE(SceneInfo),
        OFFSET(SceneInfo, extent),
        VALUE(NEARLIGHT_TILE_SIZE),
        VALUE(tiles_across(0)),
        VALUE(tiles_across(1)),
        VALUE(tiles_across(640)),
        VALUE(tiles_across(641)),
        VALUE(NEARLIGHT_LAYER_CHANNELS),
        VALUE(NEARLIGHT_FILM_CHANNELS) NEARLIGHT_FILM_LAYERS(LAYER_PLACES),
    };
}

#undef LAYER_PLACES
#undef VALUE
#undef OFFSET
#undef SIZE

}  // namespace nearlight::core
