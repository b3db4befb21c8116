// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "host/base/random.h"
#include "host/reference/bsdf/surface_bsdf.h"
#include "host/scene/material_model.h"
#include "host/selftest/checks.h"
#include "host/stages/bsdf_probe.h"

namespace nearlight::core {
namespace {

constexpr uint kParts[] = {1, 2};  // BSDF_D and BSDF_S of kernels/lib/bsdf/bsdf.cl
constexpr std::size_t kQueriesPerPart = 500;
/// As a part of the greater value. Single precision loses most at grazing angles.
constexpr double kBsdfTolerance = 0.01;
constexpr float kLeastCosine = 0.02f;
constexpr double kLeastValue = 1e-4;  // below it, values are equal

/// A material of each model, rough where it can be: smooth ones have no value along a given direction.
std::vector<std::function<Material(Scene&)>> rough_materials() {
    const auto rough = [](Material material, Vec3 alpha, uint flags) {
        material.roughness = parameter_of(alpha);
        material.flags |= flags;
        return material;
    };
    const Vec3 eta{0.2f, 0.92f, 1.1f};
    const Vec3 k{3.9f, 2.45f, 2.1f};
    const Vec3 alpha{0.3f, 0.5f, 0};
    return {
        [=](Scene&) {
            return diffuse_material({0.8f, 0.4f, 0.2f});
        },
        [=](Scene&) { return rough(conductor_material(eta, k), alpha, 0); },
        [=](Scene&) { return rough(conductor_material(eta, k), alpha, NEARLIGHT_MATERIAL_BECKMANN); },
        [=](Scene&) { return rough(dielectric_material(1.5), alpha, 0); },
        [=](Scene& scene) { return plastic_material(scene, {.alpha = 0}); },
        [=](Scene& scene) { return plastic_material(scene, {.alpha = 0.3, .nonlinear = true}); },
        [=](Scene&) { return rough(plain_material(NEARLIGHT_BSDF_PHONG), alpha, 0); },
        [=](Scene&) { return rough(plain_material(NEARLIGHT_BSDF_WARD), alpha, 0); },
        [=](Scene& scene) {
            Material material = principled_material(scene, 1.5);
            material.metallic = parameter_of(0.3f);
            material.spec_trans = parameter_of(0.3f);
            material.clearcoat = parameter_of(0.7f);
            material.sheen = parameter_of(0.5f);
            return material;
        },
    };
}

/// A direction that does not graze the surface: kernels look transmission curves up in tables, whose last
/// step before the rim is coarse, and the path tracer computes those of smooth coats.
Vec3 direction_off_the_rim(Pcg32& random) {
    const float side = random.uniform() < 0.5f ? -1.0f : 1.0f;
    const float z = side * (kLeastCosine + (1.0f - kLeastCosine) * random.uniform());
    const float phi = 2.0f * kPi * random.uniform();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

std::vector<BsdfQuery> random_queries() {
    Pcg32 random(23);
    std::vector<BsdfQuery> queries;
    for (const uint parts : kParts) {
        for (std::size_t i = 0; i < kQueriesPerPart; ++i) {
            const Vec3 wo = direction_off_the_rim(random);
            queries.push_back({.wo = wo,
                               .triangle = 0,
                               .wi = direction_off_the_rim(random),
                               .parts = parts,
                               .weight1 = 0.25f,
                               .weight2 = 0.25f,
                               .mode = static_cast<uint>(i % 2),
                               .choice = 0.5f,
                               .u = random.uniform(),
                               .v = {random.uniform(), random.uniform()},
                               .pad0 = 0});
        }
    }
    return queries;
}

bool about_equal(Vec3d a, Vec3d b) {
    const double greatest = std::max({std::fabs(b.x), std::fabs(b.y), std::fabs(b.z), kLeastValue});
    const Vec3d change = a - b;
    return std::max({std::fabs(change.x), std::fabs(change.y), std::fabs(change.z)}) <=
           kBsdfTolerance * greatest;
}

Vec3d in_double(Vec3 v) {
    return {v.x, v.y, v.z};
}

/// The path tracer's value of the part along `wi`.
Vec3d value_along(const Scene& scene, const BsdfQuery& query, Vec3 wi) {
    const BvhHit hit{1.0f, query.weight1, query.weight2, 0};
    const Transport transport = query.mode == 0 ? Transport::radiance : Transport::flux;
    const SurfaceBsdf bsdf(scene, surface_at(scene, hit, -query.wo), in_double(query.wo), query.choice,
                           transport);
    const BsdfValue value = bsdf.eval(in_double(wi));
    return query.parts == kParts[0] ? value.diffuse : value.specular;
}

}  // namespace

void check_bsdfs(Device& device, CheckResult& result) {
    BsdfProbe probe(device);
    const std::vector<BsdfQuery> queries = random_queries();
    for (const auto& make : rough_materials()) {
        BsdfScene on_device;
        Scene scene;
        scene.materials = on_device.materials = {make(scene)};
        scene.vertices = on_device.vertices;
        scene.triangles = on_device.triangles;
        on_device.curves = scene.transmission_curves;
        const std::vector<BsdfAnswer> answers = probe.ask(on_device, queries);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const BsdfAnswer& answer = answers[i];
            result.expect(
                about_equal(in_double(answer.value), value_along(scene, queries[i], queries[i].wi)));
            if (answer.is_delta == 0 && answer.sample_pdf > 0 && std::fabs(answer.wi.z) > kLeastCosine) {
                result.expect(about_equal(in_double(answer.weight) * answer.sample_pdf,
                                          value_along(scene, queries[i], answer.wi)));
            }
        }
    }
}

}  // namespace nearlight::core
