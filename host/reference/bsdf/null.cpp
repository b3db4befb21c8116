// SPDX-License-Identifier: Apache-2.0
// No surface: all light goes straight on.
#include "host/reference/bsdf/bsdf_model.h"

namespace nearlight::core {
namespace {

Vec3d eval_null(const BsdfParameters&, Vec3d, Vec3d) {
    return {};
}

double pdf_null(const BsdfParameters&, Vec3d, Vec3d) {
    return 0;
}

BsdfDraw sample_null(const BsdfParameters&, Vec3d wo, BsdfRandom) {
    return {.wi = -wo, .weight = {1, 1, 1}, .is_delta = true, .is_straight = true};
}

Vec3d estimate_null(const BsdfParameters&, Vec3d) {
    return {1, 1, 1};
}

}  // namespace

const SpecularModel kNullModel{eval_null, pdf_null, sample_null, estimate_null};

}  // namespace nearlight::core
