// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/lights_and_cameras.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "host/scene/emitters.h"
#include "tests/scene/gltf_text.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using testing::Not;
using namespace test;

class GltfLightsAndCameras : public GltfLoader {};

TEST_F(GltfLightsAndCameras, Lights) {
    gltf_.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 683}, {"color", {1, 0.5, 0}}},
        {{"type", "spot"}, {"intensity", 1366}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
        {{"type", "directional"}, {"intensity", 6830}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1, 2, 3}}}};
    for (int light = 0; light < 3; ++light) {
        gltf_.root["nodes"].push_back({{"translation", {0, 0, light + 1}},
                                       {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    const Scene scene = load();
    ASSERT_EQ(scene.delta_emitters.size(), 3u);
    expect_close(scene.delta_emitters[0].position, {0, 0, 1});
    expect_close(scene.delta_emitters[0].radiance, {1, 0.5f, 0});
    EXPECT_EQ(scene.delta_emitters[1].type, NEARLIGHT_EMITTER_SPOT);
    expect_close(scene.delta_emitters[1].direction, {0, 0, -1});
    expect_close(scene.delta_emitters[1].radiance, {2, 2, 2});
    EXPECT_FLOAT_EQ(scene.delta_emitters[1].beam_angle, 0.2f);
    EXPECT_FLOAT_EQ(scene.delta_emitters[1].cutoff_angle, 0.4f);
    const Emitter& sun = scene.delta_emitters[2];
    EXPECT_EQ(sun.type, NEARLIGHT_EMITTER_DIRECTIONAL);
    EXPECT_NEAR(sun.radiance.x, 10, 0.01);  // W/m²
    expect_close(sun.direction, {0, 0, -1});
    for (const Note& note : scene.notes) {
        EXPECT_THAT(note.text, Not(HasSubstr("directional")));
    }
}

TEST_F(GltfLightsAndCameras, NoScaleOfItsNodeDarkensALight) {
    gltf_.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"}}, {{"type", "spot"}, {"spot", json::object()}}};
    const double half = std::sqrt(0.5);
    gltf_.root["nodes"] = {{{"mesh", 0}},
                           {{"scale", {0, 0, 0}},
                            {"rotation", {0, half, 0, half}},
                            {"translation", {0, 5, 0}},
                            {"children", {2}},
                            {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                           {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1};
    for (const Emitter& emitter : load().delta_emitters) {
        expect_close(emitter.direction, {-1, 0, 0});
    }
    EXPECT_EQ(load().delta_emitters.size(), 2u);
}

TEST_F(GltfLightsAndCameras, OddNumbersOfLightsAreNoted) {
    gltf_.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "dark"}, {"intensity", -5}},
        {{"type", "spot"},
         {"name", "inside out"},
         {"spot", {{"innerConeAngle", 0.7}, {"outerConeAngle", 0.3}}}},
        {{"type", "spot"}, {"name", "wide"}, {"spot", {{"outerConeAngle", 2.5}}}},
        {{"type", "spot"}, {"name", "usual"}, {"spot", {{"outerConeAngle", 1.5707964}}}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1, 2, 3, 4}}}};
    for (int light = 0; light < 4; ++light) {
        gltf_.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    std::string notes;
    for (const Note& note : load().notes) {
        notes += note.text + "\n";
    }
    EXPECT_THAT(notes, HasSubstr("light 'dark' has an intensity or colour below 0"));
    EXPECT_THAT(notes, HasSubstr("light 'inside out' has an innerConeAngle that is not between"));
    EXPECT_THAT(notes, HasSubstr("light 'wide' has an outerConeAngle that is not between"));
    EXPECT_THAT(notes, Not(HasSubstr("usual")));
}

TEST_F(GltfLightsAndCameras, OrthographicCamerasHaveTheirSize) {
    const json size = {{"xmag", 3}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 9}};
    gltf_.root["cameras"] = {{{"type", "orthographic"}, {"orthographic", size}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"camera", 0}, {"translation", {0, 0, 3}}}};
    const SceneCamera camera = load().camera;
    EXPECT_EQ(camera.kind, CameraKind::orthographic);
    EXPECT_EQ(camera.width, 720);
    EXPECT_EQ(camera.height, 480);
    expect_close(transform_vector(camera.to_world, {1, 0, 0}), {-3, 0, 0});
    expect_close(transform_vector(camera.to_world, {0, 0, 1}), {0, 0, -1});
    gltf_.root["cameras"][0]["orthographic"]["xmag"] = 0;
    EXPECT_TRUE(mentions(file_error([&] { load(); }), "has no size above 0"));
}

