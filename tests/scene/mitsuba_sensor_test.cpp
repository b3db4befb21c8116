// SPDX-License-Identifier: Apache-2.0
// Sensors, films, filters and integrators of Mitsuba's files.
#include "host/scene/camera.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

std::string number(const std::string& name, const std::string& value) {
    return "<float name='" + name + "' value='" + value + "'/>";
}
std::string whole(const std::string& name, int value) {
    return "<integer name='" + name + "' value='" + std::to_string(value) + "'/>";
}
std::string film(const std::string& body, int width = 200, int height = 100) {
    return "<film type='hdrfilm'>" + whole("width", width) + whole("height", height) + body + "</film>";
}
std::string sensor(const std::string& body, const std::string& type = "perspective") {
    return "<sensor type='" + type + "'>" + body + "</sensor>";
}

TEST(MitsubaSensor, ThinLensHasItsLens) {
    const SceneFiles files;
    const SceneCamera lens =
        files.load_xml(sensor(number("apertureRadius", "0.2") + number("focusDistance", "3"), "thinlens"))
            .camera;
    EXPECT_DOUBLE_EQ(lens.aperture_radius, 0.2);
    EXPECT_DOUBLE_EQ(lens.focus_distance, 3.0);
    const SceneCamera far =
        files.load_xml(sensor(number("aperture_radius", "0.2") + number("far_clip", "50"), "thinlens"))
            .camera;
    EXPECT_DOUBLE_EQ(far.focus_distance, 50.0);
    EXPECT_TRUE(mentions(file_error([&] { files.load_xml(sensor("", "thinlens")); }), "aperture_radius"));
}

TEST(MitsubaSensor, OrthographicKeepsItsScale) {
    const SceneFiles files;
    const SceneCamera camera =
        files.load_xml(sensor(to_world("<scale x='4' y='4'/>") + film(""), "orthographic")).camera;
    EXPECT_EQ(camera.kind, CameraKind::orthographic);
    const Camera made = make_camera(camera, camera.width, camera.height);
    // The film is 2 wide before the scale.
    EXPECT_NEAR(length(made.step_x) * 200.0f, 8.0f, 1e-5f);
    EXPECT_NEAR(made.corner.x, 4.0f, 1e-5f);
    EXPECT_NEAR(made.corner.y, 2.0f, 1e-5f);
}

TEST(MitsubaSensor, ClipDistancesHaveMitsubasDefaultsAndBounds) {
    const SceneFiles files;
    const SceneCamera plain = files.load_xml(sensor("")).camera;
    EXPECT_DOUBLE_EQ(plain.near_clip, 0.01);
    EXPECT_DOUBLE_EQ(plain.far_clip, 1e4);
    const SceneCamera given = files.load_xml(sensor(number("nearClip", "2") + number("farClip", "7"))).camera;
    EXPECT_DOUBLE_EQ(given.near_clip, 2.0);
    EXPECT_DOUBLE_EQ(given.far_clip, 7.0);
    for (const std::string& wrong :
         {number("near_clip", "0"), number("near_clip", "3") + number("far_clip", "2")}) {
        EXPECT_TRUE(mentions(file_error([&] { files.load_xml(sensor(wrong)); }), "near_clip")) << wrong;
    }
}

TEST(MitsubaFilm, CropIsAPartOfTheFilm) {
    const SceneFiles files;
    const std::string crop = whole("crop_offset_x", 30) + whole("cropOffsetY", 10) + whole("crop_width", 80) +
                             whole("crop_height", 40);
    const std::string view =
        number("fov", "70") + to_world("<lookat origin='1,2,3' target='0,0,0' up='0,1,0'/>");
    const SceneCamera whole_camera = files.load_xml(sensor(view + film(""))).camera;
    const SceneCamera part_camera = files.load_xml(sensor(view + film(crop))).camera;
    EXPECT_EQ(part_camera.width, 80);
    EXPECT_EQ(part_camera.height, 40);
    const Camera all = make_camera(whole_camera, 200, 100);
    const Camera part = make_camera(part_camera, 80, 40);
    EXPECT_NEAR(length(part.step_x - all.step_x), 0.0f, 1e-8f);
    EXPECT_NEAR(length(part.corner - (all.corner + all.step_x * 30.0f + all.step_y * 10.0f)), 0.0f, 1e-6f);
    EXPECT_TRUE(mentions(file_error([&] {
                             files.load_xml(
                                 sensor(film(whole("crop_offset_x", 1) + whole("crop_width", 200))));
                         }),
                         "scene.xml:2: the film's crop reaches beyond its 200x100 pixels"));
}

