// SPDX-License-Identifier: Apache-2.0
#include "host/cl/shared_layout.h"

#include <cstddef>

#include "kernels/shared/bsdf_query.h"
#include "kernels/shared/camera_pass.h"
#include "kernels/shared/caustic_aims.h"
#include "kernels/shared/film_layers.h"
#include "kernels/shared/layout_facts.h"
#include "kernels/shared/light.h"
#include "kernels/shared/light_cut.h"
#include "kernels/shared/light_tracer.h"
#include "kernels/shared/local_lights.h"
#include "kernels/shared/packet_order.h"
#include "kernels/shared/receiver_paths.h"
#include "kernels/shared/shared_light.h"
#include "kernels/shared/splats.h"
#include "kernels/shared/types.h"
#include "kernels/shared/walk_aim.h"

namespace nearlight::core {

#define SIZE(Type) {#Type " size", sizeof(Type)},
#define OFFSET(Type, member) {#Type "." #member, offsetof(Type, member)},
#define VALUE(expression) {#expression, expression},
#define LAYER_PLACES(constant, name, channels, samples, passes, files, storage) \
    VALUE(NEARLIGHT_LAYER_##constant) VALUE(NEARLIGHT_SUM_##constant)

std::vector<LayoutFact> shared_layout() {
    return {NEARLIGHT_LAYOUT_FACTS(SIZE, OFFSET, VALUE) NEARLIGHT_FILM_LAYERS(LAYER_PLACES)};
}

#undef LAYER_PLACES
#undef VALUE
#undef OFFSET
#undef SIZE

}  // namespace nearlight::core