TEST_F(GltfLightsAndCameras, CamerasLookAlongMinusZ) {
    gltf_.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}},
                             {{"type", "perspective"},
                              {"name", "wide"},
                              {"perspective", {{"yfov", 1.2}, {"aspectRatio", 2}, {"znear", 0.1}}}}};
    gltf_.root["nodes"] = {
        {{"mesh", 0}, {"children", {1, 2}}},
        {{"camera", 0}, {"name", "front"}, {"translation", {0, 0, 3}}, {"scale", {2, 2, 2}}},
        {{"camera", 1}}};
    const SceneCamera front = load().camera;
    expect_close(transform_vector(front.to_world, {0, 0, 1}), {0, 0, -1});
    expect_close(transform_vector(front.to_world, {0, 1, 0}), {0, 1, 0});
    expect_close(transform_vector(front.to_world, {1, 0, 0}), {-1, 0, 0});
    expect_close(transform_point(front.to_world, {0, 0, 0}), {0, 0, 3});
    EXPECT_EQ(front.width, 640);
    EXPECT_EQ(front.height, 480);
    EXPECT_NEAR(std::tan(front.fov_x_degrees * std::numbers::pi / 360), std::tan(0.4) * 4 / 3, 1e-6);

    const SceneCamera wide = load({.camera = "wide"}).camera;
    EXPECT_EQ(wide.width, 960);
    EXPECT_NEAR(std::tan(wide.fov_x_degrees * std::numbers::pi / 360), 2 * std::tan(0.6), 1e-6);
    EXPECT_EQ(load({.camera = "front"}).camera.width, 640);
}

/// The view follows from the rotations of nodes alone, whatever they scale or mirror.
TEST_F(GltfLightsAndCameras, ScalesDoNotChangeCameras) {
    gltf_.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    const double half = std::sqrt(0.5);
    const auto camera_below = [&](const json& scale, const json& of_parent) {
        gltf_.root["nodes"] = {
            {{"mesh", 0}, {"children", {1}}},
            {{"scale", of_parent}, {"children", {2}}},
            {{"camera", 0}, {"translation", {1, 0, 3}}, {"rotation", {0, half, 0, half}}, {"scale", scale}}};
        return load().camera;
    };
    for (const json& scale : {json{1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}, {2, 3, 0}}) {
        const SceneCamera camera = camera_below(scale, {2, 1, -1});
        expect_close(transform_vector(camera.to_world, {0, 0, 1}), {-1, 0, 0});
        expect_close(transform_vector(camera.to_world, {0, 1, 0}), {0, 1, 0});
        expect_close(transform_vector(camera.to_world, {1, 0, 0}), {0, 0, 1});
        expect_close(transform_point(camera.to_world, {0, 0, 0}), {2, 0, -3});
    }
    // A matrix that mirrors counts as one that mirrors X.
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1}}},
                           {{"camera", 0}, {"matrix", {-2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 5, 1}}}};
    const SceneCamera camera = load().camera;
    expect_close(transform_vector(camera.to_world, {0, 0, 1}), {0, 0, -1});
    expect_close(transform_vector(camera.to_world, {1, 0, 0}), {-1, 0, 0});
}

TEST_F(GltfLightsAndCameras, CamerasByNumberAndSuggestions) {
    gltf_.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1, 2}}},
                           {{"camera", 0}, {"name", "front"}},
                           {{"camera", 0}, {"name", "side"}, {"translation", {7, 0, 0}}}};
    const auto x_of = [&](const std::string& camera) {
        LoadOptions options;
        options.camera = camera;
        return load(options).camera.to_world(0, 3);
    };
    EXPECT_EQ(x_of(""), 0.0);
    EXPECT_EQ(x_of("2"), 7.0);
    EXPECT_EQ(x_of("side"), 7.0);
    for (const auto& [wanted, part] : {std::pair{"sied", "did you mean 'side'?"},
                                       {"3", "1 (front), 2 (side)"},
                                       {"0", "has no camera '0'"}}) {
        try {
            x_of(wanted);
            ADD_FAILURE() << wanted;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
            EXPECT_THAT(error.what(), HasSubstr(part));
        }
    }
}

}  // namespace
}  // namespace nearlight::core
