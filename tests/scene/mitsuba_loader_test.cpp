// SPDX-License-Identifier: Apache-2.0
// Expected values come from Mitsuba 3.9.1 (ray_intersect, sample_ray, eval) unless they are plain arithmetic.
#include <cmath>
#include <numbers>

#include "host/image/image_io.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

Material material_of(const SceneFiles& files, const std::string& bsdf) {
    return files.load_xml(shape("rectangle", bsdf)).materials.at(0);
}

TEST(MitsubaBsdf, ReferencesShareAMaterialAndReflectanceIsClamped) {
    const SceneFiles files;
    const Scene scene = files.load_xml(
        shape("rectangle", "<ref name='bsdf' id='late'/>") + shape("cube", "<ref id='late'/>") +
        "\n<bsdf type='diffuse' id='late'><rgb name='reflectance' value='1.5 0.2 0.1'/></bsdf>");
    ASSERT_EQ(scene.materials.size(), 1u);
    expect_near(scene.materials[0].reflectance.value, {1, 0.2f, 0.1f});
    EXPECT_TRUE(has_note(scene, "scene.xml:3: 'reflectance' lies outside"));
}

TEST(MitsubaValues, ColoursAndSpectra) {
    const SceneFiles files;
    const auto base = [&](const std::string& value) {
        return material_of(files, "<bsdf type='diffuse'>" + value + "</bsdf>").reflectance.value;
    };
    expect_near(base("<rgb name='reflectance' value='0.1, 0.2, 0.3'/>"), {0.1f, 0.2f, 0.3f});
    expect_near(base("<rgb name='reflectance' value='0.1 0.2 0.3'/>"), {0.1f, 0.2f, 0.3f});
    expect_near(base("<rgb name='reflectance' value='0.25'/>"), {0.25f, 0.25f, 0.25f});
    expect_near(base("<rgb name='reflectance' value='#ff8000'/>"), {1, 0.21586f, 0});
    expect_near(base("<spectrum name='reflectance' value='0.25'/>"), {0.25f, 0.25f, 0.25f});
    expect_near(base("<spectrum name='reflectance' value='0.1 0.2 0.3'/>"), {0.1f, 0.2f, 0.3f});
    expect_near(base("<spectrum name='reflectance' value='0.1, 0.2, 0.3'/>"), {0.1f, 0.2f, 0.3f});
    expect_near(base("<spectrum name='reflectance' value='400:0.1, 500:0.2, 600:0.8, 700:0.9'/>"),
                {0.9587f, 0.4464f, 0.1057f}, 0.05f);
    const Scene scene =
        files.load_xml("<emitter type='constant'><spectrum name='radiance' value='5'/></emitter>");
    expect_near(scene.environment.radiance.at(0), {6.02397f, 4.74146f, 4.54458f}, 1e-3f);
}

TEST(MitsubaEmitter, AreaPointSpotConstantEnvmap) {
    const SceneFiles files;
    Image sky = make_image(4, 2, {"R", "G", "B"});
    sky.at(1, 0, 0) = 3.0f;
    write_image(files.path("sky.exr"), sky);
    const Scene scene = files.load_xml(
        shape("rectangle", "<emitter type='area'><rgb name='radiance' value='1,2,3'/></emitter>") +
        "<emitter type='point'><point name='position' x='1' y='2' z='3'/><rgb name='intensity' "
        "value='7'/></emitter>"
        "<emitter type='spot'><rgb name='intensity' value='10'/><float name='cutoff_angle' value='40'/>" +
        to_world("<lookat origin='0,5,0' target='0,0,0' up='0,0,1'/>") +
        "</emitter><emitter type='envmap'><string name='filename' value='sky.exr'/><float name='scale' "
        "value='2'/>" +
        to_world("<rotate y='1' angle='90'/><scale value='3'/>") + "</emitter>");
    expect_near(scene.materials[scene.triangles[0].material].emission.value, {1, 2, 3});
    ASSERT_EQ(scene.delta_emitters.size(), 2u);
    expect_near(scene.delta_emitters[0].position, {1, 2, 3});
    expect_near(scene.delta_emitters[1].position, {0, 5, 0});
    expect_near(scene.delta_emitters[1].direction, {0, -1, 0});
    EXPECT_NEAR(scene.delta_emitters[1].beam_angle, degrees_to_radians(30), 1e-6f);
    EXPECT_EQ(scene.environment.width, 4);
    expect_near(scene.environment.radiance[1], {6, 0, 0});
    expect_near(transform_vector(scene.environment.to_world, {0, 0, 1}), {1, 0, 0});
}

