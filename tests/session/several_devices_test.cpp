// SPDX-License-Identifier: Apache-2.0
// Renders one picture on several devices of one type: two of PoCL (POCL_DEVICES, see CMakeLists.txt), or
// parts of one.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numeric>

#include "host/cl/kernel_source.h"
#include "tests/image/temporary_folder.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// A floor and a lamp over it, 200 × 200 pixels: 25 rows of tiles.
Scene lit_floor() {
    Scene scene;
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    const uint gray = add_material(scene, lambertian({0.6f, 0.6f, 0.6f}));
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, gray);
    add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, gray);
    add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, 70);
    scene.camera.width = 200;
    scene.camera.height = 200;
    return scene;
}

uint bands_of(const RenderReport& report) {
    return std::accumulate(report.shares.begin(), report.shares.end(), 0u,
                           [](uint sum, const BandShare& share) { return sum + share.bands; });
}

/// Devices of the driver's first type, or parts of its first device.
class SeveralDevices : public test::DeviceTest {
  protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        const DeviceEntry& first = devices().front()->entry();
        for (const DeviceEntry& entry : list_devices().devices) {
            if (entry.name == first.name && entry.driver == first.driver) {
                open(entry);
            }
        }
        if (opened_.size() < 2) {
            GTEST_SKIP() << "the driver has one device of this type";
        }
    }
    Device& open(const DeviceEntry& entry, const std::filesystem::path& kernel_dir = {}) {
        const DeviceOptions options{.kernel_dir = kernel_dir, .cache_dir = test::test_cache_dir()};
        return *opened_.emplace_back(std::make_unique<Device>(entry, options));
    }
    [[nodiscard]] Device& device(std::size_t index) const { return *opened_.at(index); }
    /// A folder with the program's kernels for bands, in which the gather does not compile.
    static void write_kernels_without_gather(const std::filesystem::path& folder) {
        std::filesystem::create_directory(folder / "joint");
        for (const char* name : {"camera_pass.cl", "receiver_paths.cl", "film.cl", "joint/view.cl",
                                 "shared_lights.cl", "shared_light_packets.cl", "shared_light_rays.cl",
                                 "shared_reflections.cl", "shared_sky.cl", "shared_veiled.cl"}) {
            std::ofstream(folder / name) << expand_kernel_source(name);
        }
        for (const char* name : {"gather_packets.cl", "gather_rays.cl"}) {
            std::ofstream(folder / name) << "kernel void gather( {\n";
        }
    }

  private:
    std::vector<std::unique_ptr<Device>> opened_;
};

test::Rendering render_on(std::vector<Device*> devices, const RenderSettings& settings) {
    const Scene scene = lit_floor();
    Session session(devices, scene);
    return test::render_image(session, settings);
}

/// A picture of which each of two devices has made a part. On a busy machine one of them may be done before
/// the other begins, so it is made again then, but not for ever.
test::Rendering render_on_both(Device* first, Device* second, const RenderSettings& settings) {
    constexpr int kMaxPictures = 20;
    for (int picture = 1;; ++picture) {
        test::Rendering both = render_on({first, second}, settings);
        const auto& shares = both.report.shares;
        if (picture == kMaxPictures ||
            std::ranges::all_of(shares, [](const auto& s) { return s.bands > 0; })) {
            return both;
        }
    }
}

TEST_F(SeveralDevices, GiveTheBitsOfOne) {
    for (const SamplerKind sampler : {SamplerKind::close_range, SamplerKind::local}) {
        const test::Rendering one = render_on({&device(0)}, test::few_vpls(sampler));
        const test::Rendering two = render_on_both(&device(0), &device(1), test::few_vpls(sampler));
        EXPECT_EQ(two.report.image_hash, one.report.image_hash) << to_string(sampler);
        EXPECT_EQ(two.image.values, one.image.values) << "in a layer other than the beauty";
        EXPECT_EQ(two.report.totals.local_lights, one.report.totals.local_lights);
        EXPECT_EQ(one.report.shares.size(), 1u);
        ASSERT_EQ(two.report.shares.size(), 2u);
        EXPECT_GT(two.report.shares[0].bands, 0u);
        EXPECT_GT(two.report.shares[1].bands, 0u);
    }
}

TEST_F(SeveralDevices, PartsOfOneGiveItsBitsToo) {
    const DeviceEntry& whole = device(0).entry();
    if (whole.max_parts < 2) {
        GTEST_SKIP() << "the device has one compute unit";
    }
    const test::Rendering one = render_on({&device(0)}, test::few_vpls());
    std::vector<Device*> parts;
    for (const DeviceEntry& entry : choose_devices(list_devices(), std::to_string(whole.index) + "/2")) {
        EXPECT_EQ(entry.compute_units, whole.compute_units / 2);
        parts.push_back(&open(entry));
    }
    ASSERT_EQ(parts.size(), 2u);
    const test::Rendering two = render_on(parts, test::few_vpls());
    EXPECT_EQ(two.report.image_hash, one.report.image_hash);
    EXPECT_EQ(bands_of(two.report), 13u) << "two rows of tiles a band, for bundles of 2 × 2 tiles";
}

