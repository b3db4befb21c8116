// SPDX-License-Identifier: Apache-2.0
#include "nearlight/scene.h"

#include <utility>

#include "host/library/parts.h"
#include "host/library/states.h"
#include "host/scene/camera.h"

namespace nearlight {
namespace {

Vec3 public_vector(core::Vec3 v) {
    return {v.x, v.y, v.z};
}

std::optional<std::array<double, 3>> point_of(const std::optional<Vec3>& v) {
    using Point = std::array<double, 3>;
    return v ? std::optional(Point{v->x, v->y, v->z}) : std::nullopt;
}

}  // namespace

core::LoadOptions core_options(const LoadOptions& options, std::optional<core::SceneMoment> moment) {
    core::LoadOptions wanted{
        .parameters = options.definitions, .camera = options.camera, .strict = options.strict};
    core::SceneOverrides& overrides = wanted.overrides;
    overrides.origin = point_of(options.origin);
    overrides.target = point_of(options.target);
    overrides.up = point_of(options.up);
    overrides.fov_degrees = options.fov_x_degrees;
    overrides.environment = options.environment;
    overrides.environment_rotation = options.environment_rotation;
    overrides.environment_scale = options.environment_scale;
    if (options.sun) {
        overrides.sun = core::SunPosition{options.sun->azimuth, options.sun->elevation};
    }
    overrides.light_scale = options.light_scale;
    wanted.moment = std::move(moment);
    return wanted;
}

core::Scene load_core_scene(const std::filesystem::path& file, const LoadOptions& options,
                            std::optional<core::SceneMoment> moment) {
    core::Scene scene = core::load_scene(file, core_options(options, std::move(moment)));
    scene.clear_glass = options.clear_glass;
    return scene;
}

Scene::Scene(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Scene Scene::load(const std::filesystem::path& file, const LoadOptions& options) {
    return Scene(std::make_shared<const State>(State{load_core_scene(file, options)}));
}

const std::string& Scene::name() const {
    return state_->scene.name;
}

const std::filesystem::path& Scene::source() const {
    return state_->scene.source;
}

std::size_t Scene::triangle_count() const {
    return state_->scene.triangles.size();
}

Box Scene::bounds() const {
    const core::Aabb box = core::bounds(state_->scene);
    return {public_vector(box.min), public_vector(box.max)};
}

int Scene::width() const {
    return state_->scene.camera.width;
}

int Scene::height() const {
    return state_->scene.camera.height;
}

CameraPose Scene::camera() const {
    return core::pose_of(state_->scene.camera);
}

bool Scene::has_open_exposure() const {
    return state_->scene.has_open_exposure;
}

std::uint64_t Scene::hash() const {
    return core::scene_hash(state_->scene);
}

std::vector<SceneNote> Scene::notes() const {
    std::vector<SceneNote> notes;
    for (const core::Note& note : state_->scene.notes) {
        notes.push_back({note.file, note.line, note.text});
    }
    return notes;
}

}  // namespace nearlight