TEST(MitsubaSensor, PrincipalPointMovesThePictureByPartsOfTheFilm) {
    const SceneFiles files;
    const std::string offset =
        number("principal_point_offset_x", "0.25") + number("principal_point_offset_y", "-0.1");
    const Camera plain = make_camera(files.load_xml(sensor(film(""))).camera, 200, 100);
    const Camera moved = make_camera(files.load_xml(sensor(offset + film(""))).camera, 200, 100);
    // A quarter of the film's 200 columns, and a tenth of its 100 rows.
    EXPECT_NEAR(length(moved.corner - (plain.corner + plain.step_x * 50.0f - plain.step_y * 10.0f)), 0.0f,
                1e-6f);
    EXPECT_TRUE(
        has_note(files.load_xml(sensor(number("aperture_radius", "1") + offset + film(""), "thinlens")),
                 "unknown property 'principal_point_offset_x'"));
}

TEST(MitsubaFilm, FilterIsTheFilmsOrAGaussian) {
    const SceneFiles files;
    const auto filter = [&](const std::string& body) {
        return files.load_xml(sensor(film(body))).camera.filter;
    };
    EXPECT_EQ(filter(""), default_filter(FilterKind::gaussian));
    EXPECT_EQ(filter("<rfilter type='box'/>"), PixelFilter{});
    EXPECT_EQ(filter("<rfilter type='catmullrom'/>").c, 0.5);
    EXPECT_EQ(filter("<rfilter type='gaussian'>" + number("stddev", "0.8") + "</rfilter>").radius, 3.2);
    EXPECT_EQ(filter("<rfilter type='tent'>" + number("radius", "1.5") + "</rfilter>").radius, 1.5);
    EXPECT_EQ(filter("<rfilter type='lanczos'>" + whole("lobes", 2) + "</rfilter>").radius, 2.0);
    const PixelFilter mitchell =
        filter("<rfilter type='mitchell'>" + number("B", "0.1") + number("C", "0.7") + "</rfilter>");
    EXPECT_EQ(mitchell.b, 0.1);
    EXPECT_EQ(mitchell.c, 0.7);
    EXPECT_TRUE(mentions(file_error([&] { filter("<rfilter type='bicubic'/>"); }),
                         "unknown rfilter 'bicubic'; known ones are box, tent"));
    EXPECT_TRUE(
        files.load_xml(sensor(film("<boolean name='sample_border' value='true'/>"))).camera.sample_border);
}

TEST(MitsubaFilm, LuminanceIsMonochromeAndOtherFormatsAreRefused) {
    const SceneFiles files;
    const auto load = [&](const std::string& format) {
        return files.load_xml(sensor(film("<string name='pixelFormat' value='" + format + "'/>"))).camera;
    };
    EXPECT_TRUE(load("luminance").is_monochrome);
    EXPECT_TRUE(load("luminanceAlpha").is_monochrome);
    EXPECT_FALSE(load("rgba").is_monochrome);
    EXPECT_TRUE(mentions(file_error([&] { load("xyz"); }), "pixel_format 'xyz' is not supported"));
}

/// Radiance is the same; only PNG pictures look otherwise, and how they do is the command line's.
TEST(MitsubaFilm, TheLookOfAnLdrfilmIsLeftOutWithANote) {
    const SceneFiles files;
    const auto notes = [&](const std::string& body, const std::string& type = "ldrfilm") {
        return files.load_xml(sensor("<film type='" + type + "'>" + body + "</film>"));
    };
    const std::string reinhard = "<string name='tonemapMethod' value='Reinhard'/>";
    EXPECT_TRUE(has_note(notes(number("exposure", "1.5")),
                         "scene.xml:2: the film's exposure '1.5' is left out; PNG pictures have it with "
                         "--exposure 1.5"));
    EXPECT_TRUE(has_note(notes(reinhard + number("exposure", "1.5")),
                         "the film's tonemap_method 'reinhard' is left out; --exposure and --tonemap"));
    EXPECT_TRUE(has_note(notes(number("gamma", "1.8")), "the film's gamma '1.8' is left out"));
    const std::string plain = number("exposure", "0") + "<string name='tonemapMethod' value='gamma'/>";
    for (const char* gamma : {"-1", "2.2"}) {
        EXPECT_FALSE(has_note(notes(plain + number("gamma", gamma)), "left out"));
    }
    EXPECT_FALSE(has_note(notes(number("exposure", "1.5"), "hdrfilm"), "left out"));
}

