// SPDX-License-Identifier: Apache-2.0
// Where receivers aim to find the light of lamps that mirrors and glass send to them (lib/caustic_aim.cl).
#ifndef NEARLIGHT_SHARED_CAUSTIC_AIMS_H
#define NEARLIGHT_SHARED_CAUSTIC_AIMS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// The end of a walk from a light that met mirrors and glass before it landed on a Lambertian surface.
typedef struct CausticLanding {
    Vec3 place;
    Vec3 target;    // where the walk met the last of them
    uint is_there;  // 0: the walk did not land so, and the rest says nothing
} CausticLanding;

/// A cube of space, and the targets that receivers in it have. Cells of level l have half the side of those
/// of level l − 1.
typedef struct CausticCell {
    int x, y, z;  // floor of the coordinates ÷ the side
    uint level;
    uint first;  // place of its first target in the list of targets
    uint count;  // number of its targets; 0: the entry of the table is free
} CausticCell;
#define NEARLIGHT_MAX_CAUSTIC_TARGETS 16u  // of a cell
#define NEARLIGHT_CAUSTIC_LEVELS 10u
/// Rays of a receiver by which it learns what aiming gains.
#define NEARLIGHT_CAUSTIC_ERROR_RAYS 8u

/// The cells stand in a table of `size` entries, a power of two: each at the hash of its coordinates and
/// level, or at the next free entry from there.
typedef struct CausticTable {
    uint size;   // 0: there are no cells
    float side;  // of the cells of level 0, m
} CausticTable;

/// Where the search for a cell begins in the table, modulo its size.
NEARLIGHT_SHARED_FUNCTION uint caustic_hash(int x, int y, int z, uint level) {
    return (uint)x * 73856093u ^ (uint)y * 19349663u ^ (uint)z * 83492791u ^ level * 2654435761u;
}

/// The coordinate along one axis of the cell that a place moved by `shift` sides lies in. It is bounded for
/// the sake of scenes that lie far from the origin.
NEARLIGHT_SHARED_FUNCTION int caustic_coordinate(float position, float side, float shift) {
    const float scaled = position / side + shift;
    const float limited = scaled > 1e9f ? 1e9f : scaled < -1e9f ? -1e9f : scaled;
    const int rounded = (int)limited;
    return (float)rounded > limited ? rounded - 1 : rounded;
}

#ifdef __cplusplus
NEARLIGHT_CHECK_SHARED(CausticLanding, 28);
NEARLIGHT_CHECK_SHARED(CausticCell, 24);
NEARLIGHT_CHECK_SHARED(CausticTable, 8);
}  // namespace nearlight::core
#endif

#endif
