// SPDX-License-Identifier: Apache-2.0
#include "host/reference/path_integrator.h"

#include "host/reference/shadow_ray.h"

namespace nearlight::core {
namespace {

// Number of vertices before Russian roulette may end a path, and the maximum probability of survival after
// that.
constexpr int kSureVertices = 5;
constexpr double kMaxSurvival = 0.95;

}  // namespace

/// A path on its way.
struct PathIntegrator::PathState {
    enum class Stage {
        chain,     ///< all vertices so far scattered by S
        receiver,  ///< the last vertex is the receiver
        beyond
    };
    Stage stage = Stage::chain;
    Ray ray;
    Vec3d throughput{1, 1, 1};
    double index = 1;  ///< refractive index relative to the camera's
    int vertices = 0;
    bool was_scattered = false;  ///< by other than mirrors and glass
    // How the last vertex that did not let the path pass straight on drew the ray's direction: its place, and
    // the density with the chance of the part; without a density, as for the camera and delta
    // directions, light sampling cannot have found the same.
    Vec3 scattered_at;
    double density = 0;
    double passed = 0;  ///< distance from that vertex to the last veil
    int veils = 0;      ///< passed since then
};

struct PathIntegrator::VertexRandom {
    double material = 0, part = 0;
    BsdfRandom direction;
    LightRandom light;
    double survival = 0;
};

PathIntegrator::VertexRandom PathIntegrator::vertex_random(SampleBatch& batch, int sample, int vertex) {
    Point2 part, lobe, direction, place;
    if (vertex < 2) {
        const bool first = vertex == 0;
        part = batch.point(first ? Decision::first_part : Decision::second_part, sample);
        lobe = batch.point(first ? Decision::first_lobe : Decision::second_lobe, sample);
        direction = batch.point(first ? Decision::first_direction : Decision::second_direction, sample);
        place = batch.point(first ? Decision::first_light : Decision::second_light, sample);
    } else {
        for (Point2* point : {&part, &lobe, &direction, &place}) {
            point->x = batch.random().uniform();
            point->y = batch.random().uniform();
        }
    }
    return {.material = part.x,
            .part = part.y,
            .direction = {lobe.x, direction.x, direction.y},
            .light = {lobe.y, place},
            .survival = batch.random().uniform()};
}

PathIntegrator::PathIntegrator(const Scene& scene, int max_depth, float clamp_radius)
    : scene_(scene), max_depth_(max_depth), clamp_radius_(clamp_radius), embree_(scene), lights_(scene) {}

bool PathIntegrator::only_diffuse(const PathState& state) const {
    return clamp_radius_ > 0.0f && state.stage == PathState::Stage::receiver;
}

Vec3 PathIntegrator::beside(const Surface& surface, Vec3 direction) const {
    const bool stays = dot(direction, surface.geometric_normal) > 0.0f;
    const Vec3 side = stays ? surface.geometric_normal : -surface.geometric_normal;
    return surface.off(side, lights_.scene_size());
}

// Emission that a ray meets was scattered once less than light sampled at the vertex before.
void PathIntegrator::add_emission(const PathState& state, const BvhHit& hit, PathLight& light) const {
    const Vec3 emitted = hit.triangle == ~0u ? lights_.environment_radiance(state.ray.direction)
                                             : lights_.emitted_radiance(hit, state.ray.direction);
    if (is_zero(emitted)) {
        return;
    }
    double weight = 1;
    if (state.density > 0 && state.veils <= NEARLIGHT_MAX_VEILS) {
        BvhHit seen = hit;
        seen.t += static_cast<float>(state.passed);
        const double other = lights_.pdf(state.scattered_at, state.ray.direction, seen);
        weight = state.density / (state.density + other);
    }
    Vec3d& layer = state.stage == PathState::Stage::beyond ? light.indirect : light.direct;
    layer += state.throughput * as_double(emitted) * weight;
}

// One light, as the parts of the BSDF scatter it. Each part is weighted against its own density.
Vec3d PathIntegrator::scattered(const PathState& state, const Surface& surface, const SurfaceBsdf& bsdf,
                                const LightPick& pick) const {
    if (is_zero(pick.radiance) || !(pick.density > 0.0)) {
        return {};
    }
    const Vec3d direction = as_double(pick.direction);
    const BsdfValue value = bsdf.eval(direction);
    if (is_zero(value.sum())) {
        return {};
    }
    const int max_veils = max_depth_ > 0 ? max_depth_ - state.vertices - 2 : NEARLIGHT_MAX_VEILS;
    const ShadowRay shadow =
        shadow_ray(scene_, embree_, beside(surface, pick.direction), pick, max_veils, lights_.scene_size());
    const bool base_only = only_diffuse(state);
    Vec3d sum;
    if (pick.is_delta) {
        sum = (base_only ? value.diffuse : value.sum()) / pick.density;
    } else {
        const double diffuse_chance = base_only ? 1 : bsdf.diffuse_chance();
        // A veil is no surface that reflects by D, so it ends a ray by which a clamped picture would leave
        // its receiver, and sampled lights alone bring what comes through.
        const bool ray_ends =
            clamp_radius_ > 0.0f && state.stage == PathState::Stage::chain && shadow.veils > 0;
        sum = value.diffuse / (pick.density + (ray_ends ? 0 : diffuse_chance * bsdf.diffuse_pdf(direction)));
        if (!base_only) {
            sum += value.specular / (pick.density + bsdf.specular_chance() * bsdf.specular_pdf(direction));
        }
    }
    return state.throughput * sum * as_double(pick.radiance) * shadow.transmittance;
}

void PathIntegrator::add_sampled_light(const PathState& state, const Surface& surface,
                                       const SurfaceBsdf& bsdf, const LightRandom& random,
                                       PathLight& light) const {
    const Vec3 position = surface.off(surface.geometric_normal, lights_.scene_size());
    Vec3d& layer = state.stage == PathState::Stage::chain ? light.direct : light.indirect;
    for (const Emitter& emitter : lights_.exact_lights()) {
        layer += scattered(state, surface, bsdf, LightSampler::exact_light(scene_, emitter, position));
    }
    layer += scattered(state, surface, bsdf, lights_.sample(position, random));
}

/// Notes at the start of the next ray how its direction was drawn.
void PathIntegrator::leave(PathState& state, const SurfaceDraw& draw) {
    state.scattered_at = state.ray.origin;
    state.density = draw.is_delta ? 0 : draw.pdf;
    state.was_scattered = state.was_scattered || !draw.is_delta;
    state.passed = 0;
    state.veils = 0;
    if (state.stage == PathState::Stage::chain) {
        state.stage = draw.is_diffuse ? PathState::Stage::receiver : PathState::Stage::chain;
    } else {
        state.stage = PathState::Stage::beyond;
    }
}

/// Goes on by one part of the BSDF at the end of a ray of the given length. Returns false where the path
/// ends.
bool PathIntegrator::scatter(PathState& state, double distance, const Surface& surface,
                             const SurfaceBsdf& bsdf, const VertexRandom& random) const {
    const SurfaceDraw draw = only_diffuse(state) ? bsdf.sample_diffuse(random.direction)
                                                 : bsdf.sample(random.part, random.direction);
    state.throughput *= draw.weight;
    state.index *= draw.eta;
    const Vec3 direction = draw.is_straight ? state.ray.direction : normalize(as_float(draw.wi));
    state.ray = {beside(surface, direction), direction};
    ++state.vertices;
    if (draw.is_straight) {
        state.passed += distance;
        ++state.veils;
    } else {
        leave(state, draw);
    }
    double survival = 1;
    if (state.vertices >= kSureVertices) {
        // Radiance is larger inside glass by the square of the index, and no less important for it.
        survival = std::min(kMaxSurvival, max_component(state.throughput) * state.index * state.index);
        state.throughput *= survival > 0 ? 1 / survival : 0;
    }
    return random.survival < survival && max_component(state.throughput) > 0;
}

void PathIntegrator::note_receiver(const PathState& state, const Surface& surface, const SurfaceBsdf& bsdf,
                                   CameraPath& path) const {
    path.has_receiver = true;
    path.throughput = as_float(state.throughput);
    path.receiver = {surface.off(surface.geometric_normal, lights_.scene_size()), as_float(bsdf.normal()),
                     as_float(bsdf.diffuse_reflectance() / bsdf.diffuse_chance())};
}

/// The first surface that the camera sees. Where emitters are hidden, the ray goes on behind them to any
/// distance.
BvhHit PathIntegrator::first_hit(const Ray& ray) const {
    BvhHit hit = embree_.closest_hit(ray.origin, ray.direction, ray.t_min, ray.t_max);
    while (scene_.camera.hide_emitters && hit.triangle != ~0u) {
        const Surface surface = surface_at(scene_, hit, ray.direction);
        if (!(max_component(surface.material->emission.value) > 0.0f)) {
            break;
        }
        const float passed = hit.t;
        const Vec3 behind = surface.off(-surface.geometric_normal, lights_.scene_size());
        hit = embree_.closest_hit(behind, ray.direction, 0.0f, kInfinity);
        hit.t += passed;
    }
    return hit;
}

PathLight PathIntegrator::trace(Ray ray, SampleBatch& batch, int sample) const {
    PathLight light;
    PathState state;
    state.ray = ray;
    bool sees_sky = !scene_.camera.hide_emitters;
    for (;;) {
        const BvhHit hit = state.vertices == 0
                               ? first_hit(state.ray)
                               : embree_.closest_hit(state.ray.origin, state.ray.direction, 0.0f, kInfinity);
        // A pane that does not turn the path hides no less than air does, as in Mitsuba.
        sees_sky = sees_sky || state.ray.direction != ray.direction;
        if (hit.triangle != ~0u || sees_sky) {
            add_emission(state, hit, light);
        }
        if (hit.triangle == ~0u) {
            return light;
        }
        if (state.vertices == 0) {
            light.camera.depth = hit.t;
        }
        const VertexRandom random = vertex_random(batch, sample, state.vertices);
        const Surface surface = surface_at(scene_, hit, state.ray.direction);
        const SurfaceBsdf bsdf(scene_, surface, -normalize(as_double(state.ray.direction)), random.material,
                               state.was_scattered ? Transport::radiance : Transport::camera);
        if (state.stage == PathState::Stage::chain && bsdf.has_diffuse() &&
            random.part < bsdf.diffuse_chance()) {
            note_receiver(state, surface, bsdf, light.camera);
        }
        if (max_depth_ > 0 && state.vertices + 1 >= max_depth_) {
            return light;
        }
        if (only_diffuse(state)) {
            const float ratio = hit.t / clamp_radius_;
            state.throughput *= std::min(1.0f, ratio * ratio);
        }
        add_sampled_light(state, surface, bsdf, random.light, light);
        if (!scatter(state, static_cast<double>(hit.t), surface, bsdf, random)) {
            return light;
        }
    }
}

}  // namespace nearlight::core
