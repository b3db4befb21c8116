// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/material_maker.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "host/scene/mitsuba/values.h"
#include "host/scene/reflectance.h"
#include "host/scene/scene_names.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr const char* kNested =
    "twosided, mask, bumpmap, normalmap, blendbsdf, mixturebsdf, coating, roughcoating, null";

/// Whether there is a normal or bump map within a BSDF, which must not contain itself.
bool holds_map(const Object& bsdf) {
    return std::ranges::any_of(bsdf.nested("bsdf"), [](const Object* nested) {
        return nested->type == "bumpmap" || nested->type == "normalmap" || holds_map(*nested);
    });
}

[[noreturn]] void fail_nesting(const Object& bsdf) {
    fail(bsdf.where, "bsdf '" + bsdf.type + "' contains itself, or more than " +
                         std::to_string(NEARLIGHT_MAX_BSDF_NESTING) + " bsdfs lie within each other");
}

/// How far the weights of a mixture may be from a sum of 1 that is meant.
constexpr double kWeightTolerance = 1e-6;

/// The weights of a mixture of `count` BSDFs, whose sum is at most 1.
std::vector<double> mixture_weights(const Object& mixture, std::size_t count, NoteSink& notes) {
    std::vector<double> weights = parse_numbers(mixture.required_string("weights"), mixture.where);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const bool is_negative = std::ranges::any_of(weights, [](double weight) { return !(weight >= 0.0); });
    if (count == 0 || weights.size() != count || is_negative || !(sum > 0.0 && std::isfinite(sum))) {
        fail(mixture.where,
             "'mixturebsdf' needs nested bsdfs and a weight in 'weights' for each of them, none below 0");
    }
    if (sum > 1.0 + kWeightTolerance) {
        note(notes, mixture.where, "the sum of 'weights' is above 1; they are scaled to a sum of 1");
        for (double& weight : weights) {
            weight /= sum;
        }
    }
    return weights;
}

}  // namespace

uint MaterialMaker::index(const Object* bsdf, const Parameter& emission) {
    const Vec3 e = emission.value;
    const auto [entry, is_new] =
        indices_.try_emplace({bsdf, {e.x, e.y, e.z, static_cast<float>(emission.texture)}}, 0u);
    if (!is_new) {
        return entry->second;
    }
    entry->second = bsdf != nullptr && is_zero(e) ? make(*bsdf, 0) : make_shining(bsdf, emission);
    if (bsdf != nullptr) {
        name(*bsdf, entry->second);
    }
    return entry->second;
}

uint MaterialMaker::make_shining(const Object* bsdf, const Parameter& emission) {
    const float grey = is_zero(emission.value) ? 0.5f : 0.0f;
    Material material =
        bsdf == nullptr ? diffuse_material(Vec3{1, 1, 1} * grey) : scene_.materials[make(*bsdf, 0)];
    material.emission = emission;
    return add(material);
}

void MaterialMaker::name(const Object& bsdf, uint material) {
    const Object* named = &bsdf;
    for (std::vector<const Object*> inner = bsdf.nested("bsdf"); named->id.empty() && inner.size() == 1;
         inner = named->nested("bsdf")) {
        named = inner.front();
    }
    const auto [number, is_new] = numbers_.try_emplace(&bsdf, numbers_.size() + 1);
    name_material(scene_, material, name_or_number(named->id, bsdf.type, number->second));
}

uint MaterialMaker::add(const Material& material) {
    scene_.materials.push_back(material);
    return static_cast<uint>(scene_.materials.size() - 1);
}

uint MaterialMaker::make(const Object& bsdf, int depth) {
    if (depth > NEARLIGHT_MAX_BSDF_NESTING) {
        fail_nesting(bsdf);
    }
    if (const auto found = made_.find(&bsdf); found != made_.end()) {
        return found->second;
    }
    const uint index = make_new(bsdf, depth);
    // Those of the BSDFs within it that were made before did not count how many lie around them.
    if (nesting(scene_, scene_.materials[index]) > NEARLIGHT_MAX_BSDF_NESTING) {
        fail_nesting(bsdf);
    }
    bsdf.report_unused(notes_);
    made_.emplace(&bsdf, index);
    return index;
}

uint MaterialMaker::make_new(const Object& bsdf, int depth) {
    const std::string& type = bsdf.type;
    if (const std::optional<Material> material = models_.make(bsdf)) {
        return add(*material);
    }
    if (type == "null") {
        return add(plain_material(NEARLIGHT_BSDF_NULL));
    }
    if (type == "twosided") {
        return make_twosided(bsdf, depth);
    }
    if (type == "mask") {
        return make_mask(bsdf, depth);
    }
    if (type == "blendbsdf") {
        return make_blend(bsdf, depth);
    }
    if (type == "mixturebsdf") {
        return make_mixture(bsdf, depth);
    }
    if (type == "coating" || type == "roughcoating") {
        return make_coating(bsdf, depth);
    }
    if (type == "bumpmap" || type == "bump") {
        return make_bump(bsdf, depth);
    }
    if (type == "normalmap") {
        return make_normal_map(bsdf, depth);
    }
    fail_unknown_type(bsdf, std::string(SurfaceModels::kNames) + ", " + kNested);
}

