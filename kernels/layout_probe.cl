// SPDX-License-Identifier: Apache-2.0
// Writes size and member offsets of every shared struct, where each layer of the film lies, and how tiles
// cover pixels, so that a test can compare them with the host's on every device. Output: one uint a fact, in
// the order of the list in host/cl/shared_layout.cpp.

#include "shared/film_layers.h"
#include "shared/types.h"

#define SIZE(Type) *out++ = (uint)sizeof(Type)
#define OFFSET(Type, member) *out++ = (uint)(size_t)(&(((Type*)0)->member))
#define VALUE(expression) *out++ = (uint)(expression)
#define LAYER_PLACES(constant, name, channels, samples, passes) \
    VALUE(NEARLIGHT_LAYER_##constant);                          \
    VALUE(NEARLIGHT_SUM_##constant);

kernel void layout_probe(global uint* out) {
    SIZE(BvhNode);
    OFFSET(BvhNode, left);
    OFFSET(BvhNode, right_max);
    SIZE(BvhTriangle);
    OFFSET(BvhTriangle, normal);
    SIZE(WideNode);
    OFFSET(WideNode, high);
    OFFSET(WideNode, child);
    SIZE(TriangleBlock);
    OFFSET(TriangleBlock, edge2);
    SIZE(RayQuery);
    OFFSET(RayQuery, t_max);
    SIZE(RayHit);
    OFFSET(RayHit, slot);
    SIZE(Vertex);
    OFFSET(Vertex, v);
    SIZE(Triangle);
    OFFSET(Triangle, material);
    SIZE(Material);
    OFFSET(Material, eta);
    OFFSET(Material, transmission);
    OFFSET(Material, base_saturation);
    SIZE(Texture);
    OFFSET(Texture, v_offset);
    OFFSET(Texture, color1);
    SIZE(Emitter);
    OFFSET(Emitter, radiance);
    OFFSET(Emitter, cutoff_angle);
    SIZE(Environment);
    OFFSET(Environment, scene_center);
    SIZE(PinholeCamera);
    OFFSET(PinholeCamera, step_y);
    SIZE(Vpl);
    OFFSET(Vpl, power);
    SIZE(Importon);
    OFFSET(Importon, response);
    SIZE(SurfaceSample);
    OFFSET(SurfaceSample, v);
    SIZE(ReceiverPacket);
    OFFSET(ReceiverPacket, nz);
    SIZE(IrradiancePacket);
    OFFSET(IrradiancePacket, b);
    SIZE(ImportancePacket);
    OFFSET(ImportancePacket, b);
    SIZE(GatherParams);
    OFFSET(GatherParams, group_size);
    OFFSET(GatherParams, recorded_vpls);
    SIZE(CameraVertex);
    OFFSET(CameraVertex, emitted);
    SIZE(CloseRange);
    OFFSET(CloseRange, range);
    SIZE(SceneInfo);
    OFFSET(SceneInfo, extent);
    VALUE(NEARLIGHT_TILE_SIZE);
    VALUE(tiles_across(0));
    VALUE(tiles_across(1));
    VALUE(tiles_across(640));
    VALUE(tiles_across(641));
    VALUE(NEARLIGHT_LAYER_CHANNELS);
    VALUE(NEARLIGHT_FILM_CHANNELS);
    NEARLIGHT_FILM_LAYERS(LAYER_PLACES)
}