/// Mitsuba 0.5 and 0.6 make the axis one of length 1, Mitsuba 3 does not: its matrix of this element is
/// (0.9659, −0.2588, 0.2588; 0.2588, 1, 0.0341; −0.2588, 0.0341, 1).
TEST(MitsubaTransform, RotatesAboutAnAxisAsItsVersionDoes) {
    const SceneFiles files;
    const auto corner_of = [&](const std::string& version, const std::string& rotate) {
        const Scene scene = load_scene(files.write(
            "scene.xml", "<scene version='" + version + "'>" +
                             shape("rectangle", to_world("<translate x='1' y='1'/>" + rotate)) + "</scene>"));
        Vec3 max = scene.vertices.at(0).position;
        for (const Vertex& vertex : scene.vertices) {
            max = vertex.position.x > max.x || (vertex.position.x == max.x && vertex.position.y > max.y)
                      ? vertex.position
                      : max;
        }
        return max;
    };
    const std::string unit = "<rotate z='1' angle='15'/>";
    const std::string longer = "<rotate x='0' y='1' z='1' angle='15'/>";
    const double c = std::cos(std::numbers::pi / 12);
    const double s = std::sin(std::numbers::pi / 12);
    for (const char* version : {"0.5.0", "0.6.0", "2.0.0", "3.0.0"}) {
        const Vec3 turned = corner_of(version, unit);  // the corner (2, 0)
        expect_near(turned, {static_cast<float>(2 * c), static_cast<float>(2 * s), 0});
        expect_near(corner_of(version, "<rotate x='0' y='0' z='0' angle='0'/>"), {2, 2, 0});
    }
    for (const char* version : {"2.0.0", "3.0.0"}) {
        expect_near(corner_of(version, longer), {2 * 0.965926f, 2 * 0.258819f, 2 * -0.258819f});
    }
    const auto r = static_cast<float>(s * std::sqrt(0.5));  // of a unit axis
    expect_near(corner_of("0.6.0", longer), {static_cast<float>(2 * c), 2 * r, -2 * r});
}

/// The axes of Mitsuba's functions coordinate_system() and, in 0.6, coordinateSystem().
TEST(MitsubaTransform, LookatWithoutAnUpTakesTheAxisOfItsVersion) {
    const SceneFiles files;
    const auto up_of = [&](const std::string& version, const std::string& up) {
        const Scene scene = load_scene(
            files.write("scene.xml", "<scene version='" + version + "'><sensor type='perspective'>" +
                                         to_world("<lookat origin='0,0,0' target='2,0,0'" + up + "/>") +
                                         "</sensor></scene>"));
        expect_near(transform_vector(scene.camera.to_world, {0, 0, 1}), {1, 0, 0});
        return transform_vector(scene.camera.to_world, {0, 1, 0});
    };
    for (const char* up : {"", " up=''", " up='0,0,0'"}) {
        expect_near(up_of("3.0.0", up), {0, 0, -1});
        expect_near(up_of("0.6.0", up), {0, -1, 0});
    }
    const std::string parallel = "<lookat origin='0,0,0' target='2,0,0' up='1,0,0'/>";
    EXPECT_TRUE(mentions(file_error([&] { files.load_xml(shape("cube", to_world(parallel))); }),
                         "scene.xml:2: the up vector of lookat is parallel to the line of sight"));
}

