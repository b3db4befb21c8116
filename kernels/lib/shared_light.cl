// SPDX-License-Identifier: Apache-2.0
// Lights that a bundle of receivers shares (shared_lights.cl): who shares, how a receiver keeps one of those
// that its rays find, and how a light and a receiver connect.
#ifndef NEARLIGHT_LIB_SHARED_LIGHT
#define NEARLIGHT_LIB_SHARED_LIGHT

#include "lib/bundle.cl"
#include "lib/vpl.cl"
#include "shared/shared_light.h"

#define BUNDLE_WORDS (BUNDLE_RECEIVERS / 32)  // of a mask with one bit for each receiver of a bundle

/// Light over so many edges is too weak for a few edges more or less to matter.
#define LONG_PATH 32u

/// Whether a receiver shares lights with its bundle: it is present, no map tilts its normal, and its paths
/// may be as long as those of the others. Receivers behind mirrors and panes have shorter ones.
static inline bool receiver_shares(const global ReceiverPacket* packet, uint lane, uint max_edges) {
    const float3 n = receiver_normal(packet, lane);
    return dot(n, n) > 0.0f && packet->mesh_normal[lane] == 0 &&
           (receiver_surfaces(packet, lane) == 0 || max_edges >= LONG_PATH);
}

static inline bool bundle_receiver_shares(const global ReceiverPacket* packets, const Bundle* bundle,
                                          uint lane, uint max_edges) {
    const uint packet = lane / NEARLIGHT_PACKET_SIZE;
    return packet < bundle->count &&
           receiver_shares(packets + bundle->first + packet, lane % NEARLIGHT_PACKET_SIZE, max_edges);
}

/// The light that a receiver keeps of those that its rays find: one drawn in proportion to their weights,
/// which stands for all of them.
typedef struct FoundLight {
    uint is_wanted;  // 1: lights are kept here, and the receiver does not get what they bring
    float sum;       // of the weights
    SharedLight light;
} FoundLight;

static inline FoundLight nothing_found(uint is_wanted) {
    FoundLight found;
    found.is_wanted = is_wanted;
    found.sum = 0.0f;
    found.light.position = found.light.normal = found.light.radiance = store3((float3)(0.0f));
    found.light.weight = 0.0f;
    found.light.curve = found.light.veils = 0;
    found.light.shading = 0;
    return found;
}

/// Takes one more light into the draw; `u` is uniform in [0, 1). Returns whether it is the one to be kept so
/// far.
static inline bool offer_light(FoundLight* found, const SharedLight* light, float u) {
    if (!(light->weight > 0.0f && light->weight < INFINITY)) {
        return false;
    }
    found->sum += light->weight;
    const bool is_kept = u * found->sum < light->weight;
    if (is_kept) {
        found->light = *light;
    }
    return is_kept;
}

/// The light that was drawn, as strong as it must be to stand for all.
static inline SharedLight kept_light(const FoundLight* found) {
    SharedLight light = found->light;
    if (found->sum > 0.0f) {
        light.radiance = store3(load3(light.radiance) * (found->sum / light.weight));
        light.weight = found->sum;
    }
    return light;
}

/// A light as a beam reads it. The struct SharedLight has the members that it needs in the places of those of
/// a Vpl.
static inline const global Vpl* as_vpl(const global SharedLight* light) {
    return (const global Vpl*)light;
}

/// A shared light and a receiver.
typedef struct SharedConnection {
    float geometry;  // cosθx·cosθy / r² (1/m²); 0 where no ray of the receiver could have found the light
    float part;      // of the light that VPLs do not bring: 1 − r²/R²; R is the greatest distance
    float cos_light, cos_receiver;  // to the shading normals
} SharedConnection;

/// Connects a light to a receiver at x with the normal n. Lights count up to the greatest distance, which is
/// the clamp radius where VPLs bring their light from there on, and infinite where VPLs bring none of it.
static inline SharedConnection connect_shared(const global SharedLight* light, float3 x, float3 n,
                                              float max_distance_squared) {
    const float3 d = x - load3(light->position);
    const float squared = dot(d, d);
    const float inverse = rsqrt(squared);
    const float height = dot(load3(light->normal), d);
    const float cosine = -dot(n, d);  // times the distance
    SharedConnection c;
    c.cos_light = dot(unpack_direction(light->shading), d) * inverse;
    c.cos_receiver = cosine * inverse;
    const bool open = height > 0.0f && cosine > 0.0f && squared < max_distance_squared && c.cos_light > 0.0f;
    const float geometry = height * cosine / (squared * squared);
    c.geometry = open && geometry < INFINITY ? geometry : 0.0f;
    c.part = 1.0f - squared / max_distance_squared;
    return c;
}

/// Whether a receiver of the bundle sees a light, of which `seen_by` has the BUNDLE_WORDS words of bits.
static inline bool is_seen_by(const global uint* seen_by, uint receiver) {
    return (seen_by[receiver / 32] >> receiver % 32 & 1) != 0;
}

/// What turns the radiance of a listed light into irradiance per geometry term: 1/probability of the draw
/// over the density of all rays of the bundle, of which `sum` is the sum of the geometry terms of all
/// receivers that see the light.
static inline float shared_factor(float inverse_probability, float sum, uint rays_per_receiver) {
    return sum > 0.0f ? inverse_probability * M_PI_F / ((float)rays_per_receiver * sum) : 0.0f;
}

#endif
