// SPDX-License-Identifier: Apache-2.0
// The lights of a scene: the table of them, the tree over lamps, which are area lights, points, spots and
// projectors, and the environment.
#ifndef NEARLIGHT_SHARED_LIGHT_H
#define NEARLIGHT_SHARED_LIGHT_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

#define NEARLIGHT_EMITTER_POINT 0u
#define NEARLIGHT_EMITTER_SPOT 1u
#define NEARLIGHT_EMITTER_TRIANGLE 2u
#define NEARLIGHT_EMITTER_ENVIRONMENT 3u
#define NEARLIGHT_EMITTER_DIRECTIONAL 4u
#define NEARLIGHT_EMITTER_PROJECTOR 5u
#define NEARLIGHT_EMITTER_SUN 6u
#define NEARLIGHT_EMITTER_SPHERE 7u
#define NEARLIGHT_EMITTER_CYLINDER 8u

/// One entry of the table of lights, which lists delta lights (directional, then point, spot and projector),
/// then area lights (triangle, sphere, cylinder) in the order of their triangles, then the sun and the
/// environment. An entry is chosen with `probability`: each kind of light that there is has the same part,
/// which its entries share in proportion to their emitted power (host/scene/emitters.h). A sphere or cylinder
/// is one light, although rays meet the triangles that stand for it.
///
/// Spots and projectors may send an image. Its point (s, t) = ½ + (d·x_axis, d·y_axis)/(d·direction) lies in
/// the direction d, with t counted from the top row. The intensity of a projector is radiance/cos³ times the
/// image, inside the image only, so that an even image lights a plane across its axis evenly.
typedef struct Emitter {
    Vec3 position;  // point, spot and projector; sphere: its centre; cylinder: the middle of one end
    uint type;
    Vec3 direction;  // unit; spot, projector and cylinder: the axis; directional: the way that light goes
    uint triangle;   // area light: index into the triangle array of its first triangle
    Vec3 radiance;   // point, spot and projector: intensity, W/sr; directional: irradiance across the
                     // direction, W/m²; area lights, sun: radiance; environment: mean radiance
    float area;      // area lights: m²; projector: of its image at the distance 1; sun: steradians
    float probability;
    float cdf;           // sum of the probabilities up to and including this one
    float beam_angle;    // spot: full intensity within this angle of the axis, radians
    float cutoff_angle;  // spot: no light beyond this angle, radians; linear between the two
    Vec3 x_axis;
    uint image;  // index of the texture plus 1; 0: none
    Vec3 y_axis;
    uint tree_way;        // its way down the tree of lights, a digit of base NEARLIGHT_LIGHT_TREE_WIDTH for
                          // the child of each node; that of the root is the lowest
    float radius;         // sphere, cylinder: m
    float outer_radius;   // all its triangles lie within this distance of its centre or axis, m
    float length;         // cylinder: m
    uint triangle_count;  // area light: triangles that belong to it, from `triangle` on
} Emitter;

/// Up to this many delta lights are all summed. If there are more, they are chosen by chance like the other
/// lights.
#define NEARLIGHT_MAX_EXACT_LIGHTS 16u

#define NEARLIGHT_LIGHT_TREE_WIDTH 8u       // max children of a node
#define NEARLIGHT_MAX_LIGHT_TREE_DEPTH 10u  // digits of Emitter.tree_way

/// A node of the tree of lights. For each of its children it holds the bounds of all lights below, bound by
/// bound, so that a receiver weighs all children at once. Node 0 is the root. Children that do not exist
/// stand behind those that do, and have no power.
typedef struct LightNode {
    float center[3][NEARLIGHT_LIGHT_TREE_WIDTH];       // of a sphere around the lights: x, y, z
    float radius_squared[NEARLIGHT_LIGHT_TREE_WIDTH];  // of that sphere, m²
    float axis[3][NEARLIGHT_LIGHT_TREE_WIDTH];         // about where the lights face: x, y, z
    float cos_spread[NEARLIGHT_LIGHT_TREE_WIDTH];      // all of them face within this angle of the axis
    float cos_beam[NEARLIGHT_LIGHT_TREE_WIDTH];  // none shines farther than this angle from where it faces
    float power[NEARLIGHT_LIGHT_TREE_WIDTH];     // π times the luminance of the greatest intensity, W;
                                                 // of a triangle, the luminance of its flux
    uint child[NEARLIGHT_LIGHT_TREE_WIDTH];      // index of a node, or of a light in the table, with
                                                 // NEARLIGHT_LEAF_BIT
} LightNode;

/// A latitude-longitude environment map, whose pixel rows run from +Y (top) to −Y in the local frame of the
/// light. A constant environment has a single pixel. The pixels are float4 (RGB radiance) and are importance
/// sampled through tables of the row and column distributions. A sun, a disc of even radiance, may stand
/// before the map.
typedef struct Environment {
    float world_to_local[9];  // rotation matrix, row by row
    uint width, height;       // 0 × 0: no environment
    float scene_radius;       // radius of the sphere around the scene, m
    Vec3 scene_center;
    float sun_height;      // 1 − cosine of the sun's half angle; 0: no sun
    Vec3 sun_direction;    // unit vector to the sun, in the world
    float sun_half_chord;  // length of the vector from sun_direction to a unit vector to the rim
    Vec3 sun_radiance;
    uint interpolated;  // 1: radiance is interpolated between pixels; 0: it is constant over a pixel
    uint block_size;    // columns and rows of pixels of a block (lib/light/environment.cl)
    uint block_columns, block_rows;
} Environment;

/// Where the table of blocks says that a block has no details: its density is constant.
#define NEARLIGHT_NO_DETAIL 0xffffffffu

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(Emitter, 112);
NEARLIGHT_CHECK_SHARED(LightNode, 352);
NEARLIGHT_CHECK_SHARED(Environment, 108);
}  // namespace nearlight::core
#endif

#endif