TEST(MitsubaTransform, OneNumberStandsForThree) {
    const SceneFiles files;
    const Scene scene =
        files.load_xml(shape("rectangle", to_world("<translate value='1'/><scale value='2'/>")) +
                       "<emitter type='point'><point name='position' value='3'/></emitter>"
                       "<emitter type='directional'><vector name='direction' value='-1'/></emitter>");
    expect_near(scene.vertices.at(0).position, {0, 0, 2});  // the corner (−1, −1, 0)
    ASSERT_EQ(scene.delta_emitters.size(), 2u);
    expect_near(scene.delta_emitters[0].position, {3, 3, 3});
    expect_near(scene.delta_emitters[1].direction, Vec3{1, 1, 1} * -std::sqrt(1 / 3.0f));
    EXPECT_TRUE(
        mentions(file_error([&] { files.load_xml(shape("cube", to_world("<translate value='1,2'/>"))); }),
                 "'1,2' should be three numbers"));
}

TEST(MitsubaEmitter, SpotTextureProjectorAndDirectional) {
    const SceneFiles files;
    write_image(files.path("wide.exr"), make_image(4, 2, {"R", "G", "B"}));
    const std::string bitmap = "type='bitmap'><string name='filename' value='wide.exr'/></texture>";
    const Scene scene = files.load_xml(
        "<emitter type='spot'><float name='cutoff_angle' value='45'/><texture name='texture' " + bitmap +
        to_world("<translate x='1'/>") +
        "</emitter><emitter type='projector'><float name='fov' value='90'/><float name='scale' value='2'/>"
        "<texture name='irradiance' " +
        bitmap + to_world("<lookat origin='0,5,0' target='0,0,0' up='0,0,1'/>") +
        "</emitter><emitter type='directional'><vector name='direction' x='0' y='-2' z='0'/>"
        "<rgb name='irradiance' value='1,2,3'/></emitter>"
        "<emitter type='directional'>" +
        to_world("<rotate y='1' angle='90'/>") + "</emitter>");
    ASSERT_EQ(scene.delta_emitters.size(), 4u);
    const Emitter& spot = scene.delta_emitters[0];
    EXPECT_EQ(spot.image, 1u);
    expect_near(spot.radiance, {1, 1, 1});  // the default
    expect_near(spot.x_axis, {0.5f, 0, 0});
    expect_near(spot.y_axis, {0, 0.5f, 0});
    const Emitter& projector = scene.delta_emitters[1];
    EXPECT_EQ(projector.image, 2u);
    expect_near(projector.radiance, Vec3{2, 2, 2} * kPi);
    expect_near(projector.direction, {0, -1, 0});
    EXPECT_NEAR(projector.area, 2.0f, 1e-5f);      // 2 wide, 1 high
    expect_near(projector.y_axis, {0, 0, -1.0f});  // the top row lies on the side of +Y
    EXPECT_NEAR(length(projector.x_axis), 0.5f, 1e-6f);
    expect_near(scene.delta_emitters[2].direction, {0, -1, 0});
    expect_near(scene.delta_emitters[2].radiance, {1, 2, 3});
    expect_near(scene.delta_emitters[3].direction, {1, 0, 0});
    EXPECT_TRUE(has_note(files.load_xml("<emitter type='spot'>" + to_world("<scale x='2'/>") + "</emitter>"),
                         "distorts its beam"));
    EXPECT_TRUE(mentions(file_error([&] {
                             files.load_xml(
                                 "<emitter type='directional'><vector name='direction' x='0' y='0' "
                                 "z='0'/></emitter>");
                         }),
                         "is zero"));
}

double fov_x(const SceneFiles& files, const std::string& body, int width, int height) {
    return files
        .load_xml("<sensor type='perspective'>" + body +
                  "<film type='hdrfilm'><integer name='width' value='" + std::to_string(width) +
                  "'/><integer name='height' value='" + std::to_string(height) + "'/></film></sensor>")
        .camera.fov_x_degrees;
}

TEST(MitsubaSensor, EveryFovAxisAndFocalLength) {
    const SceneFiles files;
    const auto with_axis = [&](const std::string& axis) {
        return fov_x(files, "<float name='fov' value='40'/><string name='fovAxis' value='" + axis + "'/>",
                     200, 100);
    };
    EXPECT_NEAR(fov_x(files, "<float name='fov' value='40'/>", 200, 100), 40.0, 1e-4);
    EXPECT_NEAR(with_axis("x"), 40.0, 1e-4);
    EXPECT_NEAR(with_axis("y"), 72.10478, 1e-4);
    EXPECT_NEAR(with_axis("diagonal"), 36.06479, 1e-4);
    EXPECT_NEAR(with_axis("smaller"), 72.10478, 1e-4);
    EXPECT_NEAR(with_axis("larger"), 40.0, 1e-4);
    EXPECT_NEAR(fov_x(files, "<string name='focal_length' value='50mm'/>", 200, 100), 42.31172, 1e-4);
    EXPECT_NEAR(fov_x(files, "", 768, 576), 38.1848, 1e-3);
}