TEST_F(SeveralDevices, TheOthersFinishForOneThatFails) {
    const TemporaryFolder folder;
    write_kernels_without_gather(folder.path());
    // The device fails in its first band at the gather. It is not the one that makes the VPLs, so they are
    // made.
    Device& broken = open(device(1).entry(), folder.path());
    const test::Rendering alone = render_on({&device(0)}, test::few_vpls());
    const test::Rendering with_broken = render_on({&device(0), &broken}, test::few_vpls());
    EXPECT_EQ(with_broken.report.image_hash, alone.report.image_hash);
    EXPECT_TRUE(with_broken.report.shares.at(1).failed);
    EXPECT_EQ(with_broken.report.shares.at(1).bands, 0u);
    EXPECT_EQ(with_broken.report.shares.at(0).bands, bands_of(with_broken.report));
}

TEST_F(SeveralDevices, AreHealthyWhereVplsCannotBeSaved) {
    const TemporaryFolder folder;
    const Scene scene = lit_floor();
    const RenderSettings settings = test::few_vpls(SamplerKind::local);
    Session session(std::vector{&device(0), &device(1)}, scene);
    const View view = session.look(settings.view, settings.seed);
    const VplSet vpls = session.sample(view, settings.sampling, settings.seed);
    EXPECT_EQ(test::error_of([&] { session.save_vpls(view, vpls, folder / "vpls.ply"); }).kind(),
              ErrorKind::invalid_argument);
    EXPECT_EQ(test::render_image(session, test::few_vpls()).report.shares.size(), 2u);
}

TEST_F(SeveralDevices, AFailedOneIsLeftOutOfLaterPictures) {
    const TemporaryFolder folder;
    write_kernels_without_gather(folder.path());
    Device& broken = open(device(1).entry(), folder.path());
    const Scene scene = lit_floor();
    Session session(std::vector{&device(0), &broken}, scene);
    EXPECT_EQ(test::render_image(session, test::few_vpls()).report.shares.size(), 2u);
    EXPECT_EQ(test::render_image(session, test::few_vpls()).report.shares.size(), 1u);
}

TEST_F(SeveralDevices, AnotherLeadsWhereTheFirstHasNoRoomForTheScene) {
    DeviceEntry entry = device(0).entry();
    entry.max_allocation_bytes = 64;
    Device& tiny = open(entry);
    const test::Rendering alone = render_on({&device(1)}, test::few_vpls());
    const test::Rendering both = render_on({&tiny, &device(1)}, test::few_vpls());
    EXPECT_EQ(both.report.image_hash, alone.report.image_hash);
    EXPECT_EQ(both.report.shares.size(), 1u);
}

/// A camera that cannot be placed is the caller's fault.
TEST_F(SeveralDevices, AllStayWhereTheCallerIsWrong) {
    const Scene scene = lit_floor();
    Session session(std::vector{&device(0), &device(1)}, scene);
    SceneCamera camera = scene.camera;
    camera.fov_x_degrees = 0;
    EXPECT_EQ(test::error_of([&] { session.look(camera, {.width = 8, .height = 8}, 1); }).kind(),
              ErrorKind::invalid_argument);
    EXPECT_EQ(test::render_image(session, test::few_vpls()).report.shares.size(), 2u);
}

TEST_F(SeveralDevices, WhenAllFailItIsAnError) {
    DeviceEntry entry = device(0).entry();
    entry.max_allocation_bytes = 64;
    Device& tiny = open(entry);
    Device& tiny_too = open(entry);
    EXPECT_EQ(test::error_of([&] {
                  render_on({&tiny, &tiny_too}, test::few_vpls());
              }).kind(),
              ErrorKind::out_of_memory);
}

TEST_F(SeveralDevices, StopWhenTheCallerWantsNoMore) {
    const Scene scene = lit_floor();
    Session session(std::vector{&device(0), &device(1)}, scene);
    std::size_t rows = 0;
    RenderHooks hooks{.progress = [](double fraction) { return fraction < 0.3; }};
    hooks.rows = [&](std::span<const float> finished) {
        rows += finished.size() / (200 * NEARLIGHT_LAYER_CHANNELS);
    };
    const RenderReport report = render(session, test::few_vpls(), hooks);
    EXPECT_TRUE(report.interrupted);
    EXPECT_LT(rows, 200u);
}

}  // namespace
}  // namespace nearlight::core
