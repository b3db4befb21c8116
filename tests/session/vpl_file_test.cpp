// SPDX-License-Identifier: Apache-2.0
#include "host/session/vpl_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>

#include "host/base/files.h"
#include "host/base/packed_direction.h"
#include "tests/image/temporary_folder.h"
#include "tests/session/corner_scene.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::corner;
using test::few_vpls;
using test::render_image;

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    "property double nx\nproperty float ny\nproperty float nz\nproperty float red\nproperty float green\n"
    "property float blue\n";

template <typename Action>
void expect_error(Action&& action, ErrorKind kind, const std::string& part) {
    const Error error = test::error_of(action);
    EXPECT_EQ(error.kind(), kind);
    EXPECT_TRUE(test::mentions(error, part));
}

class VplFiles : public test::DeviceTest {
  protected:
    std::filesystem::path write(const std::string& text) const {
        write_text(folder_ / "text.ply", text);
        return folder_ / "text.ply";
    }
    /// Makes VPLs for the scene's view, writes them to a file, and returns the picture of them.
    Image save(Session& session, const RenderSettings& settings) const {
        const View view = session.look(settings.view, settings.seed);
        session.save_vpls(view, session.sample(view, settings.sampling, settings.seed), file_);
        return render_image(session, settings).image;
    }
    [[nodiscard]] RenderSettings with_file(RenderSettings settings) const {
        settings.sampling = {.vpl_count = 3, .file = file_};
        return settings;
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "vpls.ply";
};

TEST_F(VplFiles, GiveThePictureOfTheVplsThatWereSaved) {
    on_each_device([&](Device& device) {
        const Scene scene = corner();
        for (const SamplerKind sampler : {SamplerKind::close_range, SamplerKind::instant_radiosity}) {
            for (const bool cuts : {false, true}) {
                RenderSettings settings = few_vpls(sampler);
                settings.sampling.cuts = cuts;
                Session session(device, scene);
                const Image saved = save(session, settings);
                Session later(device, scene);
                EXPECT_EQ(render_image(later, with_file(settings)).image.values, saved.values) << cuts;
            }
        }
    });
}

TEST_F(VplFiles, LightTheSceneForOtherCameras) {
    on_each_device([&](Device& device) {
        Scene scene = corner();
        Session session(device, scene);
        save(session, few_vpls());
        set_camera(scene, {0.5, 1.2, -2}, {0, 0.5, 1}, 40);
        Session other(device, scene);
        const test::Rendering rendering = render_image(other, with_file(few_vpls()));
        EXPECT_EQ(rendering.report.totals.close_vpls + rendering.report.totals.distant_vpls,
                  read_vpl_file(file_).vpls.size());
    });
}

TEST_F(VplFiles, AreForTheirSceneDepthAndSinglePassOnly) {
    on_each_device([&](Device& device) {
        Scene scene = corner();
        Session session(device, scene);
        save(session, few_vpls());
        RenderSettings settings = with_file(few_vpls());
        settings.view.max_depth = 3;
        expect_error([&] { render_image(session, settings); }, ErrorKind::file,
                     "made for a maximum depth of " + std::to_string(kUnlimitedPathDepth) + ", not of 3");
        EXPECT_EQ(test::error_of([&] { render_image(session, settings); }).setting(), "max_depth");
        settings = with_file(few_vpls());
        settings.passes = 2;
        expect_error([&] { render_image(session, settings); }, ErrorKind::invalid_argument,
                     "the same in every pass");
        scene.materials[0].reflectance = parameter_of(Vec3{0.1f, 0.1f, 0.1f});
        Session other(device, scene);
        expect_error([&] { render_image(other, with_file(few_vpls())); }, ErrorKind::file,
                     "made for another scene");
        expect_error([&] { save(session, few_vpls(SamplerKind::local)); }, ErrorKind::invalid_argument,
                     "local cannot be saved");
    });
}

/// Other programs leave out what is nearlight's own.
TEST_F(VplFiles, OfOtherProgramsGiveTheSameLight) {
    on_each_device([&](Device& device) {
        const Scene scene = corner();
        Session session(device, scene);
        RenderSettings settings = few_vpls();
        settings.view.clamp_radius = 0.1f;
        const Image saved = save(session, settings);
        VplFile set = read_vpl_file(file_);
        std::string text = kHeader + "end_header\n";
        text.replace(text.find("vertex 1"), 8, "vertex " + std::to_string(set.vpls.size()));
        for (const Vpl& vpl : set.vpls) {
            for (const Vec3 v : {vpl.position, vpl.normal, vpl.power}) {
                for (const float number : {v.x, v.y, v.z}) {
                    std::array<char, 32> digits{};
                    std::snprintf(digits.data(), digits.size(), "%.9g ", static_cast<double>(number));
                    text += digits.data();
                }
            }
            text += "\n";
        }
        file_ = write(text);
        EXPECT_FALSE(read_vpl_file(file_).origin);
        EXPECT_EQ(render_image(session, with_file(settings)).image.values, saved.values);
    });
}

TEST(VplFile, KeepsEveryBit) {
    const TemporaryFolder folder;
    const Vpl vpl{.position = {0.1f, -2e-20f, 3e7f},
                  .depth = 3,
                  .normal = {0.6f, 0, -0.8f},
                  .flags = NEARLIGHT_VPL_CLOSE,
                  .power = {0, 1e-30f, 7},
                  .shading = 0xfffefdfcu};
    write_vpl_file(folder / "a.ply",
                   {.vpls = {vpl, vpl, vpl},
                    .origin = VplOrigin{.scene = 0xfedcba9876543210u,
                                        .max_depth = 5,
                                        .close_count = 2,
                                        .asked_count = 1,
                                        .ray_budget = RayBudget{0.123456789f, 32, 7.7777777f}}});
    const VplFile read = read_vpl_file(folder / "a.ply");
    ASSERT_EQ(read.vpls.size(), 3u);
    EXPECT_EQ(std::memcmp(&read.vpls[2], &vpl, sizeof(Vpl)), 0);
    ASSERT_TRUE(read.origin);
    EXPECT_EQ(read.origin->scene, 0xfedcba9876543210u);
    EXPECT_EQ(read.origin->max_depth, 5u);
    EXPECT_EQ(read.origin->close_count, 2u);
    EXPECT_EQ(read.origin->asked_count, 1u);
    ASSERT_TRUE(read.origin->ray_budget);
    EXPECT_EQ(read.origin->ray_budget->clamp_radius, 0.123456789f);
    EXPECT_EQ(read.origin->ray_budget->direct_samples_per_pixel, 32u);
    EXPECT_EQ(read.origin->ray_budget->shared_limit, 7.7777777f);
}

TEST(VplFile, BrokenFilesAreErrors) {
    const TemporaryFolder folder;
    const auto fails = [&](const std::string& text, const std::string& part) {
        write_text(folder / "a.ply", text);
        expect_error([&] { read_vpl_file(folder / "a.ply"); }, ErrorKind::file, part);
    };
    const std::string header = kHeader + "end_header\n";
    expect_error([&] { read_vpl_file(folder / "nosuch.ply"); }, ErrorKind::file, "no such file");
    fails("text", "not a PLY file");
    fails("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "no property `y`");
    fails("ply\nformat ascii 1.0\nend_header\n", "called `vertex`");
    fails(header + "0 0 0 0 0 1 1 1\n", "truncated");
    fails(header + "0 0 nan 0 0 1 1 1 1\n", "VPL 0 is broken");
    fails(header + "0 0 0 0 0 0 1 1 1\n", "VPL 0 is broken");
    fails(header + "0 0 0 0 0 1 1 -1 1\n", "VPL 0 is broken");
    fails(header + "0 0 0 0 0 1 1 1e39 1\n", "VPL 0 is broken");
    std::string many = header;
    many.replace(many.find("vertex 1"), 8, "vertex 99999999999");
    fails(many, "more than 50000000 VPLs");
    // Bit 1 would have a gather square the light.
    fails(kHeader + "property uint flags\nend_header\n0 0 0 0 0 1 1 1 1 2\n",
          "flags that nearlight does not know");
    const std::string format = "ply\nformat ascii 1.0\n";
    const auto titled = [&](const std::string& comments) {
        return format + "comment nearlight virtual point lights, version 1\n" + comments +
               header.substr(format.size()) + "0 0 0 0 0 1 1 1 1\n";
    };
    fails(titled(""), "no number `scene`");
    for (const auto& [radius, samples] : {std::pair{"nan", "16"},
                                          {"inf", "16"},
                                          {"-1", "16"},
                                          {"1e10", "16"},
                                          {"0.5", "0"},
                                          {"0.5", "1000001"},
                                          {"0.5", "4294967295"}}) {
        fails(titled(std::string("comment scene 1\ncomment max_depth 8\ncomment close 0\ncomment asked 0\n") +
                     "comment clamp_radius " + radius + "\ncomment light_samples " + samples + "\n"),
              "clamp radius must be from 0");
    }
    for (const char* limit : {"-1", "nan", "inf"}) {
        fails(
            titled(std::string("comment scene 1\ncomment max_depth 8\ncomment close 0\ncomment asked 0\n") +
                   "comment clamp_radius 1\ncomment light_samples 16\ncomment shared_limit " + limit + "\n"),
            "shared limit must be a finite number");
    }
    for (const char* rays : {"-1", "yes", "65"}) {
        fails(titled(std::string("comment scene 1\ncomment max_depth 8\ncomment close 0\ncomment asked 0\n") +
                     "comment clamp_radius 1\ncomment light_samples 16\ncomment aimed_rays " + rays + "\n"),
              "aimed");
    }
    VplFile odd{.vpls = {Vpl{}}};
    odd.vpls[0].flags = 7u << NEARLIGHT_VPL_CURVE_SHIFT;
    expect_error([&] { check_vpls(odd, corner(), 8, "odd.ply"); }, ErrorKind::file, "transmission curve");
}

TEST(VplFile, NormalsNeedNotHaveUnitLength) {
    const TemporaryFolder folder;
    write_text(folder / "a.ply", kHeader + "end_header\n0 0 0 0 3 4 1 1 1\n");
    const Vpl vpl = read_vpl_file(folder / "a.ply").vpls.at(0);
    EXPECT_NEAR(vpl.normal.y, 0.6f, 1e-6f);
    EXPECT_NEAR(vpl.normal.z, 0.8f, 1e-6f);
    EXPECT_EQ(vpl.shading, pack_direction({0, 0.6f, 0.8f}));
    // The reciprocal of this length is infinite.
    write_text(folder / "a.ply", kHeader + "end_header\n0 0 0 0 0 1e-40 1 1 1\n");
    const Vec3 normal = read_vpl_file(folder / "a.ply").vpls.at(0).normal;
    EXPECT_EQ(normal.x, 0.0f);
    EXPECT_EQ(normal.z, 1.0f);
}

}  // namespace
}  // namespace nearlight::core