TEST(MitsubaSensor, LooksAlongPlusZWithPlusXToTheLeft) {
    const SceneFiles files;
    const Scene scene = files.load_xml(
        "<sensor type='perspective'><transform name='toWorld'><lookAt origin='0,0,4' target='0,0,0' "
        "up='0,1,0'/>"
        "</transform><sampler type='independent'><integer name='sampleCount' value='9'/></sampler></sensor>"
        "<integrator type='path'><integer name='maxDepth' value='-1'/></integrator>");
    expect_near(transform_vector(scene.camera.to_world, {0, 0, 1}), {0, 0, -1});
    expect_near(transform_vector(scene.camera.to_world, {1, 0, 0}), {-1, 0, 0});
    EXPECT_EQ(scene.samples_per_pixel, 9);
    EXPECT_EQ(scene.max_depth, kUnlimitedPathDepth);
}

TEST(MitsubaIntegrator, VplsStopAtDepthFiveUnlessTheFileSaysOtherwise) {
    const SceneFiles files;
    EXPECT_EQ(files.load_xml("<integrator type='vpl'/>").max_depth, 5);
    EXPECT_EQ(
        files.load_xml("<integrator type='vpl'><integer name='maxDepth' value='7'/></integrator>").max_depth,
        7);
    EXPECT_EQ(files.load_xml("<integrator type='bdpt'/>").max_depth, kUnlimitedPathDepth);
}

TEST(MitsubaEmitter, AnAreaLightMayStandBesideItsShape) {
    const SceneFiles files;
    const std::string light = "<emitter type='area' id='lamp'><rgb name='radiance' value='1,2,3'/></emitter>";
    for (const std::string& body :
         {light + shape("rectangle", "<ref id='lamp'/>"), shape("rectangle", "<ref id='lamp'/>") + light}) {
        const Scene scene = files.load_xml(body);
        expect_near(scene.materials[scene.triangles[0].material].emission.value, {1, 2, 3});
        EXPECT_FALSE(has_note(scene, "area light"));
    }
    EXPECT_TRUE(has_note(files.load_xml(shape("rectangle", "") + light), "no shape has this area light"));
    const Scene plain =
        files.load_xml("<emitter type='area' id='lamp'/>" + shape("rectangle", "<ref id='lamp'/>"));
    EXPECT_FALSE(has_note(plain, "area light")) << "a lamp of the usual radiance says nothing of itself";
}

TEST(MitsubaEmitter, AnAreaLightWithoutARadianceHasOne) {
    const SceneFiles files;
    const Scene scene = files.load_xml(shape("rectangle", "<emitter type='area'/>"));
    expect_near(scene.materials[scene.triangles.at(0).material].emission.value, {1, 1, 1});
}

TEST(MitsubaXml, ADollarMayBeEscaped) {
    const SceneFiles files;
    const LoadOptions options{.parameters = {{"folder", "a\\"}}};
    const Scene scene =
        files.load_xml("<shape type='rectangle' id='\\$5 of $folder$folder\\$folder'/>", options);
    EXPECT_EQ(scene.object_names.at(0), "$5 of a\\a\\$folder");
}

TEST(MitsubaXml, DefaultsOverridesAndIncludes) {
    const SceneFiles files;
    files.write("part.xml", "<scene version='3.0.0'><shape type='$kind'/></scene>");
    const std::string body = "<default name='kind' value='rectangle'/><include filename='part.xml'/>";
    EXPECT_EQ(files.load_xml(body).triangles.size(), 2u);
    EXPECT_EQ(files.load_xml(body, {.parameters = {{"kind", "cube"}}, .strict = false}).triangles.size(),
              12u);
    EXPECT_EQ(files.load_xml("<default name='k' value='cu'/><shape type='$kbe'/>").triangles.size(), 12u)
        << "$k begins the word";
}

