// SPDX-License-Identifier: Apache-2.0
// What host and device must agree on: sizes and member offsets of the shared structs, how tiles cover pixels,
// and where each layer of the film lies. The host lists these facts (host/cl/shared_layout.cpp), a kernel
// writes them (layout_probe.cl), and a test compares the two on every device. A new struct gets its rows
// here.
#ifndef NEARLIGHT_SHARED_LAYOUT_FACTS_H
#define NEARLIGHT_SHARED_LAYOUT_FACTS_H

/// Expands to SIZE(struct), OFFSET(struct, member) or VALUE(constant expression) for each fact, in order. The
/// place where it expands must include bsdf_query.h, camera_pass.h, caustic_aims.h, film_layers.h, light.h,
/// light_cut.h, light_tracer.h, local_lights.h, packet_order.h, receiver_paths.h, shared_light.h, splats.h,
/// types.h and walk_aim.h.
#define NEARLIGHT_LAYOUT_FACTS(SIZE, OFFSET, VALUE) \
    SIZE(BvhNode)                                   \
    OFFSET(BvhNode, left)                           \
    OFFSET(BvhNode, right_max)                      \
    SIZE(BvhTriangle)                               \
    OFFSET(BvhTriangle, normal)                     \
    SIZE(WideNode)                                  \
    OFFSET(WideNode, high)                          \
    OFFSET(WideNode, child)                         \
    SIZE(TriangleBlock)                             \
    OFFSET(TriangleBlock, edge2)                    \
    SIZE(RayQuery)                                  \
    OFFSET(RayQuery, t_max)                         \
    SIZE(RayHit)                                    \
    OFFSET(RayHit, slot)                            \
    SIZE(Vertex)                                    \
    OFFSET(Vertex, v)                               \
    SIZE(Triangle)                                  \
    OFFSET(Triangle, material)                      \
    SIZE(Parameter)                                 \
    OFFSET(Parameter, texture)                      \
    SIZE(Material)                                  \
    OFFSET(Material, emission)                      \
    OFFSET(Material, eta)                           \
    OFFSET(Material, internal_reflectance)          \
    SIZE(Texture)                                   \
    OFFSET(Texture, format)                         \
    OFFSET(Texture, v_offset)                       \
    OFFSET(Texture, cutoff)                         \
    OFFSET(Texture, color1)                         \
    SIZE(Emitter)                                   \
    OFFSET(Emitter, radiance)                       \
    OFFSET(Emitter, cutoff_angle)                   \
    OFFSET(Emitter, image)                          \
    OFFSET(Emitter, triangle_count)                 \
    SIZE(LightNode)                                 \
    OFFSET(LightNode, cos_spread)                   \
    OFFSET(LightNode, child)                        \
    SIZE(Environment)                               \
    OFFSET(Environment, scene_center)               \
    OFFSET(Environment, sun_radiance)               \
    SIZE(Camera)                                    \
    OFFSET(Camera, step_y)                          \
    OFFSET(Camera, focus_distance)                  \
    OFFSET(Camera, filter_radius)                   \
    OFFSET(Camera, splat_reach)                     \
    OFFSET(Camera, filter_signed)                   \
    SIZE(Vpl)                                       \
    OFFSET(Vpl, power)                              \
    SIZE(Importon)                                  \
    OFFSET(Importon, response)                      \
    SIZE(SharedLight)                               \
    OFFSET(SharedLight, normal)                     \
    OFFSET(SharedLight, radiance)                   \
    SIZE(SeenSurface)                               \
    OFFSET(SeenSurface, light_samples)              \
    SIZE(SharedSkyParams)                           \
    OFFSET(SharedSkyParams, seen_rays)              \
    SIZE(SharedReflection)                          \
    OFFSET(SharedReflection, light_pdf)             \
    SIZE(SurfaceSample)                             \
    OFFSET(SurfaceSample, v)                        \
    SIZE(ReceiverPacket)                            \
    OFFSET(ReceiverPacket, surface)                 \
    OFFSET(ReceiverPacket, mesh_normal)             \
    OFFSET(ReceiverPacket, sequence)                \
    SIZE(IrradiancePacket)                          \
    OFFSET(IrradiancePacket, b)                     \
    SIZE(ImportancePacket)                          \
    OFFSET(ImportancePacket, b)                     \
    SIZE(GatherParams)                              \
    OFFSET(GatherParams, group_size)                \
    OFFSET(GatherParams, has_curves)                \
    OFFSET(GatherParams, has_maps)                  \
    OFFSET(GatherParams, stratum_period)            \
    SIZE(CutNode)                                   \
    OFFSET(CutNode, children)                       \
    SIZE(CutEntry)                                  \
    OFFSET(CutEntry, bound)                         \
    SIZE(CutParams)                                 \
    OFFSET(CutParams, asked)                        \
    SIZE(ReceiverPathParams)                        \
    OFFSET(ReceiverPathParams, clamp_radius)        \
    OFFSET(ReceiverPathParams, shares)              \
    SIZE(LightTracerParams)                         \
    OFFSET(LightTracerParams, all_walks)            \
    OFFSET(LightTracerParams, seed)                 \
    SIZE(GatherRadius)                              \
    OFFSET(GatherRadius, seed)                      \
    SIZE(LocalLightParams)                          \
    OFFSET(LocalLightParams, first_packet)          \
    OFFSET(LocalLightParams, direct_samples)        \
    SIZE(PacketOrder)                               \
    OFFSET(PacketOrder, bundle_samples)             \
    OFFSET(PacketOrder, interleave)                 \
    SIZE(CameraPassParams)                          \
    OFFSET(CameraPassParams, seed)                  \
    OFFSET(CameraPassParams, limits)                \
    OFFSET(CameraPassParams, list)                  \
    SIZE(CameraLight)                               \
    OFFSET(CameraLight, second)                     \
    SIZE(CameraVertex)                              \
    OFFSET(CameraVertex, filter_weight)             \
    OFFSET(CameraVertex, traced_direct)             \
    OFFSET(CameraVertex, traced_indirect)           \
    OFFSET(CameraVertex, film_y)                    \
    SIZE(Splat)                                     \
    OFFSET(Splat, half_light)                       \
    SIZE(CameraSplat)                               \
    OFFSET(CameraSplat, second)                     \
    SIZE(RowSplat)                                  \
    OFFSET(RowSplat, camera)                        \
    SIZE(CausticLanding)                            \
    OFFSET(CausticLanding, is_there)                \
    SIZE(CausticCell)                               \
    OFFSET(CausticCell, count)                      \
    SIZE(CausticTable)                              \
    OFFSET(CausticTable, side)                      \
    SIZE(CloseRange)                                \
    OFFSET(CloseRange, range)                       \
    SIZE(Opening)                                   \
    OFFSET(Opening, share)                          \
    SIZE(WalkAim)                                   \
    OFFSET(WalkAim, radius)                         \
    OFFSET(WalkAim, opening_count)                  \
    SIZE(SceneInfo)                                 \
    OFFSET(SceneInfo, extent)                       \
    OFFSET(SceneInfo, size)                         \
    OFFSET(SceneInfo, has_sky)                      \
    SIZE(BsdfQuery)                                 \
    OFFSET(BsdfQuery, choice)                       \
    SIZE(BsdfAnswer)                                \
    OFFSET(BsdfAnswer, weight)                      \
    VALUE(NEARLIGHT_TILE_SIZE)                      \
    VALUE(tiles_across(0))                          \
    VALUE(tiles_across(1))                          \
    VALUE(tiles_across(640))                        \
    VALUE(tiles_across(641))                        \
    VALUE(NEARLIGHT_LAYER_CHANNELS)                 \
    VALUE(NEARLIGHT_FILM_CHANNELS)

#endif
