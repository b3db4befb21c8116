// SPDX-License-Identifier: Apache-2.0
// What materials do with light, in a few numbers. These are estimates that steer sampling and lay out data;
// nothing in the picture depends on their accuracy.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/texture.h"

namespace nearlight::core {

/// The share of light, coming from all sides in proportion to cosine, that D reflects at texture coordinates
/// (u, v). Masks and blends count by their weights, and sides and maps by what they hold. A two-sided
/// material is that of its front.
Vec3 diffuse_albedo(const Scene& scene, const Material& material, float u, float v,
                    Vec3 vertex_color = kWhite);
/// About the share of light that the material reflects or lets through, D and S together.
Vec3 mean_reflectance(const Scene& scene, const Material& material, float u, float v,
                      Vec3 vertex_color = kWhite);

/// Whether D may be there anywhere on the surface, on the front or the back.
bool has_diffuse(const Scene& scene, const Material& material);
/// Whether S may be there anywhere on the surface: coat, metal, glass, or a mask's holes.
bool has_specular(const Scene& scene, const Material& material);
/// Whether S may spread light over more than single directions, and keep it on its side.
bool has_rough_gloss(const Scene& scene, const Material& material);
/// Whether light may leave as a mirror image of a metal, or through the boundary of a glass body.
bool has_mirror(const Scene& scene, const Material& material);
/// Whether light may be scattered by the back, too: a two-sided material or one that lets light through.
bool reflects_back(const Scene& scene, const Material& material);
/// Whether light may pass without a change of direction: a thin pane, a mask, or nothing at all.
bool passes_straight(const Scene& scene, const Material& material);
/// Whether shadow rays may pass the material straight: it is a veil (kernels/lib/light/shadow.cl).
bool is_veil(const Scene& scene, const Material& material);
/// What lets light pass straight through somewhere in the scene: one of NEARLIGHT_VEILS_….
uint veils_of(const Scene& scene);
/// Whether light may reach the other side, straight or not.
bool lets_through(const Scene& scene, const Material& material);

}  // namespace nearlight::core