TEST(MitsubaXml, FilesAreLookedForInPathsAndInTheFolderOfTheScene) {
    const SceneFiles files;
    const auto write_triangles = [&](const std::string& file, int count) {
        std::string faces;
        for (int i = 0; i < count; ++i) {
            faces += "f 1 2 3\n";
        }
        files.write(file, "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + faces);
    };
    const auto triangles = [&](const std::string& body) { return files.load_xml(body).triangles.size(); };
    const std::string shape = "<shape type='obj'><string name='filename' value='meshes\\a.obj'/></shape>";
    files.write("parts/part.xml", "<scene version='3.0.0'>" + shape + "</scene>");
    const std::string part = "<include filename='parts/part.xml'/>";

    write_triangles("parts/meshes/a.obj", 1);
    EXPECT_EQ(triangles(part), 1u);
    write_triangles("meshes/a.obj", 2);
    EXPECT_EQ(triangles(shape), 2u);
    EXPECT_EQ(triangles(part), 2u) << "the folder of the scene comes before that of the included file";
    write_triangles("common/meshes/a.obj", 3);
    write_triangles("common/late/meshes/a.obj", 4);
    EXPECT_EQ(triangles("<path value='common'/>" + shape), 3u);
    EXPECT_EQ(triangles(shape + "<path value='common'/>"), 3u);
    EXPECT_EQ(triangles("<path value='common'/><path value='late'/>" + shape), 4u);
    EXPECT_EQ(triangles("<path value='common/late'/><path value='common'/>" + shape), 3u);
    files.write("common/parts/part.xml", "<scene version='3.0.0'><path value='late'/></scene>");
    EXPECT_EQ(triangles("<path value='common'/>" + part + shape), 4u);
}

TEST(MitsubaXml, ParametersThatTheFileDoesNotHaveAreRefused) {
    const SceneFiles files;
    const auto message = [&](const std::string& body) -> std::string {
        try {
            files.load_xml(body, {.parameters = {{"knid", "cube"}}});
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
            return error.what();
        }
        return "";
    };
    EXPECT_TRUE(mentions(message("<default name='kind' value='cube'/><default name='size' value='1'/>"),
                         "has no parameter 'knid'; it has: kind, size"));
    EXPECT_TRUE(mentions(message(""), "has no parameter 'knid'; it has none"));
    EXPECT_EQ(message("<shape type='$knid'/>"), "");
    EXPECT_EQ(message("<default name='knid' value='sphere'/>"), "");
}

TEST(MitsubaXml, EveryErrorNamesFileAndLine) {
    const SceneFiles files;
    files.write("broken.obj", "v 0 0 0\nf 1 2 3\n");
    const std::pair<const char*, const char*> cases[] = {
        {"<shape type='blob'/>", "unknown shape 'blob'; known ones are obj"},
        {"<bsdf type='hk' id='p'/><shape type='cube'><ref id='p'/></shape>", "unknown bsdf 'hk'"},
        {"<emitter type='collimated'/>", "unknown emitter"},
        {"<sensor type='fisheye'/>", "unknown sensor"},
        {"<shape type='cube'><ref id='nobody'/></shape>", "nothing has the id 'nobody'"},
        {"<bsdf type='diffuse' id='a'/><bsdf type='diffuse' id='a'/>", "used twice"},
        {"<shape type='obj'><string name='filename' value='gone.obj'/></shape>", "no such file"},
        {"<shape type='obj'><string name='filename' value='broken.obj'/></shape>", "broken.obj:2"},
        {"<shape type='obj'/>", "needs a string 'filename'"},
        {"<shape type='sphere'><float name='radius' value='big'/></shape>", "not a finite number"},
        {"<shape type='sphere'><float name='radius' value='1e999'/></shape>", "not a finite number"},
        {"<shape type='sphere'><string name='radius' value='1'/></shape>", "should be a number"},
        {"<shape type='cube'><float name='x' value='$x'/></shape>", "parameter '$x' has no value"},
        {"<include filename='gone.xml'/>", "cannot be read"},
        {"<include filename='scene.xml'/>", "includes itself"},
        {"<path value='gone'/>", "gone' does not exist"},
        {"<path value='broken.obj'/>", "broken.obj' does not exist"},
        {"<path/>", "needs an attribute 'value'"},
        {"<shape type='cube'><path value='.'/></shape>", "directly in <scene>"},
        {"<wobble/>", "unknown element <wobble>"},
        {"<emitter type='point'><float name='power' value='1'/></emitter>", "power"},
        {"<emitter type='point'><point name='position' x='0' y='0' z='2'/><transform name='to_world'><scale "
         "value='2'/></transform></emitter>",
         "either 'position' or 'to_world'"},
        {"<emitter type='sky'><integer name='year' value='1000000000'/></emitter>", "from 1 to 9999"},
        {"<bsdf type='twosided' id='a'><ref id='a'/></bsdf><shape type='cube'><ref id='a'/></shape>",
         "itself"},
        {"<shape type='merge' id='m'><ref id='m'/></shape>", "one contains itself"},
        {"<shape type='shapegroup' id='g'><shape type='instance'><ref id='g'/></shape></shape>"
         "<shape type='instance'><ref id='g'/></shape>",
         "only plain shapes"},
        {"<sensor type='perspective'><float name='fov' value='190'/></sensor>", "between 0 and 180"},
        {"<shape type='cube'><transform name='to_world'><matrix value='1 2 3'/></transform></shape>",
         "16 or 9"},
        {"<shape type='cube'", "broken XML"},
    };
    for (const auto& [body, expected] : cases) {
        const std::string message = file_error([&, &text = body] { files.load_xml(text); });
        EXPECT_TRUE(mentions(message, expected)) << message;
        EXPECT_TRUE(mentions(message, "scene.xml:2: ") || mentions(message, "scene.xml:3: ")) << message;
    }
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files.write("e.xml", "")); }), "e.xml:1: broken XML"));
    EXPECT_TRUE(
        mentions(file_error([&] { load_scene(files.write("w.xml", "<svg/>")); }), "not a Mitsuba scene"));
}

