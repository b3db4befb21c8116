// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/surface_models.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/base/words.h"
#include "host/scene/mitsuba/optics_tables.h"
#include "host/scene/mitsuba/values.h"
#include "host/scene/number_pair.h"
#include "host/scene/reflectance.h"

namespace nearlight::core::mitsuba {
namespace {

// With indices closer to each other than this, refraction has no half-vector to speak of.
constexpr double kMinIndexStep = 1e-3;

bool starts_with_rough(const Object& bsdf) {
    return bsdf.type.starts_with("rough");
}

}  // namespace

std::optional<Material> SurfaceModels::make(const Object& bsdf) {
    const std::string& type = bsdf.type;
    if (type == "diffuse" || type == "roughdiffuse") {
        return make_diffuse(bsdf);
    }
    if (type == "plastic" || type == "roughplastic") {
        return make_plastic(bsdf);
    }
    if (type == "conductor" || type == "roughconductor") {
        return make_conductor(bsdf);
    }
    if (type == "dielectric" || type == "roughdielectric" || type == "thindielectric") {
        return make_glass(bsdf);
    }
    if (type == "principled" || type == "principledthin") {
        return make_principled(bsdf);
    }
    if (type == "phong") {
        return make_phong(bsdf);
    }
    if (type == "ward") {
        return make_ward(bsdf);
    }
    return std::nullopt;
}

Material SurfaceModels::make_diffuse(const Object& bsdf) {
    if (bsdf.type == "roughdiffuse") {
        note(notes_, bsdf.where, "'roughdiffuse' is replaced by 'diffuse'");
        bsdf.ignore({"alpha", "use_fast_approx"});
        bsdf.ignore_nested("texture");
    }
    const bool old_name = bsdf.has("diffuse_reflectance") || bsdf.texture("diffuse_reflectance") != nullptr;
    Material material = plain_material(NEARLIGHT_BSDF_DIFFUSE);
    material.reflectance =
        textures_.reflectance(bsdf, old_name ? "diffuse_reflectance" : "reflectance", {0.5f, 0.5f, 0.5f});
    return material;
}

double SurfaceModels::index_of_refraction(const Object& bsdf, const std::string& name, double fallback) {
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
    return positive_index(index, property->where, name, fallback);
}

double SurfaceModels::positive_index(double index, const Location& where, const std::string& name,
                                     double fallback) {
    if (index > 0.0) {
        return index;
    }
    note(notes_, where, "'" + name + "' is not greater than 0; " + std::to_string(fallback) + " is used");
    return fallback;
}

double SurfaceModels::index_ratio(const Object& bsdf, double interior) {
    const double inside = index_of_refraction(bsdf, "int_ior", interior);
    const double eta = inside / index_of_refraction(bsdf, "ext_ior", 1.000277);
    if (std::abs(eta - 1.0) < kMinIndexStep) {
        note(notes_, bsdf.where, "the indices of refraction inside and outside are the same; 1.001 is used");
        return 1.0 + kMinIndexStep;
    }
    if (eta < 1.0 && !bsdf.has("ext_ior")) {
        notes_.remark(*bsdf.where.file, bsdf.where.line, "the index of refraction is below 1");
    }
    return eta;
}

Parameter SurfaceModels::anisotropic_alpha(const Object& bsdf) {
    if (bsdf.has("alpha") || bsdf.texture("alpha") != nullptr) {
        note(notes_, bsdf.where, "'alpha' is ignored beside 'alpha_u' and 'alpha_v'");
        bsdf.ignore({"alpha"});
    }
    const Parameter u = textures_.number(bsdf, "alpha_u", 0.1f);
    const Parameter v = textures_.number(bsdf, "alpha_v", 0.1f);
    if (const std::optional<Parameter> pair = pair_of_numbers(scene_, u, v)) {
        return *pair;
    }
    note(notes_, bsdf.where,
         "textures for 'alpha_u' and 'alpha_v' that differ in kind, size or placement are replaced by their "
         "means");
    return {{mean_value(scene_, u).x, mean_value(scene_, v).x, 0.0f}, -1};
}

void SurfaceModels::read_microfacets(const Object& bsdf, Material& material) {
    if (!starts_with_rough(bsdf)) {
        return;
    }
    const std::string distribution = lower_case(bsdf.string("distribution", "beckmann"));
    if (distribution == "phong" || distribution == "as") {
        note(notes_, bsdf.where,
             "the microfacet distribution '" + distribution + "' is replaced by Beckmann's");
    } else if (distribution != "beckmann" && distribution != "ggx") {
        fail(bsdf.where, "unknown microfacet distribution '" + distribution + "'; known are beckmann, ggx");
    }
    material.flags |= distribution == "ggx" ? 0u : NEARLIGHT_MATERIAL_BECKMANN;
    bsdf.ignore({"sample_visible"});
    read_roughness(bsdf, material);
    const Vec3 alpha = material.roughness.value;
    if (std::min(alpha.x, alpha.y) <= 0.0f) {
        notes_.remark(*bsdf.where.file, bsdf.where.line, "a roughness of 0 makes a smooth surface");
    }
}

void SurfaceModels::read_roughness(const Object& bsdf, Material& material) {
    const bool has_two = bsdf.has("alpha_u") || bsdf.has("alpha_v") || bsdf.texture("alpha_u") != nullptr ||
                         bsdf.texture("alpha_v") != nullptr;
    material.roughness = has_two ? anisotropic_alpha(bsdf) : textures_.number(bsdf, "alpha", 0.1f);
    const Vec3 alpha = material.roughness.value;
    if (alpha.x != alpha.y || holds_two_numbers(scene_, material.roughness)) {
        material.flags |= NEARLIGHT_MATERIAL_TANGENT;
    }
}

Material SurfaceModels::make_coat(const Object& bsdf, double interior, bool nonlinear) {
    Material microfacets = plain_material(NEARLIGHT_BSDF_PLASTIC);
    read_microfacets(bsdf, microfacets);
    if (microfacets.roughness.texture >= 0) {
        note(notes_, bsdf.where, "a texture for 'alpha' of '" + bsdf.type + "' is replaced by its mean");
    }
    const Vec3 alpha = mean_value(scene_, microfacets.roughness);
    if (alpha.x != alpha.y) {
        note(notes_, bsdf.where, "anisotropic roughness of '" + bsdf.type + "' is replaced by its mean");
    }
    const Coat coat{.eta = index_ratio(bsdf, interior),
                    .alpha = std::clamp(0.5 * static_cast<double>(alpha.x + alpha.y), 0.0, 1.0),
                    .beckmann = (microfacets.flags & NEARLIGHT_MATERIAL_BECKMANN) != 0,
                    .nonlinear = nonlinear};
    const auto [entry, is_new] = plastics_.try_emplace(coat);
    if (is_new) {
        entry->second = plastic_material(scene_, coat);
    }
    Material material = entry->second;
    material.specular = textures_.reflectance(bsdf, "specular_reflectance", {1, 1, 1});
    return material;
}

Material SurfaceModels::make_plastic(const Object& bsdf) {
    Material material = make_coat(bsdf, 1.49, bsdf.boolean("nonlinear", false));
    material.reflectance = textures_.reflectance(bsdf, "diffuse_reflectance", {0.5f, 0.5f, 0.5f});
    return material;
}

Varnish SurfaceModels::make_varnish(const Object& bsdf) {
    Varnish varnish{.coat = make_coat(bsdf, 1.5046, false)};
    varnish.coat.internal_reflectance = 0.0f;
    varnish.coat.reflectance = parameter_of(0.0f);
    const auto thickness = static_cast<float>(bsdf.number("thickness", 1.0));
    const Vec3 given = textures_.color(bsdf, "sigma_a", {0, 0, 0}, false) * (2.0f * thickness);
    const Vec3 absorbed = max(given, {0, 0, 0});
    varnish.transmittance = {std::exp(-absorbed.x), std::exp(-absorbed.y), std::exp(-absorbed.z)};
    if (!(given == absorbed)) {
        note(notes_, bsdf.where, "'" + bsdf.type + "' absorbs less than nothing; that counts as 0");
    }
    if (!is_zero(absorbed)) {
        note(notes_, bsdf.where,
             "what '" + bsdf.type + "' absorbs is that of light straight through it, for all directions");
    }
    return varnish;
}

void SurfaceModels::read_metal(const Object& bsdf, Material& material) {
    // Without a material, Mitsuba 0.6 takes copper, and Mitsuba 3 a perfect mirror.
    const std::string name = bsdf.string("material", bsdf.is_old ? "Cu" : "none");
    const std::optional<Metal> metal = find_metal(name);
    if (!metal) {
        fail(bsdf.find("material")->where, "unknown metal '" + name + "'; give eta and k instead");
    }
    const auto is_given = [&](const char* key) { return bsdf.has(key) || bsdf.texture(key) != nullptr; };
    if (!bsdf.is_old && name != "none" && (is_given("eta") || is_given("k"))) {
        fail(bsdf.find("material")->where, "give either 'material' or 'eta' and 'k'");
    }
    const Vec3 eta = textures_.color(bsdf, "eta", metal->eta, false);
    const Vec3 k = textures_.color(bsdf, "k", metal->k, false);
    const auto outside = static_cast<float>(index_of_refraction(bsdf, "ext_eta", 1.0));
    material.eta = max(eta, {0, 0, 0}) / outside;
    material.k = max(k, {0, 0, 0}) / outside;
    bool is_possible = eta == max(eta, {0, 0, 0}) && k == max(k, {0, 0, 0});
    for (float Vec3::*channel : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        if (material.eta.*channel + material.k.*channel == 0.0f) {  // reflects all, as index 0 + 1i does
            material.k.*channel = 1.0f;
            is_possible = false;
        }
    }
    if (!is_possible) {
        note(notes_, bsdf.where, "no metal has this 'eta' and 'k'; negative ones count as 0");
    }
}

Material SurfaceModels::make_conductor(const Object& bsdf) {
    Material material = plain_material(NEARLIGHT_BSDF_CONDUCTOR);
    read_metal(bsdf, material);
    read_microfacets(bsdf, material);
    material.specular = textures_.reflectance(bsdf, "specular_reflectance", {1, 1, 1});
    return material;
}

Material SurfaceModels::make_glass(const Object& bsdf) {
    const double eta = index_ratio(bsdf, 1.5046);
    Material material =
        bsdf.type == "thindielectric" ? thin_dielectric_material(eta) : dielectric_material(eta);
    read_microfacets(bsdf, material);
    material.specular = textures_.reflectance(bsdf, "specular_reflectance", {1, 1, 1});
    material.transmission = textures_.reflectance(bsdf, "specular_transmittance", {1, 1, 1});
    return material;
}

// `specular` is a scale that Disney's model has for indices from 1 to 1.8.
double SurfaceModels::index_of_specular(const Object& bsdf) {
    constexpr float kUsualSpecular = 0.5f;
    const Vec3 given = bsdf.texture("specular") != nullptr
                           ? textures_.color(bsdf, "specular", {}, false)
                           : textures_.number(bsdf, "specular", kUsualSpecular).value;
    const auto specular = static_cast<double>(std::clamp(luminance(given), 0.0f, 1.0f));
    return 2.0 / (1.0 - std::sqrt(0.08 * specular)) - 1.0;
}

double SurfaceModels::index_of_eta(const Object& bsdf) {
    const Object* const texture = bsdf.texture("eta");
    if (texture == nullptr) {
        return index_of_refraction(bsdf, "eta", kUsualIndex);
    }
    return positive_index(static_cast<double>(luminance(textures_.color(bsdf, "eta", {}, false))),
                          texture->where, "eta", kUsualIndex);
}

double SurfaceModels::principled_index(const Object& bsdf, bool transmits) {
    const auto is_given = [&](const char* key) { return bsdf.has(key) || bsdf.texture(key) != nullptr; };
    const bool has_eta = is_given("eta") || bsdf.type == "principledthin";
    if (is_given("eta") && is_given("specular")) {
        note(notes_, bsdf.where, "'specular' is ignored beside 'eta'");
        bsdf.ignore({"specular"});
    }
    const double eta = has_eta ? index_of_eta(bsdf) : index_of_specular(bsdf);
    return transmits && std::abs(eta - 1.0) < kMinIndexStep ? 1.0 + kMinIndexStep : eta;
}

Material SurfaceModels::make_principled(const Object& bsdf) {
    bsdf.ignore({"diffuse_reflectance_sampling_rate", "main_specular_sampling_rate",
                 "clearcoat_sampling_rate", "specular_reflectance_sampling_rate",
                 "specular_transmittance_sampling_rate", "diffuse_transmittance_sampling_rate"});
    const auto number = [&](const char* name) { return textures_.number(bsdf, name, 0.0f); };
    const Parameter spec_trans = number("spec_trans");
    const bool transmits = spec_trans.texture >= 0 || spec_trans.value.x > 0.0f;
    Material material = principled_material(scene_, principled_index(bsdf, transmits));
    material.reflectance = textures_.reflectance(bsdf, "base_color", {0.5f, 0.5f, 0.5f});
    material.roughness = textures_.number(bsdf, "roughness", 0.5f);
    material.spec_trans = spec_trans;
    material.anisotropic = number("anisotropic");
    material.spec_tint = number("spec_tint");
    material.sheen = number("sheen");
    material.sheen_tint = number("sheen_tint");
    material.flatness = number("flatness");
    if (material.anisotropic.texture >= 0 || material.anisotropic.value.x > 0.0f) {
        material.flags |= NEARLIGHT_MATERIAL_TANGENT;
    }
    if (bsdf.type == "principledthin") {
        material.flags |= NEARLIGHT_MATERIAL_THIN;
        // Mitsuba counts diffuse transmission from 0 to 2, twice the share of light that goes through.
        material.transmission = textures_.number(bsdf, "diff_trans", 0.0f, {0.0f, 2.0f});
        material.transmission.value *= 0.5f;
    } else {
        material.metallic = number("metallic");
        material.clearcoat = number("clearcoat");
        material.clearcoat_gloss = number("clearcoat_gloss");
    }
    return material;
}

void SurfaceModels::read_base_and_lobe(const Object& bsdf, Material& material) {
    material.reflectance = textures_.reflectance(bsdf, "diffuse_reflectance", {0.5f, 0.5f, 0.5f});
    material.specular = textures_.reflectance(bsdf, "specular_reflectance", {0.2f, 0.2f, 0.2f});
    // As in Mitsuba 0.6, both are scaled so that they reflect no more than arrives in any place.
    const float sum =
        max_component(max_value(scene_, material.reflectance) + max_value(scene_, material.specular));
    if (sum > 1.0f) {
        notes_.remark(*bsdf.where.file, bsdf.where.line,
                      "diffuse and specular reflectance together exceed 1 and are scaled down");
        material.reflectance.value = material.reflectance.value / sum;
        material.specular.value = material.specular.value / sum;
    }
}

// A power n of the cosine becomes the roughness √(2/(n + 2)).
Material SurfaceModels::make_phong(const Object& bsdf) {
    constexpr float kMaxExponent = 1e6f;
    Material material = plain_material(NEARLIGHT_BSDF_PHONG);
    read_base_and_lobe(bsdf, material);
    const Parameter exponent = textures_.number(bsdf, "exponent", 30.0f, {0.0f, kMaxExponent});
    if (exponent.texture >= 0) {
        note(notes_, bsdf.where, "a texture for 'exponent' of 'phong' is replaced by its mean");
    }
    const float n = std::clamp(luminance(mean_value(scene_, exponent)), 0.0f, kMaxExponent);
    material.roughness = parameter_of(std::sqrt(2.0f / (n + 2.0f)));
    return material;
}

Material SurfaceModels::make_ward(const Object& bsdf) {
    Material material = plain_material(NEARLIGHT_BSDF_WARD);
    read_base_and_lobe(bsdf, material);
    read_roughness(bsdf, material);
    const std::string variant = lower_case(bsdf.string("variant", "balanced"));
    if (variant == "ward" || variant == "ward-duer") {
        note(notes_, bsdf.where,
             "the variant '" + variant +
                 "' of 'ward' is replaced by 'balanced', which is darker at grazing angles");
    } else if (variant != "balanced") {
        fail(bsdf.where, "unknown variant '" + variant + "' of 'ward'; known are balanced, ward, ward-duer");
    }
    return material;
}

}  // namespace nearlight::core::mitsuba
