// SPDX-License-Identifier: Apache-2.0
// Renders pictures with the help of other sessions, to which the bytes of messages go as they do to other
// processes.
#include "host/session/remote_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <tuple>

#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

/// Two quads and a lamp, 160 × 160 pixels.
Scene lit_corner() {
    Scene scene;
    Material lamp = small_scenes::lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    const uint gray = small_scenes::add_material(scene, small_scenes::lambertian({0.6f, 0.6f, 0.6f}));
    small_scenes::add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, gray);
    small_scenes::add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, gray);
    small_scenes::add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f},
                           small_scenes::add_material(scene, lamp));
    small_scenes::set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, 70);
    scene.camera.width = 160;
    scene.camera.height = 160;
    scene.camera.filter = default_filter(FilterKind::tent);  // samples count in neighbouring bands, too
    return scene;
}

/// A session that stands for other processes. All of its devices are the same one, and its bands are made
/// when they are fetched.
class OtherSession {
  public:
    OtherSession(Device& device, const Scene& scene) : session_(device, scene) {}

    /// The number of bands that are made before device 0 fails.
    uint good_bands = 1000;
    /// No band is made before the picture after it was shown too, up to this picture.
    PictureNumber awaited = 0;
    /// Memory for the message that a picture has ended is lacking.
    bool fails_to_end = false;

    [[nodiscard]] RemoteDevices devices(std::size_t count) {
        RemoteDevices remote{
            .devices = {},
            .show = [this](const PictureTask& picture,
                           std::span<const Vpl> vpls) { return show(picture, vpls); },
            .order =
                [this](PictureNumber picture, std::size_t device, uint band) {
                    const std::lock_guard lock(mutex_);
                    EXPECT_TRUE(ordered_.insert({picture, device, band}).second);
                },
            .fetch = [this](PictureNumber picture, std::size_t device, uint band,
                            const WorkProgress& progress) { return fetch(picture, device, band, progress); },
            .end =
                [this](PictureNumber picture) {
                    EXPECT_EQ(pictures_.erase(picture), 1u);
                    if (fails_to_end) {
                        throw std::bad_alloc();
                    }
                }};
        for (std::size_t i = 0; i < count; ++i) {
            remote.devices.push_back(session_.own_devices().front());
            remote.devices.back().number = i;
            remote.devices.back().name += " of rank " + std::to_string(i + 1);
        }
        return remote;
    }
    [[nodiscard]] std::size_t open_pictures() const { return pictures_.size(); }
    [[nodiscard]] PictureNumber shown() const { return shown_; }
    [[nodiscard]] std::size_t early_bands() const { return early_bands_; }

  private:
    struct Shown {
        PictureTask picture;
        VplBuffer vpls;
        BandMaker make{};
    };

    PictureNumber show(const PictureTask& picture, std::span<const Vpl> vpls) {
        const std::lock_guard lock(mutex_);
        auto shown = std::make_unique<Shown>(Shown{{}, VplBuffer(std::vector(vpls.begin(), vpls.end()))});
        std::memcpy(static_cast<void*>(&shown->picture), &picture, sizeof(PictureTask));
        pictures_[++shown_] = std::move(shown);
        changed_.notify_all();
        return shown_;
    }
    std::optional<FinishedBand> fetch(PictureNumber picture, std::size_t device, uint band,
                                      const WorkProgress& progress) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return shown_ >= std::min(picture + 1, awaited); });
        if (device == 0 && good_bands-- == 0) {
            throw Error(ErrorKind::failure, "the cable was pulled");
        }
        early_bands_ += ordered_.erase({picture, device, band});
        Shown& shown = *pictures_.at(picture);
        if (!shown.make) {
            shown.make = session_.helper(0, shown.picture, shown.vpls);
        }
        return shown.make(band, progress);
    }

    Session session_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<PictureNumber, std::unique_ptr<Shown>> pictures_;
    std::set<std::tuple<PictureNumber, std::size_t, uint>> ordered_;
    PictureNumber shown_ = 0;
    std::size_t early_bands_ = 0;
};

/// A session alone, and one that is helped by remote devices, of which there are `count`.
struct HelpedSession {
    std::unique_ptr<Device> own;
    std::unique_ptr<Device> other;
    OtherSession helper;
    Session alone;
    Session helped;