TEST(MitsubaIntegrator, NamesDecideTheDepth) {
    const SceneFiles files;
    const auto load = [&](const std::string& type, const std::string& body = "") {
        return files.load_xml("<integrator type='" + type + "'>" + body + "</integrator>");
    };
    EXPECT_EQ(load("direct").max_depth, 2);
    EXPECT_EQ(load("path", whole("max_depth", 1)).max_depth, 1);
    EXPECT_EQ(load("bdpt", whole("maxDepth", 5)).max_depth, 5);
    EXPECT_EQ(load("volpathmis").max_depth, kUnlimitedPathDepth);
    EXPECT_EQ(load("aov", "<integrator type='direct'/>").max_depth, 2);
    EXPECT_TRUE(load("path", "<boolean name='hideEmitters' value='true'/>").camera.hide_emitters);
    EXPECT_FALSE(load("path").camera.hide_emitters);
    for (const char* type : {"depth", "ao", "stokes", "multichannel"}) {
        EXPECT_TRUE(mentions(file_error([&] { load(type); }),
                             "scene.xml:2: integrator '" + std::string(type) + "' is not supported"));
    }
    const Scene guided = load("guided_path", whole("max_depth", 9));
    EXPECT_EQ(guided.max_depth, 9);
    EXPECT_TRUE(std::any_of(guided.notes.begin(), guided.notes.end(), [](const Note& note) {
        return note.text.starts_with("unknown integrator 'guided_path' is taken for") && note.line == 2;
    }));
    EXPECT_EQ(load("path", whole("max_depth", 1'000'000)).max_depth, 1'000'000);
    for (const char* depth : {"0", "-2", "1000001", "2.5"}) {
        EXPECT_TRUE(mentions(file_error([&] { load("path", number("max_depth", depth)); }),
                             "scene.xml:2: 'max_depth' should be -1 (unlimited), or a whole number from 1"))
            << depth;
    }
}

TEST(MitsubaIntegrator, PropertiesThatMayChangeThePictureAreReported) {
    const SceneFiles files;
    const auto load = [&](const std::string& type, const std::string& body) {
        return files.load_xml("<integrator type='" + type + "'>" + body + "</integrator>");
    };
    const Scene harmless =
        load("path", whole("max_depth", 5) + whole("rrDepth", 5) + whole("block_size", 32) +
                         "<boolean name='strictNormals' value='true'/>"
                         "<boolean name='hide_emitters' value='true'/>");
    EXPECT_FALSE(has_note(harmless, "of integrator"));
    EXPECT_FALSE(has_note(load("photonmapper", whole("globalPhotons", 1000)), "of integrator"));
    EXPECT_FALSE(
        has_note(load("direct", whole("emitter_samples", 4) + whole("shading_samples", 4)), "of integrator"));
    EXPECT_TRUE(has_note(load("path", whole("depth", 5)),
                         "scene.xml:2: unknown property 'depth' of integrator 'path' is ignored"));
    EXPECT_TRUE(has_note(load("direct", whole("max_depth", 5)), "unknown property 'max_depth'"));
    EXPECT_TRUE(has_note(load("aov", whole("depth", 5) + "<integrator type='path'/>"),
                         "unknown property 'depth' of integrator 'aov'"));
    EXPECT_FALSE(has_note(load("guided_path", whole("training", 5)), "'training'"))
        << "nobody knows what it means";
}

TEST(MitsubaIntegrator, TheLastOfSeveralCounts) {
    const SceneFiles files;
    const Scene scene =
        files.load_xml("<integrator type='path'/>\n<integrator type='direct'/>\n<integrator type='path'>" +
                       whole("max_depth", 7) + "</integrator>");
    EXPECT_EQ(scene.max_depth, 7);
    EXPECT_TRUE(has_note(scene, "scene.xml:3: the scene has several integrators; only the last one counts"));
}

}  // namespace
}  // namespace nearlight::core
