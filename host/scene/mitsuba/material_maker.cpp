// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/material_maker.h"

#include "host/scene/material_model.h"
#include "host/scene/mitsuba/optics_tables.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr int kMaxBsdfDepth = 32;  // BSDFs within BSDFs; only a cycle of references goes deeper

constexpr const char* kKnown =
    "diffuse, roughdiffuse, plastic, roughplastic, conductor, roughconductor, dielectric, thindielectric, "
    "roughdielectric, principled, twosided, mask, bumpmap, normalmap, blendbsdf";

bool is_lambertian(const Material& m) {
    return m.lobe == NEARLIGHT_LOBE_NONE && m.base_texture < 0;
}

}  // namespace

uint MaterialMaker::index(const Object* bsdf, Vec3 emission) {
    const auto [entry, is_new] = indices_.try_emplace({bsdf, {emission.x, emission.y, emission.z}}, 0u);
    if (!is_new) {
        return entry->second;
    }
    Material material = bsdf == nullptr ? diffuse_material({0.5f, 0.5f, 0.5f}) : make(*bsdf, 0);
    material.emission = emission;
    entry->second = static_cast<uint>(scene_.materials.size());
    scene_.materials.push_back(material);
    return entry->second;
}

Material MaterialMaker::make(const Object& bsdf, int depth) {
    if (const auto found = made_.find(&bsdf); found != made_.end()) {
        return found->second;
    }
    if (depth > kMaxBsdfDepth) {
        fail(bsdf.where, "bsdf '" + bsdf.type + "' contains itself");
    }
    const std::string& type = bsdf.type;
    Material material{};
    if (type == "diffuse" || type == "roughdiffuse") {
        material = make_diffuse(bsdf);
    } else if (type == "plastic" || type == "roughplastic") {
        material = make_plastic(bsdf);
    } else if (type == "conductor" || type == "roughconductor") {
        material = make_conductor(bsdf);
    } else if (type == "dielectric" || type == "roughdielectric" || type == "thindielectric") {
        material = make_glass(bsdf, type == "thindielectric");
    } else if (type == "principled") {
        material = make_principled(bsdf);
    } else if (type == "twosided") {
        material = make_twosided(bsdf, depth);
    } else if (type == "mask") {
        material = make_mask(bsdf, depth);
    } else if (type == "blendbsdf") {
        material = make_blend(bsdf, depth);
    } else if (type == "bumpmap" || type == "normalmap" || type == "bump") {
        note(notes_, bsdf.where, "bump and normal maps are left out");
        bsdf.ignore_nested("texture");
        bsdf.ignore({"scale"});
        material = make_nested(bsdf, depth);
    } else {
        fail_unknown_type(bsdf, kKnown);
    }
    bsdf.report_unused(notes_);
    made_.emplace(&bsdf, material);
    return material;
}

Material MaterialMaker::make_nested(const Object& wrapper, int depth) {
    const std::vector<const Object*> nested = wrapper.nested("bsdf");
    if (nested.empty()) {
        fail(wrapper.where, "bsdf '" + wrapper.type + "' needs a nested bsdf");
    }
    return make(*nested.front(), depth + 1);
}

Material MaterialMaker::make_twosided(const Object& bsdf, int depth) {
    if (bsdf.nested("bsdf").size() > 1) {
        note(notes_, bsdf.where, "'twosided' has two bsdfs; the first one is used for both sides");
    }
    Material material = make_nested(bsdf, depth);
    material.flags |= NEARLIGHT_MATERIAL_TWO_SIDED;
    return material;
}

Material MaterialMaker::make_mask(const Object& bsdf, int depth) {
    const float opacity = luminance(textures_.mean_reflectance(bsdf, "opacity", {0.5f, 0.5f, 0.5f}));
    note(notes_, bsdf.where,
         "'mask' becomes either opaque or invisible, whichever is closer to its mean opacity");
    const Material opaque = make_nested(bsdf, depth);
    return opacity >= 0.5f ? opaque : glass_material(1.0, true);
}

