// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/scene/gltf_text.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using namespace test;

constexpr double kHalfTurn = std::numbers::pi;

/// A turn about z.
std::vector<float> turned(double angle) {
    return {0, 0, static_cast<float>(std::sin(angle / 2)), static_cast<float>(std::cos(angle / 2))};
}

std::vector<float> joined(std::vector<float> a, const std::vector<float>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

class GltfAnimation : public GltfLoader {
  protected:
    int times(const std::vector<float>& seconds) { return gltf_.accessor(seconds, 5126, "SCALAR", 1); }
    int rotations(const std::vector<float>& values) { return gltf_.accessor(values, 5126, "VEC4", 4); }

    /// Adds an animation of one property of a node.
    json& animate(int node, const char* path, int times, int values, const char* interpolation = "LINEAR",
                  const char* name = "") {
        json& animations = gltf_.root["animations"];
        animations.push_back(
            {{"name", name},
             {"samplers", {{{"input", times}, {"output", values}, {"interpolation", interpolation}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
        return animations.back();
    }
    Scene load_at(double seconds, const std::vector<std::string>& animations = {}) const {
        return load({.moment = SceneMoment{seconds, animations}});
    }
    [[nodiscard]] Error error_at(double seconds, const std::vector<std::string>& animations = {}) const {
        return error_of([&] { load_at(seconds, animations); });
    }
    /// Where corner k of the square stands at a time.
    [[nodiscard]] Vec3 corner_at(double seconds, int k = 0) const { return corner(load_at(seconds), 0, k); }
    /// The square before a camera, which moves along z from 5 to 7 m in a second.
    void add_walking_camera() {
        gltf_.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
        gltf_.root["nodes"].push_back({{"camera", 0}, {"name", "eye"}});
        gltf_.root["scenes"][0]["nodes"] = {0, 1};
        animate(1, "translation", times({0, 1}), gltf_.points({0, 0, 5, 0, 0, 7}), "LINEAR", "walk");
    }
};

TEST_F(GltfAnimation, LinearMotionIsEvenAndRestsBeforeAndAfter) {
    animate(0, "translation", times({1, 3}), gltf_.points({0, 0, 0, 4, -8, 2}));
    expect_close(corner_at(1.5), {1, -2, 0.5f});
    expect_close(corner_at(3), {4, -8, 2});
    expect_close(corner_at(0), {0, 0, 0});
    expect_close(corner_at(1e9), {4, -8, 2});
    EXPECT_DOUBLE_EQ(load_at(0).animation->begin, 1.0);
    EXPECT_DOUBLE_EQ(load_at(0).animation->end, 3.0);
    EXPECT_FALSE(load().animation.has_value()) << "at rest";
    expect_close(corner(load(), 0, 1), {1, 0, 0});
}

TEST_F(GltfAnimation, AMotionOfOneKeyStands) {
    animate(0, "scale", times({1}), gltf_.points({2, 3, 4}));
    expect_close(corner_at(0, 2), {2, 3, 0});
    expect_close(corner_at(2, 2), {2, 3, 0});
}

TEST_F(GltfAnimation, StepsWaitForTheNextKey) {
    animate(0, "translation", times({0, 1, 2}), gltf_.points({1, 0, 0, 2, 0, 0, 3, 0, 0}), "STEP");
    for (const auto& [time, x] :
         {std::pair{0.0, 1.0f}, {0.999, 1.0f}, {1.0, 2.0f}, {1.5, 2.0f}, {2.0, 3.0f}}) {
        expect_close(corner_at(time), {x, 0, 0});
    }
}

TEST_F(GltfAnimation, TurnsAreEvenAndTakeTheShorterWay) {
    const double angle = 160 * kHalfTurn / 180;
    std::vector<float> other_sign = turned(angle);
    for (float& number : other_sign) {
        number = -number;
    }
    for (const auto& end : {turned(angle), other_sign}) {
        gltf_.root["animations"] = json::array();
        animate(0, "rotation", times({0, 2}), rotations(joined(turned(0), end)));
        for (const double time : {0.0, 0.5, 1.3, 2.0}) {
            const double now = time / 2 * angle;
            expect_close(corner_at(time, 1),
                         {static_cast<float>(std::cos(now)), static_cast<float>(std::sin(now)), 0});
        }
    }
}

TEST_F(GltfAnimation, EqualTurnsStand) {
    animate(0, "rotation", times({0, 2}), rotations(joined(turned(1), turned(1))));
    expect_close(corner_at(1, 1), {std::cos(1.0f), std::sin(1.0f), 0});
}

TEST_F(GltfAnimation, CubicSplinesAreThePolynomialOfTheirKeys) {
    const auto position = [](double t) { return t * t * t - 2 * t * t + 0.5; };
    const auto speed = [](double t) { return 3 * t * t - 4 * t; };
    std::vector<float> values;
    for (const double t : {1.0, 3.0, 3.5}) {
        for (const double x : {speed(t), position(t), speed(t)}) {
            values = joined(values, {static_cast<float>(x), static_cast<float>(-x), 0});
        }
    }
    animate(0, "translation", times({1, 3, 3.5}), gltf_.points(values), "CUBICSPLINE");
    for (const double t : {1.0, 1.4, 2.2, 3.0, 3.1, 3.5}) {
        const auto x = static_cast<float>(position(t));
        expect_close(corner_at(t), {x, -x, 0}, 1e-4f);
    }
    expect_close(corner_at(0), {static_cast<float>(position(1)), static_cast<float>(-position(1)), 0});
}

TEST_F(GltfAnimation, CubicTurnsHaveUnitLength) {
    // Without tangents the numbers of both keys are blended, by halves in the middle.
    const std::vector<float> still{0, 0, 0, 0};
    const std::vector<float> values =
        joined(joined(joined(still, turned(0)), joined(still, still)), joined(turned(kHalfTurn / 2), still));
    animate(0, "rotation", times({0, 1}), rotations(values), "CUBICSPLINE");
    const auto root = static_cast<float>(std::sqrt(0.5));
    expect_close(corner_at(0.5, 1), {root, root, 0});
}

TEST_F(GltfAnimation, NormalizedIntegersAreFractions) {
    const int values =
        gltf_.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 32767, 0}, 5122, "VEC4", 4, true);
    animate(0, "rotation", times({0, 1}), values);
    expect_close(corner_at(0.5, 1), {0, 1, 0});
}

TEST_F(GltfAnimation, WeightsOfMorphTargets) {
    gltf_.primitive()["targets"] = {{{"POSITION", gltf_.points({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})}},
                                    {{"POSITION", gltf_.points({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0})}}};
    animate(0, "weights", times({0, 1}), gltf_.accessor(std::vector<float>{0, 0, 1, 3}, 5126, "SCALAR", 1));
    expect_close(corner_at(0.5), {1.5f, 0, 0.5f});
    gltf_.root["animations"] = json::array();
    animate(0, "weights", times({0, 1}),
            gltf_.accessor(std::vector<float>{0, 0, 0, 0, 2, 0, 0, 0, 1, 3, 0, 0}, 5126, "SCALAR", 1),
            "CUBICSPLINE");
    expect_close(corner_at(0.5), {1.5f, 0, 0.75f});
}

TEST_F(GltfAnimation, SkinsFollowTheirJoints) {
    gltf_.root["nodes"][0]["skin"] = 0;
    gltf_.root["nodes"].push_back({{"name", "joint"}});
    gltf_.root["scenes"][0]["nodes"] = {0, 1};
    gltf_.root["skins"] = {{{"joints", {1}}}};
    gltf_.primitive()["attributes"]["JOINTS_0"] =
        gltf_.accessor(std::vector<std::uint8_t>(16, 0), 5121, "VEC4", 4);
    gltf_.primitive()["attributes"]["WEIGHTS_0"] =
        gltf_.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    animate(1, "translation", times({0, 1}), gltf_.points({0, 0, 0, 0, 6, 0}));
    expect_close(corner_at(0.5), {0, 3, 0});
    EXPECT_NE(load_at(0).pose, load_at(0.5).pose);
}

TEST_F(GltfAnimation, ChildrenGoAlong) {
    gltf_.root["nodes"].push_back({{"children", {0}}});
    gltf_.root["scenes"][0]["nodes"] = {1};
    animate(1, "translation", times({0, 1}), gltf_.points({0, 0, 0, 0, 0, 2}));
    expect_close(corner_at(0.5), {0, 0, 1});
}

TEST_F(GltfAnimation, OnlyACameraThatMovesLeavesTheLightAsItIs) {
    add_walking_camera();
    const Scene begin = load_at(0);
    const Scene middle = load_at(0.5);
    expect_close(transform_point(middle.camera.to_world, {0, 0, 0}), {0, 0, 6});
    EXPECT_EQ(begin.pose, middle.pose);
    EXPECT_EQ(lighting_hash(begin), lighting_hash(middle));
    EXPECT_NE(scene_hash(begin), scene_hash(middle));
    animate(0, "translation", times({0, 1}), gltf_.points({0, 0, 0, 0, 0, 2}));
    EXPECT_NE(load_at(0).pose, load_at(0.5).pose);
    EXPECT_NE(lighting_hash(load_at(0)), lighting_hash(load_at(0.5)));
}

TEST_F(GltfAnimation, ALightThatMovesIsAnotherPose) {
    add_walking_camera();
    gltf_.root["extensions"] = {
        {"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"intensity", 1}}}}}}};
    gltf_.root["nodes"][1]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    EXPECT_NE(load_at(0).pose, load_at(0.5).pose);
}

TEST_F(GltfAnimation, TheCameraOfAnotherMomentIsThatOfTheWholeScene) {
    add_walking_camera();
    LoadOptions options{.moment = SceneMoment{0, {}}};
    const Scene begin = load(options);
    options.moment->seconds = 0.3;
    for (const auto& fov : {std::optional<double>(), std::optional(50.0)}) {
        options.overrides.fov_degrees = fov;
        const std::optional<SceneCamera> then = camera_at(begin, options);
        ASSERT_TRUE(then.has_value());
        Scene moved = begin;
        moved.camera = *then;
        EXPECT_EQ(scene_hash(moved), scene_hash(load(options)));
    }
    animate(0, "translation", times({0, 1}), gltf_.points({0, 0, 0, 0, 0, 2}));
    load({.moment = SceneMoment{0, {}}});
    EXPECT_FALSE(camera_at(begin, options).has_value());
}

TEST_F(GltfAnimation, WithoutACameraThePictureStaysInItsFrame) {
    animate(0, "translation", times({0, 1}), gltf_.points({0, 0, 0, 0, 0, 20}));
    const Scene rest = load();
    const Scene end = load_at(1);
    EXPECT_EQ(rest.camera.to_world.m, end.camera.to_world.m);
    ASSERT_TRUE(camera_at(end, {.moment = SceneMoment{1, {}}}).has_value());
    EXPECT_EQ(camera_at(end, {.moment = SceneMoment{1, {}}})->to_world.m, rest.camera.to_world.m);
}

TEST_F(GltfAnimation, ACameraThatIsAddedIsNotedOnceAndSeesAllThatTheSceneAtRestHas) {
    // An open surface that shines has a back of its own, whose corners count as well.
    gltf_.material()["emissiveFactor"] = {1, 1, 1};
    gltf_.material()["doubleSided"] = true;
    animate(0, "translation", times({0, 1}), gltf_.points({0, 0, 0, 0, 0, 20}));
    const Scene rest = load();
    const Scene end = load_at(1);
    EXPECT_EQ(rest.camera.to_world.m, end.camera.to_world.m);
    EXPECT_EQ(end.triangles.size(), rest.triangles.size());
    EXPECT_EQ(end.materials.size(), rest.materials.size());
    EXPECT_EQ(end.object_names, rest.object_names);
    for (const Scene* scene : {&rest, &end}) {
        EXPECT_EQ(std::ranges::count_if(
                      scene->notes,
                      [](const Note& note) { return note.text.find("has no camera") != std::string::npos; }),
                  1);
    }
}

TEST_F(GltfAnimation, AreListedWithWhatTheyMoveAndWhyTheyCannotBePlayed) {
    add_walking_camera();
    animate(0, "scale", times({1, 9}), gltf_.points({1, 1, 1, 9, 9, 9}), "LINEAR", "swell");
    gltf_.root["animations"][1]["channels"].push_back(
        {{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}});
    animate(0, "weights", times({0, 1}), gltf_.points({1, 1, 1, 9, 9, 9}));
    animate(0, "color", times({0, 1}), gltf_.points({1, 1, 1, 9, 9, 9}), "LINEAR", "later");
    const std::vector<SceneAnimation> listed = load({.lists_animations = true}).animations;
    EXPECT_TRUE(load().animations.empty());
    ASSERT_EQ(listed.size(), 4u);
    EXPECT_EQ(listed[0].name, "walk");
    EXPECT_EQ(listed[0].motions.at(0).node, "eye");
    EXPECT_EQ(listed[0].motions.at(0).property, "translation");
    EXPECT_EQ(listed[1].span.value().begin, 1.0);
    EXPECT_EQ(listed[1].span.value().end, 9.0);
    EXPECT_EQ(listed[1].motions.size(), 2u);
    EXPECT_EQ(listed[1].fault, "");
    EXPECT_THAT(listed[2].fault, HasSubstr("animation 3 has weights for node 'thing', which has no morph"));
    EXPECT_FALSE(listed[3].span.has_value());
    EXPECT_TRUE(listed[3].motions.empty());
}

TEST_F(GltfAnimation, MotionsOfSeveralThingsArePlayedTogether) {
    add_walking_camera();
    animate(0, "translation", times({0, 2}), gltf_.points({0, 0, 0, 0, 0, 2}), "LINEAR", "rise");
    animate(0, "scale", times({0, 2}), gltf_.points({1, 1, 1, 3, 3, 3}), "LINEAR", "grow");
    animate(0, "scale", times({0, 9}), gltf_.points({1, 1, 1, 9, 9, 9}), "LINEAR", "swell");
    const Scene scene = load_at(1);
    expect_close(corner(scene, 0, 1), {2, 0, 1});
    expect_close(transform_point(scene.camera.to_world, {0, 0, 0}), {0, 0, 7});
    EXPECT_DOUBLE_EQ(scene.animation->end, 2.0);
    ASSERT_FALSE(scene.notes.empty());
    EXPECT_THAT(scene.notes.front().text,
                HasSubstr("animation 'swell' and animation 'grow' both move the scale of node 'thing'; only "
                          "the latter is played"));
    // Those that are named are played, and no others.
    const Scene named = load_at(1, {"swell", "2"});
    expect_close(corner(named, 0, 1), {static_cast<float>(1 + 8.0 / 9), 0, 1});
    expect_close(transform_point(named.camera.to_world, {0, 0, 0}), {0, 0, 0});
    EXPECT_THAT(load_at(1, {"walk", "walk"}).animation->end, 1.0);
}

TEST_F(GltfAnimation, AnimationsThatAreNotThereOrDoNotFitAreRefused) {
    const Error none = error_at(0);
    EXPECT_EQ(none.kind(), ErrorKind::invalid_argument);
    EXPECT_TRUE(mentions(none, "has no animations"));
    add_walking_camera();
    animate(1, "translation", times({0, 2}), gltf_.points({0, 0, 0, 0, 0, 2}), "LINEAR", "run");
    const Error unknown = error_at(0, {"wakl"});
    EXPECT_EQ(unknown.kind(), ErrorKind::invalid_argument);
    EXPECT_TRUE(
        mentions(unknown, "has no animation 'wakl'; did you mean 'walk'? choose one of: 1 (walk), 2 (run)"));
    EXPECT_TRUE(mentions(error_at(0, {"3"}), "has no animation '3'"));
    const Error both = error_at(0, {"walk", "run"});
    EXPECT_EQ(both.kind(), ErrorKind::invalid_argument);
    EXPECT_TRUE(mentions(both, "both move the translation of node 'eye'; choose one"));
    const Error other_format = error_of([&] {
        load_scene(files_.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), {.moment = SceneMoment{}});
    });
    EXPECT_EQ(other_format.kind(), ErrorKind::invalid_argument);
    EXPECT_TRUE(mentions(other_format, "only glTF scenes"));
}

TEST_F(GltfAnimation, BrokenSamplersAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const int two_points = gltf_.points({0, 0, 0, 1, 1, 1});
    struct Case {
        int times;
        int values;
        const char* interpolation;
        const char* message;
    };
    for (const Case& broken :
         {Case{times({1, 0}), two_points, "LINEAR", "animation 1 has times that do not ascend"},
          Case{times({0, nan}), two_points, "LINEAR", "animation 1 has times that are not finite"},
          Case{times({0, 1}), gltf_.points({0, 0, 0, 1, nan, 1}), "LINEAR", "values that are not finite"},
          Case{times({0, 1, 2}), two_points, "LINEAR", "has 6 numbers for its 3 keys, which need 9"},
          Case{times({0, 1}), two_points, "CUBICSPLINE", "has 6 numbers for its 2 keys, which need 18"},
          Case{times({0, 1}), two_points, "BEZIER", "unknown interpolation 'BEZIER'"},
          Case{times({}), gltf_.points({}), "LINEAR", "a sampler without keys"},
          Case{two_points, two_points, "LINEAR", "times that are not 1 number each"},
          Case{times({0, 1}), rotations({0, 0, 0, 1, 0, 0, 0, 1}), "LINEAR",
               "values that are not 3 numbers each"},
          Case{99, two_points, "LINEAR", "animation 1 refers to accessor 99"}}) {
        gltf_.root["animations"] = json::array();
        animate(0, "translation", broken.times, broken.values, broken.interpolation);
        const Error error = error_at(0.5);
        EXPECT_EQ(error.kind(), ErrorKind::file);
        EXPECT_TRUE(mentions(error, broken.message));
        EXPECT_THAT(load().triangles.size(), 2u) << "nothing is played at rest";
    }
}

TEST_F(GltfAnimation, ChannelsThatFitNothingAreRefusedOrIgnored) {
    const int keys = times({0, 1});
    const int values = gltf_.points({0, 0, 0, 1, 1, 1});
    animate(0, "translation", keys, values)["channels"][0]["sampler"] = 7;
    EXPECT_TRUE(mentions(error_at(0), "animation 1 refers to sampler 7"));
    gltf_.root["animations"] = json::array();
    animate(5, "translation", keys, values);
    EXPECT_TRUE(mentions(error_at(0), "animation 1 refers to node 5"));
    gltf_.root["animations"] = json::array();
    animate(0, "weights", keys, keys);
    EXPECT_TRUE(mentions(error_at(0), "has weights for node 'thing', which has no morph targets"));
    gltf_.root["animations"] = json::array();
    animate(0, "visibility", keys, values);
    EXPECT_TRUE(mentions(error_at(0), "its animations move nothing"));
    gltf_.root["animations"] = json::array();
    gltf_.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1};
    animate(0, "translation", keys, values);
    EXPECT_TRUE(mentions(error_at(0), "moves node 'thing', which has a matrix"));
    gltf_.root["nodes"][0].erase("name");
    EXPECT_TRUE(mentions(error_at(0), "moves node 1, which has a matrix")) << "counted from 1";
}

TEST_F(GltfAnimation, PointersAreNotedAsAnApproximation) {
    add_walking_camera();
    gltf_.root["extensionsUsed"] = {"KHR_animation_pointer"};
    EXPECT_THAT(load_at(0).notes.front().text, HasSubstr("KHR_animation_pointer"));
    EXPECT_EQ(error_of([&] { load({.moment = SceneMoment{}, .strict = true}); }).kind(), ErrorKind::file);
    for (const Note& note : load().notes) {
        EXPECT_THAT(note.text, testing::Not(HasSubstr("KHR_animation_pointer"))) << "at rest";
    }
}

}  // namespace
}  // namespace nearlight::core