uint MaterialMaker::make_nested(const Object& wrapper, int depth) {
    const std::vector<const Object*> nested = wrapper.nested("bsdf");
    if (nested.size() != 1) {
        fail(wrapper.where, "bsdf '" + wrapper.type + "' needs one nested bsdf");
    }
    return make(*nested.front(), depth + 1);
}

uint MaterialMaker::make_twosided(const Object& bsdf, int depth) {
    const std::vector<const Object*> nested = bsdf.nested("bsdf");
    if (nested.empty() || nested.size() > 2) {
        fail(bsdf.where, "'twosided' needs one or two nested bsdfs");
    }
    const bool allows_transmission = bsdf.boolean("allow_transmission", false);
    const uint front = make(*nested.front(), depth + 1);
    const uint back = make(*nested.back(), depth + 1);
    const auto is_glass = [&](uint index) {
        return lets_through(scene_, scene_.materials[index]) &&
               !passes_straight(scene_, scene_.materials[index]);
    };
    if ((is_glass(front) || is_glass(back)) && !allows_transmission) {
        note(notes_, bsdf.where, "'twosided' has no effect on a bsdf that lets light through");
        return front;
    }
    return add(two_sided_material(front, back));
}

uint MaterialMaker::make_mask(const Object& bsdf, int depth) {
    const Parameter opacity = textures_.number(bsdf, "opacity", 0.5f);
    return add(mask_material(opacity, make_nested(bsdf, depth)));
}

uint MaterialMaker::make_blend(const Object& bsdf, int depth) {
    const std::vector<const Object*> nested = bsdf.nested("bsdf");
    if (nested.size() != 2) {
        fail(bsdf.where, "'blendbsdf' needs two nested bsdfs");
    }
    const Parameter weight = textures_.number(bsdf, "weight", 0.5f);
    const uint first = make(*nested[0], depth + 1);
    return add(blend_material(weight, first, make(*nested[1], depth + 1)));
}

uint MaterialMaker::make_mixture(const Object& bsdf, int depth) {
    const std::vector<const Object*> nested = bsdf.nested("bsdf");
    const std::vector<double> weights = mixture_weights(bsdf, nested.size(), notes_);
    const double rest = 1.0 - std::accumulate(weights.begin(), weights.end(), 0.0);
    double sum = rest > kWeightTolerance ? rest : 0.0;
    uint all = sum > 0.0 ? add(diffuse_material({})) : 0;
    for (std::size_t i = nested.size(); i-- > 0;) {
        const uint one = make(*nested[i], depth + 1);
        const double others = sum;
        sum += weights[i];
        all = others > 0.0 ? add(blend_material(parameter_of(static_cast<float>(others / sum)), one, all))
                           : one;
    }
    return all;
}

uint MaterialMaker::make_coating(const Object& bsdf, int depth) {
    const Material below = scene_.materials[make_nested(bsdf, depth)];
    Varnish varnish = models_.make_varnish(bsdf);
    if (below.model == NEARLIGHT_BSDF_DIFFUSE) {
        varnish.coat.reflectance = below.reflectance;
        varnish.coat.reflectance.value = below.reflectance.value * varnish.transmittance;
        return add(varnish.coat);
    }
    if (below.model != NEARLIGHT_BSDF_CONDUCTOR) {
        fail(bsdf.where, "'" + bsdf.type + "' is only supported over diffuse bsdfs and metals");
    }
    note(notes_, bsdf.where,
         "the metal under '" + bsdf.type +
             "' gets light in all directions as it does straight through the coat");
    // The sum of two lobes is the blend of twice each.
    const auto passes = static_cast<float>(1.0 - dielectric_reflectance(1.0, double{varnish.coat.eta.x}));
    Material metal = below;
    metal.specular.value = below.specular.value * varnish.transmittance * (2.0f * passes * passes);
    varnish.coat.specular.value = varnish.coat.specular.value * 2.0f;
    const uint coat = add(varnish.coat);
    return add(blend_material(parameter_of(0.5f), coat, add(metal)));
}

uint MaterialMaker::make_bump(const Object& bsdf, int depth) {
    const std::vector<const Object*> textures = bsdf.nested("texture");
    if (textures.size() != 1) {
        fail(bsdf.where, "'" + bsdf.type + "' needs one nested texture");
    }
    const Parameter height =
        textures_.height(*textures.front(), static_cast<float>(bsdf.number("scale", 1.0)));
    return add(bump_map_material(height, make_under_map(bsdf, depth)));
}

uint MaterialMaker::make_normal_map(const Object& bsdf, int depth) {
    const Parameter normals = textures_.normals(bsdf);
    return add(normal_map_material(normals, make_under_map(bsdf, depth)));
}

uint MaterialMaker::make_under_map(const Object& map, int depth) {
    for (const char* name : {"flip_invalid_normals", "use_shadowing_function"}) {
        if (!map.boolean(name, true)) {
            note(notes_, map.find(name)->where, std::string("'") + name + "' is always true");
        }
    }
    const uint child = make_nested(map, depth);
    if (holds_map(map)) {
        note(notes_, map.where,
             "there is another map within this '" + map.type +
                 "': both tilt the normal, but only the inner one shadows light");
    }
    return child;
}

}  // namespace nearlight::core::mitsuba