Material MaterialMaker::make_blend(const Object& bsdf, int depth) {
    const float weight = luminance(textures_.mean_reflectance(bsdf, "weight", {0.5f, 0.5f, 0.5f}));
    const std::vector<const Object*> nested = bsdf.nested("bsdf");
    if (nested.size() != 2) {
        fail(bsdf.where, "'blendbsdf' needs two nested bsdfs");
    }
    Material first = make(*nested[0], depth + 1);
    const Material second = make(*nested[1], depth + 1);
    if (is_lambertian(first) && is_lambertian(second) && first.flags == second.flags) {
        first.base = first.base * (1.0f - weight) + second.base * weight;
        return first;
    }
    note(notes_, bsdf.where, "'blendbsdf' is replaced by the bsdf that has the larger weight");
    return weight < 0.5f ? first : second;
}

Material MaterialMaker::make_diffuse(const Object& bsdf) {
    if (bsdf.type == "roughdiffuse") {
        note(notes_, bsdf.where, "'roughdiffuse' is replaced by 'diffuse'");
        bsdf.ignore({"alpha", "use_fast_approx"});
    }
    const bool old_name = bsdf.has("diffuse_reflectance");
    const auto [color, texture] =
        textures_.reflectance(bsdf, old_name ? "diffuse_reflectance" : "reflectance", {0.5f, 0.5f, 0.5f});
    Material material = diffuse_material(color);
    material.base_texture = texture;
    return material;
}

double MaterialMaker::index_of_refraction(const Object& bsdf, const std::string& name, double fallback) {
    const Property* property = bsdf.find(name);
    if (property == nullptr) {
        return fallback;
    }
    double index = 0.0;
    if (std::holds_alternative<std::string>(property->value)) {
        const std::string material = bsdf.string(name, "");
        const std::optional<double> found = find_index_of_refraction(material);
        if (!found) {
            fail(property->where, "no index of refraction is known for '" + material + "'");
        }
        index = *found;
    } else {
        index = bsdf.number(name, fallback);
    }
    if (!(index > 0.0)) {
        fail(property->where, "'" + name + "' should be greater than 0");
    }
    return index;
}

float MaterialMaker::roughness(const Object& bsdf) {
    if (!bsdf.type.starts_with("rough")) {
        return 0.0f;
    }
    if (bsdf.string("distribution", "beckmann") != "ggx") {
        note(notes_, bsdf.where, "the microfacet distribution is replaced by GGX with the same alpha");
    }
    bsdf.ignore({"sample_visible"});
    const bool anisotropic = bsdf.has("alpha_u") || bsdf.has("alpha_v");
    const double alpha =
        anisotropic ? 0.5 * (bsdf.number("alpha_u", 0.1) + bsdf.number("alpha_v", 0.1))
                    : static_cast<double>(textures_.color(bsdf, "alpha", Vec3{0.1f, 0.1f, 0.1f}, false).x);
    if (anisotropic) {
        note(notes_, bsdf.where, "anisotropic roughness is replaced by its mean");
    }
    return static_cast<float>(std::clamp(alpha, 0.0, 1.0));
}

Material MaterialMaker::make_plastic(const Object& bsdf) {
    const auto [color, texture] = textures_.reflectance(bsdf, "diffuse_reflectance", {0.5f, 0.5f, 0.5f});
    const Vec3 specular = textures_.mean_reflectance(bsdf, "specular_reflectance", {1, 1, 1});
    const double eta =
        index_of_refraction(bsdf, "int_ior", 1.49) / index_of_refraction(bsdf, "ext_ior", 1.000277);
    Material material =
        coat_material(color, specular, eta, roughness(bsdf), bsdf.boolean("nonlinear", false));
    material.base_texture = texture;
    return material;
}

