// SPDX-License-Identifier: Apache-2.0
// The structs that host and kernels share. Both compile this file, so that each struct is defined only once.
// Rules: structs have no float3 (16 bytes that read as 12), bool, size_t, pointers, bit-fields or enums, and
// they are aligned to 4 bytes, with no gaps between members. A `layout_probe` kernel and a test compare sizes
// and offsets on every device.
#ifndef NEARLIGHT_SHARED_TYPES_H
#define NEARLIGHT_SHARED_TYPES_H

#include "shared/material.h"
#include "shared/vec3.h"

#ifdef __cplusplus
#include <cstddef>
#include <type_traits>
namespace nearlight::core {
#endif

/// A child reference of a BvhNode. If bit 31 is clear, it is the index of an inner node. If bit 31 is set, it
/// is a leaf, with the triangle count − 1 in bits 27 to 30 and the first index into the BvhTriangle array in
/// bits 0 to 26.
#define NEARLIGHT_LEAF_BIT 0x80000000u
#define NEARLIGHT_LEAF_COUNT_SHIFT 27
#define NEARLIGHT_LEAF_COUNT_MASK 15u
#define NEARLIGHT_LEAF_FIRST_MASK 0x07ffffffu
#define NEARLIGHT_LEAF_MAX_TRIANGLES 16
/// The maximum depth that the builder gives a tree. A traversal stack of this many entries never overflows.
#define NEARLIGHT_MAX_BVH_DEPTH 60

/// A binary node that holds the boxes of both its children. Node 0 is the root. A child that does not exist
/// (in a scene of one leaf) has an empty box far away and refers to the leaf of the other child.
typedef struct BvhNode {
    Vec3 left_min;
    uint left;
    Vec3 left_max;
    uint right;
    Vec3 right_min;
    uint pad0;
    Vec3 right_max;
    uint pad1;
} BvhNode;

/// A triangle in the order of the leaves. Its normal is edge1 × edge2, not normalised, and points to the
/// front.
typedef struct BvhTriangle {
    Vec3 v0;
    Vec3 edge1;  // v1 − v0
    Vec3 edge2;  // v2 − v0
    Vec3 normal;
} BvhTriangle;

/// A node of the wide tree, which beams go through, and on CPUs single rays too. It holds the boxes of eight
/// children, plane by plane (x, y, z), so that a vector register holds one plane of all of them. Node 0 is
/// the root. A child reference is that of a BvhNode, except that a leaf counts and names TriangleBlocks.
/// Where there is no child, low is +∞ and high is −∞.
#define NEARLIGHT_WIDE_CHILDREN 8
typedef struct WideNode {
    float low[3][NEARLIGHT_WIDE_CHILDREN];
    float high[3][NEARLIGHT_WIDE_CHILDREN];
    uint child[NEARLIGHT_WIDE_CHILDREN];
} WideNode;

/// Up to four triangles of a leaf, component by component. Missing triangles are all zero, and nothing hits
/// them.
#define NEARLIGHT_BLOCK_TRIANGLES 4
typedef struct TriangleBlock {
    float v0[3][NEARLIGHT_BLOCK_TRIANGLES];
    float edge1[3][NEARLIGHT_BLOCK_TRIANGLES];  // v1 − v0
    float edge2[3][NEARLIGHT_BLOCK_TRIANGLES];  // v2 − v0
} TriangleBlock;

/// A ray to be cast. A hit counts if its t lies strictly inside (t_min, t_max), in units of the direction's
/// length.
typedef struct RayQuery {
    Vec3 origin;
    float t_min;
    Vec3 direction;
    float t_max;
} RayQuery;

/// What a ray meets.
typedef struct RayHit {
    float t;    // where nothing is hit: t_max, or FLT_MAX if that is infinite
    float u;    // weight of v1
    float v;    // weight of v2
    uint slot;  // index into the BvhTriangle array, or 4 · block + column of the wide tree; ~0u: nothing hit
} RayHit;

/// A vertex of the scene's triangles. Where its normal is zero, the triangle's own is used.
typedef struct Vertex {
    Vec3 position;
    float u;
    Vec3 normal;
    float v;  // 0 at the bottom row of the texture, as in OBJ files
} Vertex;

/// A triangle of the scene: indices into the vertex array, counter-clockwise as seen from the front, and the
/// index of its material.
typedef struct Triangle {
    uint v0, v1, v2;
    uint material;
} Triangle;

/// Cells of a reconstruction filter's table, from the middle of the pixel to the filter's radius.
#define NEARLIGHT_FILTER_CELLS 120
#define NEARLIGHT_FILTER_ENTRIES (NEARLIGHT_FILTER_CELLS + 4)  // one more than cells, and padding

/// A camera with its film. The film position (x, y), in pixels from the top left corner, stands for the
/// vector d = corner + x·step_x + y·step_y. A pinhole's ray starts at `origin` in the direction d. The rays
/// of a lens start at origin + a·lens_x + b·lens_y, where (a, b) lies on the unit disc, and meet at origin +
/// focus_distance·d. An orthographic camera's ray starts at origin + d in the direction `forward`. Surfaces
/// are seen from near_clip to far_clip, metres along `forward`; what lies beyond is as if it were not there.
///
/// The samples of a pixel are placed with a density in proportion to the filter's absolute value, separately
/// in x and y. Entry i of the tables is the integral from 0 to i · radius / cells of the filter's absolute
/// value and of the filter itself.
typedef struct Camera {
    Vec3 origin;
    uint width;
    Vec3 corner;
    uint height;
    Vec3 step_x;
    uint is_orthographic;
    Vec3 step_y;
    uint hides_emitters;  // 1: emitters and the environment are not seen directly
    Vec3 forward;         // unit vector
    float near_clip;
    Vec3 lens_x;  // half-axes of the lens; zero for a pinhole
    float far_clip;
    Vec3 lens_y;
    float focus_distance;          // times d: m along `forward`, unless the camera's transform scales
    float film_min_x, film_min_y;  // samples lie within these film positions
    float film_max_x, film_max_y;
    float filter_radius;  // pixels; 0: a box over the pixel's own square, which needs no tables
    uint splat_reach;     // columns and rows to which samples count beyond their pixel's; 0: in it alone
    float pad0, pad1;
    float filter_absolute[NEARLIGHT_FILTER_ENTRIES];
    float filter_signed[NEARLIGHT_FILTER_ENTRIES];
} Camera;

/// A virtual point light, which stands for the Lambertian part of what its surface reflects. It sends the
/// flux `power` (W, albedo applied) into the hemisphere of `normal`, with the radiant intensity power/π ·
/// cosθ · T(cosθs), where θ is the angle to `normal`, θs that to the shading normal, and T the surface's
/// transmission curve. Where cosθs is not positive, the surface is seen from behind, and the VPL sends
/// nothing. The position stands off its surface as far as rays that leave it (triangle_stand_off()).
typedef struct Vpl {
    Vec3 position;
    uint depth;  // 1: lit directly by an emitter; 2: after one more bounce, …; 0: lit by light of all depths
    Vec3 normal;
    uint flags;
    Vec3 power;
    uint shading;  // shading normal as pack_direction() packs it; for sending, only with NEARLIGHT_VPL_TILTED
} Vpl;
#define NEARLIGHT_VPL_CLOSE 1u   // lies in the close range
#define NEARLIGHT_VPL_MAPPED 4u  // a normal or bump map tilts the shading normal
#define NEARLIGHT_VPL_TILTED 8u  // the shading normal is another than `normal`
// Bits 8 to 31 of Vpl.flags hold the row of the transmission curve.
#define NEARLIGHT_VPL_CURVE_SHIFT 8

/// A receiver of the camera that sends importance into the hemisphere of `normal`, as a VPL sends light:
/// `response` is the camera's response to what the receiver reflects (albedo times the weight of the camera
/// path), so that a gather from importons tells what a VPL would bring to the camera. It has the members of a
/// Vpl in the same places, so that one kernel gathers from either.
typedef struct Importon {
    Vec3 position;
    uint pad0;
    Vec3 normal;
    uint flags;
    Vec3 response;
    float pad1;
} Importon;
// Importon.flags: a gather sums squares of its geometry terms, and `response` is its own square ÷ π.
#define NEARLIGHT_IMPORTON_SQUARED 2u

/// A point placed on a triangle, on the surface itself.
typedef struct SurfaceSample {
    Vec3 position;
    uint triangle;  // index into the scene's triangle array
    Vec3 normal;    // unit vector on the front
    float u;        // weights of the triangle's v1 and v2
    float v;
    float pad0, pad1, pad2;
} SurfaceSample;

/// Receivers are stored in packets of 64 (those of a tile of pixels, or 64 neighbours on a curve), component
/// by component, so that a vector unit loads 16 of them at once. A zero normal marks an absent receiver. The
/// position stands off its surface as far as rays that leave it (triangle_stand_off()).
#define NEARLIGHT_PACKET_SIZE 64
#define NEARLIGHT_BUNDLE_PACKETS 4  // max packets of a bundle (lib/bundle.cl)
typedef struct ReceiverPacket {
    float px[NEARLIGHT_PACKET_SIZE], py[NEARLIGHT_PACKET_SIZE], pz[NEARLIGHT_PACKET_SIZE];
    float nx[NEARLIGHT_PACKET_SIZE], ny[NEARLIGHT_PACKET_SIZE], nz[NEARLIGHT_PACKET_SIZE];
    uint surface[NEARLIGHT_PACKET_SIZE];
    uint mesh_normal[NEARLIGHT_PACKET_SIZE];  // pack_direction() of the mesh's normal where a map tilts the
                                              // receiver's own; 0: no map. Of an absent receiver that shows
                                              // in the layers of surfaces, its own normal
    uint sequence[NEARLIGHT_PACKET_SIZE];     // key of the random numbers that the receiver shares with
                                              // others of its pixel; 0: it has numbers of its own
} ReceiverPacket;
// ReceiverPacket.surface: the row of the transmission curve that weighs arriving light in bits 0 to 15, the
// number of surfaces between the camera and the receiver in bits 16 to 23, and above them which of the
// receivers with the same `sequence` it is.
#define NEARLIGHT_RECEIVER_CURVE_MASK 0xffffu
#define NEARLIGHT_RECEIVER_SURFACES_SHIFT 16
#define NEARLIGHT_RECEIVER_SURFACES_MASK 0xffu
#define NEARLIGHT_RECEIVER_SAMPLE_SHIFT 24
#define NEARLIGHT_SEQUENCE_RECEIVERS 256u  // max receivers with the same `sequence`

/// A tile is a square of pixels, this many on each side, that fills a packet row by row. Tiles cover the
/// picture from its top left corner; those at the right and the bottom may reach beyond it.
#define NEARLIGHT_TILE_SIZE 8

/// How many tiles cover this many pixels of a row or a column of the picture.
NEARLIGHT_SHARED_FUNCTION uint tiles_across(uint pixels) {
    return (pixels + NEARLIGHT_TILE_SIZE - 1) / NEARLIGHT_TILE_SIZE;
}

/// Irradiance (W/m²) of the receivers of a packet.
typedef struct IrradiancePacket {
    float r[NEARLIGHT_PACKET_SIZE], g[NEARLIGHT_PACKET_SIZE], b[NEARLIGHT_PACKET_SIZE];
} IrradiancePacket;

/// Importance of the receivers of a packet: the sum over importons of response/π times the geometry term and
/// visibility, R, G and B.
typedef struct ImportancePacket {
    float r[NEARLIGHT_PACKET_SIZE], g[NEARLIGHT_PACKET_SIZE], b[NEARLIGHT_PACKET_SIZE];
} ImportancePacket;

/// One launch of a gather (gather_packets.cl, gather_rays.cl): which receivers ask about which VPLs or
/// importons, and what is summed.
typedef struct GatherParams {
    uint first_vpl, end_vpl;        // range of VPLs in each bundle's stratum, or in its list
    uint vpl_count;                 // VPLs of the whole set
    uint packet_count;              // packets of receivers
    uint first_bundle, end_bundle;  // range of bundles of this launch
    float clamp_radius_squared;     // square of the clamp radius, m²
    uint group_size;                // VPLs that are summed by themselves; 0: all VPLs make one sum
    uint has_thresholds;            // 1: pairs below the threshold of their receiver are left out
    uint first_listed_bundle;       // first bundle with a list, where bundles have lists of VPLs
    uint list_stride;               // entries from one bundle's list to the next
    uint has_curves;                // 1: some surface has a transmission curve
    uint has_maps;                  // 1: some surface has a normal or bump map
    uint strata;                    // strata of the set; 1: every bundle asks about the whole set
    uint stratum_period;            // bundles after which their strata repeat
    uint pad0;
} GatherParams;

/// Visibility is tested strictly between these fractions of the segment from a VPL to a receiver. Both ends
/// stand off their surfaces already; the margins keep rounding at the ends from counting as hits. They must
/// not be large: a segment to the sky is as long as the scene, and what lies within its margins casts no
/// shadow, of which warn_of_width() warns.
#define NEARLIGHT_SEGMENT_T_MIN 1e-6f
#define NEARLIGHT_SEGMENT_T_MAX (1.0f - 1e-6f)
/// A ray that goes straight on beyond a surface skips the distance by which rays stand off it, divided by its
/// cosine to the normal, or by this if that is less.
#define NEARLIGHT_MIN_GRAZING_COSINE (1.0f / 32)

/// What a camera sample finds at the end of its path through glass and mirrors. There is one for each
/// receiver.
typedef struct CameraVertex {
    Vec3 throughput;  // weight of light leaving the first diffuse surface towards the camera
    float depth;      // distance from the camera to the first surface seen, m; 0: no surface
    Vec3 albedo;      // Lambertian albedo of the first diffuse surface
    uint flags;
    // Radiance that the camera path brings on its own: of lights and the environment that it meets, and of
    // what surfaces on the way reflect of them by S.
    Vec3 camera_light;
    float filter_weight;  // weight of the sample's light in its pixel; negative in negative lobes
    // Radiance of a receiver that is absent because it weighs little or has few edges left (CameraLimits).
    // The direct one also has what the first surface reflects by S of the sky that its bundle found
    // (shared_sky.cl).
    Vec3 traced_direct;
    float film_x;  // of the sample, from the middle of its pixel, pixels to the right
    Vec3 traced_indirect;
    float film_y;  // of the sample, from the middle of its pixel, pixels downwards
} CameraVertex;
#define NEARLIGHT_VERTEX_CLOSE 1u      // the diffuse surface lies in the close range
#define NEARLIGHT_VERTEX_OWN_PIXEL 2u  // the sample lies on the square of its own pixel

/// The close range: the points inside the view frustum and nearer to the camera than `range`. A point p is
/// inside where dot(plane.xyz, p − origin) + w ≥ 0 for each of the five planes.
typedef struct CloseRange {
    float planes[5][4];
    Vec3 origin;
    float range;  // m
} CloseRange;

/// Numbers that every ray kernel needs.
typedef struct SceneInfo {
    uint triangle_count;
    uint emitter_count;
    uint delta_emitter_count;   // delta lights: the first entries of the table
    float extent;               // largest side of the scene's bounds, m
    Vec3 size;                  // sides of the bounds, m
    uint has_specular;          // 1: some surface reflects other than by a Lambertian part
    uint has_curves;            // 1: some surface has a transmission curve
    uint tree_first, tree_end;  // the lights of the tree of lights: entries of the table; equal: no tree
    uint has_maps;              // 1: some surface has a normal or bump map
    uint veils;                 // what lets light pass straight on: NEARLIGHT_VEILS_…
    uint has_sky;               // 1: there is an environment map or a sun
} SceneInfo;
#define NEARLIGHT_VEILS_NONE 0u   // nothing
#define NEARLIGHT_VEILS_THIN 1u   // thin panes, masks and `null`, but not the light of delta lights
#define NEARLIGHT_VEILS_OPEN 2u   // thin panes, masks and `null`, and the light of delta lights too
#define NEARLIGHT_VEILS_CLEAR 3u  // smooth glass bodies too (--glass clear)
/// A shadow ray passes at most this many veils; rays that follow BSDFs pass any number.
#define NEARLIGHT_MAX_VEILS 16

#ifdef __cplusplus
#define NEARLIGHT_CHECK_SHARED(Type, bytes)                                      \
    static_assert(sizeof(Type) == (bytes) && alignof(Type) == 4, #Type " size"); \
    static_assert(std::is_trivially_copyable_v<Type>, #Type " must be plain data")
static_assert(sizeof(Vec3) == 12);
static_assert(NEARLIGHT_TILE_SIZE * NEARLIGHT_TILE_SIZE == NEARLIGHT_PACKET_SIZE, "a tile fills a packet");
NEARLIGHT_CHECK_SHARED(BvhNode, 64);
NEARLIGHT_CHECK_SHARED(BvhTriangle, 48);
NEARLIGHT_CHECK_SHARED(WideNode, 224);
NEARLIGHT_CHECK_SHARED(TriangleBlock, 144);
NEARLIGHT_CHECK_SHARED(RayQuery, 32);
NEARLIGHT_CHECK_SHARED(RayHit, 16);
NEARLIGHT_CHECK_SHARED(Vertex, 32);
NEARLIGHT_CHECK_SHARED(Triangle, 16);
NEARLIGHT_CHECK_SHARED(Parameter, 16);
NEARLIGHT_CHECK_SHARED(Material, 272);
static_assert(offsetof(Material, roughness) == NEARLIGHT_PARAMETER_ROUGHNESS * sizeof(Parameter) &&
                  offsetof(Material, metallic) == NEARLIGHT_PARAMETER_METALLIC * sizeof(Parameter) &&
                  offsetof(Material, clearcoat_gloss) ==
                      NEARLIGHT_PARAMETER_CLEARCOAT_GLOSS * sizeof(Parameter),
              "parameters are numbered in the order of the members");
NEARLIGHT_CHECK_SHARED(Texture, 96);
NEARLIGHT_CHECK_SHARED(Camera, 1136);
NEARLIGHT_CHECK_SHARED(Vpl, 48);
NEARLIGHT_CHECK_SHARED(Importon, 48);
static_assert(offsetof(Importon, normal) == offsetof(Vpl, normal) &&
                  offsetof(Importon, flags) == offsetof(Vpl, flags) &&
                  offsetof(Importon, response) == offsetof(Vpl, power),
              "a gather reads an Importon as a Vpl");
NEARLIGHT_CHECK_SHARED(SurfaceSample, 48);
NEARLIGHT_CHECK_SHARED(ReceiverPacket, 2304);
NEARLIGHT_CHECK_SHARED(IrradiancePacket, 768);
NEARLIGHT_CHECK_SHARED(ImportancePacket, 768);
NEARLIGHT_CHECK_SHARED(GatherParams, 64);
NEARLIGHT_CHECK_SHARED(CameraVertex, 80);
NEARLIGHT_CHECK_SHARED(CloseRange, 96);
NEARLIGHT_CHECK_SHARED(SceneInfo, 56);
}  // namespace nearlight::core
#endif

#endif
