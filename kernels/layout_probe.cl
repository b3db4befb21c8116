// SPDX-License-Identifier: Apache-2.0
// Writes the facts of shared/layout_facts.h as the device has them: one uint for each fact, in the order of
// the list, then the first channel and the first sum of each film layer. Launched with a single work-item.

#include "shared/bsdf_query.h"
#include "shared/camera_pass.h"
#include "shared/caustic_aims.h"
#include "shared/film_layers.h"
#include "shared/layout_facts.h"
#include "shared/light.h"
#include "shared/light_cut.h"
#include "shared/light_tracer.h"
#include "shared/local_lights.h"
#include "shared/packet_order.h"
#include "shared/receiver_paths.h"
#include "shared/shared_light.h"
#include "shared/splats.h"
#include "shared/types.h"
#include "shared/walk_aim.h"

#define SIZE(Type) *out++ = (uint)sizeof(Type);
// The offset is that of a member from its struct, for which any address but 0 serves: some devices keep a
// null pointer as another number.
#define OFFSET(Type, member) \
    *out++ = (uint)((global const char*)&((global const Type*)some)->member - (global const char*)some);
#define VALUE(expression) *out++ = (uint)(expression);
#define LAYER_PLACES(constant, name, channels, samples, passes, files, storage) \
    VALUE(NEARLIGHT_LAYER_##constant)                                           \
    VALUE(NEARLIGHT_SUM_##constant)

kernel void layout_probe(global uint* out) {
    const global uint* const some = out;
    NEARLIGHT_LAYOUT_FACTS(SIZE, OFFSET, VALUE)
    NEARLIGHT_FILM_LAYERS(LAYER_PLACES)
}