Material MaterialMaker::make_conductor(const Object& bsdf) {
    const Vec3 specular = textures_.mean_reflectance(bsdf, "specular_reflectance", {1, 1, 1});
    // Without a material, Mitsuba 0.6 takes copper, and Mitsuba 3 a perfect mirror.
    const std::string name = bsdf.string("material", "none");
    const std::optional<Metal> metal = find_metal(name);
    if (!metal) {
        fail(bsdf.find("material")->where, "unknown metal '" + name + "'; give eta and k instead");
    }
    const bool given = bsdf.has("eta") || bsdf.has("k");
    Vec3 eta = given ? textures_.color(bsdf, "eta", {0, 0, 0}, false) : metal->eta;
    Vec3 k = given ? textures_.color(bsdf, "k", {1, 1, 1}, false) : metal->k;
    const auto outside = static_cast<float>(index_of_refraction(bsdf, "ext_eta", 1.0));
    return conductor_material(eta / outside, k / outside, specular, roughness(bsdf));
}

Material MaterialMaker::make_glass(const Object& bsdf, bool thin) {
    const double eta =
        index_of_refraction(bsdf, "int_ior", 1.5046) / index_of_refraction(bsdf, "ext_ior", 1.000277);
    Material material = glass_material(eta, thin);
    material.roughness = roughness(bsdf);
    material.specular = textures_.mean_reflectance(bsdf, "specular_reflectance", {1, 1, 1});
    material.transmission = textures_.mean_reflectance(bsdf, "specular_transmittance", {1, 1, 1});
    return material;
}

// Makes metal if the BSDF is mostly metallic, glass if it mostly transmits, otherwise a base under a coat.
Material MaterialMaker::make_principled(const Object& bsdf) {
    note(notes_, bsdf.where, "'principled' is approximated by metal, glass, or a base under a coat");
    bsdf.ignore({"anisotropic", "sheen", "sheen_tint", "flatness", "spec_tint", "clearcoat",
                 "clearcoat_gloss", "diffuse_reflectance_sampling_rate", "main_specular_sampling_rate",
                 "clearcoat_sampling_rate"});
    const float rough = textures_.mean_reflectance(bsdf, "roughness", {0.5f, 0.5f, 0.5f}).x;
    const float alpha = std::max(1e-3f, rough * rough);
    const float metallic = textures_.mean_reflectance(bsdf, "metallic", {0, 0, 0}).x;
    const float transmission = textures_.mean_reflectance(bsdf, "spec_trans", {0, 0, 0}).x;
    const double specular = bsdf.number("specular", 0.5);
    const double eta = bsdf.has("eta") ? bsdf.number("eta", 1.5)
                                       : 2.0 / (1.0 - std::sqrt(std::clamp(0.08 * specular, 0.0, 0.9))) - 1.0;
    if (metallic >= 0.5f) {
        const Vec3 color = textures_.mean_reflectance(bsdf, "base_color", {0.5f, 0.5f, 0.5f});
        const auto index = [](float reflectance) {
            const float root = std::sqrt(std::min(reflectance, 0.98f));
            return (1.0f + root) / (1.0f - root);
        };
        return conductor_material({index(color.x), index(color.y), index(color.z)}, {0, 0, 0}, {1, 1, 1},
                                  alpha);
    }
    if (transmission >= 0.5f) {
        Material material = glass_material(eta, false);
        material.roughness = alpha;
        material.transmission = textures_.mean_reflectance(bsdf, "base_color", {0.5f, 0.5f, 0.5f});
        return material;
    }
    const auto [color, texture] = textures_.reflectance(bsdf, "base_color", {0.5f, 0.5f, 0.5f});
    Material material = coat_material(color * (1.0f - metallic), {1, 1, 1}, eta, alpha, false);
    material.base_texture = texture;
    return material;
}

}  // namespace nearlight::core::mitsuba
