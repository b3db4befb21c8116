// SPDX-License-Identifier: Apache-2.0
// Expected colours come from Mitsuba 3.9.1 in its RGB variant (black bodies: in its spectral variant) unless
// they are plain arithmetic.
#include "host/scene/mitsuba/spectra.h"

#include <gtest/gtest.h>

#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;
using mitsuba::Color;

/// The intensity of a point light.
Vec3 intensity(const SceneFiles& files, const std::string& element) {
    return files.load_xml("<emitter type='point'>" + element + "</emitter>").delta_emitters.at(0).radiance;
}

Vec3 ratio(Vec3 a, Vec3 b) {
    return {a.x / b.x, a.y / b.y, a.z / b.z};
}

/// The sample's reflectance is seen under D65, and its light is the spectrum itself.
TEST(Spectra, ListsFilesAndObjectsHaveMitsubasColours) {
    const SceneFiles files;
    files.write("curve.spd", "# a comment\n400 0.2\n500 0.9 # another\n600 0.4\n700 0.8\n");
    const Vec3 light{0.456286f, 0.676869f, 0.506005f};
    for (const char* element :
         {"<spectrum name='intensity' value='400:0.2, 500:0.9, 600:0.4, 700:0.8'/>",
          "<spectrum name='intensity' filename='curve.spd'/>",
          "<spectrum name='intensity' type='irregular'><string name='wavelengths' value='400,500,600,700'/>"
          "<string name='values' value='0.2, 0.9, 0.4, 0.8'/></spectrum>",
          "<spectrum name='intensity' type='regular'><float name='wavelength_min' value='400'/>"
          "<float name='wavelength_max' value='700'/><string name='values' value='0.2, 0.9, 0.4, "
          "0.8'/></spectrum>"}) {
        expect_near(intensity(files, element), light, 2e-5f);
    }
    expect_near(mitsuba::parse_spectrum("400:0.2, 500:0.9, 600:0.4, 700:0.8", {}).reflectance,
                {0.341879f, 0.716989f, 0.568376f}, 2e-5f);
    expect_near(mitsuba::parse_spectrum("540:0, 545:0.5, 550:0", {}).reflectance, {0, 0.0366208f, 0}, 2e-5f);
}

/// In files of Mitsuba 0.5 and 0.6, <rgb> is linear however it is written, and <srgb> never.
TEST(Spectra, ColoursOfOldFiles) {
    const SceneFiles files;
    const auto color = [&](const std::string& version, const std::string& element) {
        const std::string text = "<scene version='" + version + "'>\n<emitter type='point'>" + element +
                                 "</emitter><shape type='rectangle'/></scene>\n";
        return load_scene(files.write("scene.xml", text)).delta_emitters.at(0).radiance.x;
    };
    constexpr float kHalf = 0.21404f;  // what sRGB's 0.5 is
    EXPECT_NEAR(color("0.6.0", "<srgb name='intensity' value='0.5'/>"), kHalf, 1e-4f);
    EXPECT_NEAR(color("0.6.0", "<srgb name='intensity' value='#808080'/>"), kHalf, 3e-3f);
    EXPECT_NEAR(color("0.6.0", "<rgb name='intensity' value='0.5'/>"), 0.5f, 1e-6f);
    EXPECT_NEAR(color("0.6.0", "<rgb name='intensity' value='#808080'/>"), 128.0f / 255, 1e-4f);
    EXPECT_FLOAT_EQ(color("0.6.0", "<spectrum name='intensity' value='2'/>"), 2.0f) << "white";
    EXPECT_NEAR(color("3.0.0", "<rgb name='intensity' value='#808080'/>"), kHalf, 3e-3f);
}

TEST(Spectra, NumbersD65AndColours) {
    const SceneFiles files;
    expect_near(intensity(files, "<spectrum name='intensity' value='2'/>"), {2.40959f, 1.89658f, 1.81783f});
    expect_near(intensity(files, "<float name='intensity' value='3'/>"), {3, 3, 3});
    expect_near(
        intensity(files, "<spectrum type='d65' name='intensity'><float name='scale' value='3'/></spectrum>"),
        {3, 3, 3});
    expect_near(intensity(files,
                          "<texture type='d65' name='intensity'><rgb name='color' value='1,2,3'/><float "
                          "name='scale' value='2'/></texture>"),
                {2, 4, 6});
    expect_near(
        intensity(files,
                  "<spectrum type='uniform' name='intensity'><float name='value' value='3'/></spectrum>"),
        {3, 3, 3});
    expect_near(
        intensity(files,
                  "<spectrum type='srgb' name='intensity'><rgb name='color' value='0.1,2,3'/></spectrum>"),
        {0.1f, 2, 3});
    expect_near(files
                    .load_xml("<spectrum type='d65' id='lamp'><float name='scale' value='7'/></spectrum>"
                              "<emitter type='point'><ref id='lamp' name='intensity'/></emitter>")
                    .delta_emitters.at(0)
                    .radiance,
                {7, 7, 7});
}

TEST(Spectra, BlackBodiesAreAsBrightAsPlanckSays) {
    const SceneFiles files;
    const auto body = [&](const std::string& kelvins) {
        return intensity(
            files, "<spectrum type='blackbody' name='intensity'><float name='temperature' value='" + kelvins +
                       "'/></spectrum>");
    };
    const auto expect_color = [](Vec3 found, Vec3 expected) {
        expect_near(ratio(found, expected), {1, 1, 1}, 0.005f);  // Mitsuba's figures are noisy
    };
    expect_color(body("5000"), {15275.7f, 12094.9f, 9603.4f});
    expect_color(body("9000"), {120573.6f, 132530.0f, 179175.4f});
    const Vec3 old = intensity(files, "<blackbody name='intensity' temperature='5000K' scale='0.5'/>");
    expect_near(ratio(old, body("5000")), {0.5f, 0.5f, 0.5f});

    // Standard illuminant A is a black body of 2856 K with the chromaticity (0.44757, 0.40745).
    const Vec3 rgb = body("2856");
    const double x = 0.412453 * rgb.x + 0.357580 * rgb.y + 0.180423 * rgb.z;
    const double y = 0.212671 * rgb.x + 0.715160 * rgb.y + 0.072169 * rgb.z;
    const double z = 0.019334 * rgb.x + 0.119193 * rgb.y + 0.950227 * rgb.z;
    EXPECT_NEAR(x / (x + y + z), 0.44757, 3e-4);
    EXPECT_NEAR(y / (x + y + z), 0.40745, 3e-4);
}

TEST(Spectra, BadOnesAreRefusedWithTheirLine) {
    const SceneFiles files;
    for (const auto& [element, expected] :
         {std::pair{"<spectrum name='intensity' value='500:1, 400:1'/>", "should increase"},
          {"<spectrum name='intensity' value='500:1'/>", "at least two"},
          {"<spectrum name='intensity' type='blackbody'/>", "needs a 'temperature'"},
          {"<spectrum name='intensity' type='blackbody'><float name='temperature' value='-1'/></spectrum>",
           "greater than 0"},
          {"<spectrum name='intensity' filename='gone.spd'/>", "gone.spd"},
          {"<spectrum name='intensity' type='irregular'><string name='wavelengths' value='1 2'/><string "
           "name='values' value='1'/></spectrum>",
           "as many"}}) {
        const std::string message = file_error([&, &text = element] { intensity(files, text); });
        EXPECT_TRUE(mentions(message, expected)) << message;
        EXPECT_TRUE(mentions(message, "scene.xml:2")) << message;
    }
}

}  // namespace
}  // namespace nearlight::core