TEST(MitsubaXml, UnknownPropertiesAreNotedOnceAndStrictRefusesThem) {
    const SceneFiles files;
    const std::string body = shape("cube", "<float name='fizz' value='1'/>");
    const Scene scene = files.load_xml(body + body);
    EXPECT_TRUE(has_note(scene, "scene.xml:2: unknown property 'fizz' of shape 'cube' is ignored"));
    EXPECT_EQ(scene.notes.size(), 3u);  // including those about light and sensor
    EXPECT_TRUE(mentions(file_error([&] { files.load_xml(body, {.parameters = {}, .strict = true}); }),
                         "loading is strict"));
    EXPECT_TRUE(has_note(scene, "nothing in the scene emits light"));
}

TEST(MitsubaXml, MediaAreLeftOutWithANoteAndStrictRefusesThem) {
    const SceneFiles files;
    const std::string medium = "<medium type='homogeneous'/>";
    const std::string body = shape("cube", "<bsdf type='null'/>" + medium);
    for (const std::string& text : {body, medium + shape("cube"),
                                    "<sensor type='perspective'>" + medium + "</sensor>" + shape("cube")}) {
        const Scene scene = files.load_xml(text);
        EXPECT_EQ(scene.triangles.size(), 12u);
        EXPECT_TRUE(has_note(scene, "scene.xml:2: participating media are left out")) << text;
        EXPECT_TRUE(mentions(file_error([&] { files.load_xml(text, {.parameters = {}, .strict = true}); }),
                             "participating media"));
    }
    EXPECT_TRUE(mentions(file_error([&] { files.load_xml(shape("cube", "<subsurface type='dipole'/>")); }),
                         "subsurface scattering is not supported"));
}

TEST(MitsubaXml, AnEmptySceneIsASceneWithNotes) {
    const SceneFiles files;
    const Scene scene = files.load_xml("");
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_TRUE(has_note(scene, "no triangles"));
}

}  // namespace
}  // namespace nearlight::core
