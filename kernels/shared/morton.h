// SPDX-License-Identifier: Apache-2.0
// The grid of Morton codes (lib/morton.cl).
#ifndef NEARLIGHT_SHARED_MORTON_H
#define NEARLIGHT_SHARED_MORTON_H

#define NEARLIGHT_MORTON_CELLS 1024.0f  // cells along each axis

#endif
