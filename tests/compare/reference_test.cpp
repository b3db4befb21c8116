// SPDX-License-Identifier: Apache-2.0
#include "host/compare/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "host/base/hash.h"
#include "host/compare/pictures.h"
#include "host/image/image_io.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using test::error_of;
using test::mentions;

ReferenceSpec small_spec(std::optional<Method> sampler = {}) {
    return {.sampler = sampler,
            .scene_name = "room",
            .scene_hash = 0x1234,
            .width = 2,
            .height = 1,
            .clamp_radius = 0.25f,
            .max_depth = 6,
            .pixel_centers = true};
}

Image pass_of(float value, float variance) {
    Image pass = make_image(2, 1, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
    for (std::size_t i = 0; i < pass.values.size(); ++i) {
        pass.values[i] = i % 6 < 3 ? value : variance;
    }
    return pass;
}

/// Makes passes and counts them.
struct FakeMaker {
    std::vector<std::size_t> made;
    std::size_t stop_at = 1000;

    PassMaker maker() {
        return [this](std::size_t index, std::size_t samples) -> std::optional<Image> {
            if (index == stop_at) {
                return std::nullopt;
            }
            made.push_back(samples);
            return pass_of(static_cast<float>(index), 1.0f);
        };
    }
};

TEST(Reference, IsMadeOfPassesWeightedBySamples) {
    const TemporaryFolder folder;
    FakeMaker fake;
    const auto reference = make_reference(small_spec(), 320, ReferenceStore(folder.path()), fake.maker());
    ASSERT_TRUE(reference);
    EXPECT_EQ(fake.made, (std::vector<std::size_t>{256, 64}));
    EXPECT_NEAR(reference->picture.values[0], 0.2, 1e-6);
    EXPECT_TRUE(reference->noise.known);
    EXPECT_NEAR(reference->noise.mean_variance, 0.8 * 0.8 + 0.2 * 0.2, 1e-6);
    EXPECT_NEAR(reference->noise.mean_relative_variance, 0.68 / (0.04 + 0.01), 1e-4);
    EXPECT_EQ(reference->samples, 320u);
}

TEST(Reference, PassesAreWholeBatches) {
    using Sizes = std::vector<std::size_t>;
    EXPECT_EQ(pass_sizes(small_spec(), 8), (Sizes{16}));
    EXPECT_EQ(pass_sizes(small_spec(), 512), (Sizes{256, 256}));
    EXPECT_EQ(pass_sizes(small_spec(), 257), (Sizes{256, 16}));
    EXPECT_EQ(pass_sizes(small_spec(parse_method("instant-radiosity")), 800), Sizes(8, 100));
}

TEST(Reference, GoesOnFromWhatIsStored) {
    const TemporaryFolder folder;
    const ReferenceStore store(folder / "references");
    FakeMaker stopped{.made = {}, .stop_at = 1};
    EXPECT_FALSE(make_reference(small_spec(), 512, store, stopped.maker()));
    EXPECT_EQ(stopped.made.size(), 1u);
    FakeMaker rest;
    const auto resumed = make_reference(small_spec(), 512, store, rest.maker());
    EXPECT_EQ(rest.made.size(), 1u);
    FakeMaker longer;
    make_reference(small_spec(), 768, store, longer.maker());
    EXPECT_EQ(longer.made.size(), 1u);
    FakeMaker none;
    const auto again = make_reference(small_spec(), 512, store, none.maker());
    EXPECT_TRUE(none.made.empty());
    EXPECT_EQ(again->seconds, 0.0);
    EXPECT_EQ(identity(*again), identity(*resumed));
    FakeMaker other;
    ReferenceSpec changed = small_spec();
    changed.clamp_radius = 0.26f;
    make_reference(changed, 512, store, other.maker());
    EXPECT_EQ(other.made.size(), 2u);
}

TEST(Reference, ABrokenPassIsMadeAnew) {
    const TemporaryFolder folder;
    const ReferenceStore store(folder.path());
    FakeMaker first;
    make_reference(small_spec(), 256, store, first.maker());
    std::ofstream(store.file(small_spec(), 0, 256)) << "this is no picture";
    FakeMaker second;
    EXPECT_TRUE(make_reference(small_spec(), 256, store, second.maker()));
    EXPECT_EQ(second.made.size(), 1u);
}

TEST(Reference, OfVplsLearnsItsNoiseFromItsPasses) {
    const TemporaryFolder folder;
    std::size_t count = 0;
    const auto reference =
        make_reference(small_spec(parse_method("instant-radiosity")), 200'000, ReferenceStore(folder.path()),
                       [&](std::size_t index, std::size_t samples) -> std::optional<Image> {
                           EXPECT_EQ(samples, 25'000u);
                           ++count;
                           Image pass = make_picture(2, 1);
                           std::fill(pass.values.begin(), pass.values.end(), index % 2 == 0 ? 1.0f : 3.0f);
                           return pass;
                       });
    EXPECT_EQ(count, 8u);
    EXPECT_NEAR(reference->picture.values[3], 2.0, 1e-6);
    EXPECT_NEAR(reference->noise.mean_variance, 1.0 / 7.0,
                1e-6);  // sample variance 8/7, divided by 8 for the mean
}

TEST(Reference, WithInfiniteVarianceHasUnknownNoise) {
    const TemporaryFolder folder;
    const auto reference = make_reference(small_spec(), 4, ReferenceStore(folder.path()),
                                          [](std::size_t, std::size_t) { return pass_of(1.0f, INFINITY); });
    EXPECT_FALSE(reference->noise.known);
    EXPECT_EQ(reference->noise.mean_variance, 0.0);
}

/// Writes a file like those of `nearlight reference`.
class ReferenceFile : public testing::Test {
  protected:
    void write(const Metadata& changes = {}, int width = 2) {
        Metadata metadata{{"nearlight:sceneHash", hex_digits(0x1234)},
                          {"nearlight:clampRadius", 0.25f},
                          {"nearlight:maxDepth", 6},
                          {"nearlight:samplesPerPixel", 64},
                          {"nearlight:pixelCenters", 1},
                          {"nearlight:complete", 1}};
        for (const auto& [name, value] : changes) {
            metadata[name] = value;
        }
        Image image = make_image(width, 1,
                                 {"indirect.R", "indirect.G", "indirect.B", "indirectVariance.R",
                                  "indirectVariance.G", "indirectVariance.B"});
        for (std::size_t i = 0; i < image.values.size(); ++i) {
            image.values[i] = i % 6 < 3 ? 0.5f : 0.01f;
        }
        write_image(file_, image, {.metadata = metadata});
    }
    void expect_refused(const std::string& because) {
        const Error error = error_of([&] { load_reference(file_, small_spec()); });
        EXPECT_EQ(error.kind(), ErrorKind::file);
        EXPECT_TRUE(mentions(error, because));
        EXPECT_TRUE(mentions(error, file_.string()));
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "truth.exr";
};

TEST_F(ReferenceFile, IsTakenWhereItFits) {
    write();
    const Reference reference = load_reference(file_, small_spec());
    EXPECT_EQ(reference.picture.at(1, 0, 2), 0.5f);
    EXPECT_NEAR(reference.noise.mean_variance, 0.01, 1e-8);
    EXPECT_EQ(reference.samples, 64u);
    EXPECT_EQ(reference.file, file_.string());
}
TEST_F(ReferenceFile, OfAnotherSizeIsRefused) {
    write({}, 3);
    expect_refused("3x1");
}
TEST_F(ReferenceFile, OfAnotherSceneIsRefused) {
    write({{"nearlight:sceneHash", hex_digits(0x1235)}});
    expect_refused("another scene");
}
TEST_F(ReferenceFile, OfAnotherClampRadiusIsRefused) {
    write({{"nearlight:clampRadius", 0.2501f}});
    expect_refused("clamp radius");
}
TEST_F(ReferenceFile, OfAnotherDepthIsRefused) {
    write({{"nearlight:maxDepth", 0}});
    expect_refused("depth");
}
TEST_F(ReferenceFile, OfUnknownOriginIsRefused) {
    write_image(file_, make_picture(2, 1));
    expect_refused("nearlight:sceneHash");
    EXPECT_EQ(error_of([&] { load_reference(folder_ / "nowhere.exr", small_spec()); }).kind(),
              ErrorKind::file);
}

}  // namespace
}  // namespace nearlight::core