    HelpedSession(std::unique_ptr<Device> a, std::unique_ptr<Device> b, const Scene& scene, std::size_t count)
        : own(std::move(a)),
          other(std::move(b)),
          helper(*other, scene),
          alone(*own, scene),
          helped(*own, scene) {
        helped.enlist(helper.devices(count));
    }
};

class RemoteDevicesTest : public test::DeviceTest {
  protected:
    /// The entry of the first device, which each session opens for itself.
    [[nodiscard]] std::unique_ptr<Device> open() {
        return std::make_unique<Device>(devices().front()->entry(),
                                        DeviceOptions{.kernel_dir = {}, .cache_dir = test::test_cache_dir()});
    }
    const Scene scene_ = lit_corner();
};

void expect_equal(const test::Rendering& alone, const test::Rendering& helped) {
    EXPECT_EQ(helped.report.image_hash, alone.report.image_hash);
    EXPECT_EQ(helped.image.values, alone.image.values) << "in a layer other than the beauty";
    EXPECT_EQ(helped.report.totals.local_lights, alone.report.totals.local_lights);
    EXPECT_EQ(helped.report.passes, alone.report.passes);
}

std::vector<RenderSettings> kinds_of_pictures() {
    std::vector<RenderSettings> kinds{test::few_vpls(), test::few_vpls(SamplerKind::local), test::few_vpls(),
                                      test::few_vpls(), test::few_vpls()};
    kinds[2].sampling.cuts = true;
    kinds[3].gather.window = PixelWindow{10, 20, 100, 90};
    kinds[4].passes = 3;
    return kinds;
}

TEST_F(RemoteDevicesTest, GiveTheBitsOfOneProcess) {
    HelpedSession sessions(open(), open(), scene_, 3);
    auto& [own, other, helper, alone, helped] = sessions;
    for (const RenderSettings& settings : kinds_of_pictures()) {
        const test::Rendering picture = test::render_image(helped, settings);
        expect_equal(test::render_image(alone, settings), picture);
        EXPECT_EQ(picture.report.shares.size(), 4u);
    }
    EXPECT_EQ(helper.shown(), 7u);
    EXPECT_EQ(helper.open_pictures(), 0u);
}

TEST_F(RemoteDevicesTest, BeginThePassAfterThePresentOne) {
    HelpedSession sessions(open(), open(), scene_, 2);
    auto& [own, other, helper, alone, helped] = sessions;
    RenderSettings settings = test::few_vpls();
    settings.pass_samples = {2, 4, 2, 1, 2, 2};
    helper.awaited = 6;
    expect_equal(test::render_image(alone, settings), test::render_image(helped, settings));
    EXPECT_GT(helper.early_bands(), 0u);
    EXPECT_EQ(helper.open_pictures(), 0u);
}

TEST_F(RemoteDevicesTest, AreLeftOutWhenTheyFail) {
    for (const uint good_bands : {0u, 2u}) {
        HelpedSession sessions(open(), open(), scene_, 2);
        auto& [own, other, helper, alone, helped] = sessions;
        helper.good_bands = good_bands;
        RenderSettings settings = test::few_vpls();
        settings.passes = 3;
        const test::Rendering picture = test::render_image(helped, settings);
        expect_equal(test::render_image(alone, settings), picture);
        EXPECT_TRUE(picture.report.shares.at(1).failed);
        EXPECT_LE(picture.report.shares.at(1).bands, good_bands);
        EXPECT_FALSE(picture.report.shares.at(2).failed);
    }
}

TEST_F(RemoteDevicesTest, NeedNotHearOfTheEnd) {
    HelpedSession sessions(open(), open(), scene_, 1);
    auto& [own, other, helper, alone, helped] = sessions;
    helper.fails_to_end = true;
    expect_equal(test::render_image(alone, test::few_vpls()), test::render_image(helped, test::few_vpls()));
    EXPECT_EQ(helper.open_pictures(), 0u);
}

TEST_F(RemoteDevicesTest, StopWhenTheCallerWantsNoMore) {
    HelpedSession sessions(open(), open(), scene_, 2);
    auto& [own, other, helper, alone, helped] = sessions;
    RenderSettings settings = test::few_vpls();
    settings.passes = 4;
    const test::Rendering picture =
        test::render_image(helped, settings, {.progress = [](double fraction) { return fraction < 0.4; }});
    EXPECT_TRUE(picture.report.interrupted);
    EXPECT_EQ(helper.open_pictures(), 0u);
}

}  // namespace
}  // namespace nearlight::core
