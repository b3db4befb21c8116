// SPDX-License-Identifier: Apache-2.0
#include "host/cli/picture_keeper.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

using Moment = PassesSoFar::Moment;

/// A picture of one pixel, and what a keeper does about it.
struct Kept {
    explicit Kept(const std::filesystem::path& checkpoint, std::optional<double> seconds = 0.0)
        : keeper(checkpoint, seconds,
                 {.facts = [](const PassesSoFar&) { return CheckpointFacts(); },
                  .write_picture = [this](const PassesSoFar&) { ++pictures; },
                  .warn = [this](const std::string& why) { warnings.push_back(why); }}) {
        average.begin_pass(4);
        average.add_rows(std::vector<float>(NEARLIGHT_LAYER_CHANNELS, 1.0f));
    }

    void watch(Moment moment) {
        keeper.watch({.moment = moment, .report = report, .view = view, .average = average, .record = [this] {
                          return PassRecord{.whole = {{.seed = 3, .first = 2, .samples = samples}},
                                            .choice = PassChoice{}};
                      }});
    }

    RenderReport report;
    View view;
    PassAverage average{1, 1};
    std::vector<uint> samples{4};  ///< of whole passes
    int pictures = 0;
    std::vector<std::string> warnings;
    PictureKeeper keeper;
};

TEST(PictureKeeper, WritesThePictureBetweenPassesAndTheSumsAtAnyTime) {
    const TemporaryFolder folder;
    Kept kept(folder / "sums");
    kept.watch(Moment::within_pass);
    EXPECT_EQ(kept.pictures, 0);
    const CheckpointReader reader(folder / "sums");
    EXPECT_EQ(reader.record().whole.front().seed, 3u);
    EXPECT_EQ(reader.record().whole.front().first, 2u);
    const PassSums sums = reader.read_sums();
    EXPECT_TRUE(std::ranges::equal(sums.sums(), kept.average.sums().sums()));
    EXPECT_TRUE(std::ranges::equal(sums.firsts(), kept.average.sums().firsts()));
    EXPECT_EQ(sums.row(0).samples, 4u);
    std::filesystem::remove(folder / "sums");
    kept.watch(Moment::between_passes);
    EXPECT_EQ(kept.pictures, 1);
    EXPECT_EQ(folder.file_count(), 1u);
    kept.keeper.check();
}

TEST(PictureKeeper, WritesLittleWhenNobodySaysHowOften) {
    const TemporaryFolder folder;
    Kept kept(folder / "sums", std::nullopt);
    for (int i = 0; i < 1000; ++i) {
        kept.watch(Moment::within_pass);
        kept.watch(Moment::between_passes);
    }
    EXPECT_EQ(kept.pictures, 0);
    EXPECT_EQ(folder.file_count(), 0u);
    kept.watch(Moment::end);
    EXPECT_EQ(kept.pictures, 0) << "the picture of the end is written elsewhere";
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(PictureKeeper, WritesNoSumsBeforeTheFirstRow) {
    const TemporaryFolder folder;
    Kept kept(folder / "sums");
    kept.samples.clear();
    kept.watch(Moment::end);
    EXPECT_FALSE(kept.keeper.has_checkpoint());
    EXPECT_EQ(folder.file_count(), 0u);
    kept.samples = {4};
    kept.watch(Moment::end);
    EXPECT_TRUE(kept.keeper.has_checkpoint());
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(PictureKeeper, AFolderThatIsGoneIsToldOnceAndNotForgotten) {
    const TemporaryFolder folder;
    const std::filesystem::path inner = folder / "inner";
    Kept kept(inner / "sums");
    kept.watch(Moment::within_pass);
    kept.watch(Moment::between_passes);
    EXPECT_EQ(kept.warnings.size(), 1u);
    EXPECT_EQ(kept.pictures, 1) << "the picture does not suffer from it";
    EXPECT_THROW(kept.keeper.check(), Error);
    std::filesystem::create_directories(inner);
    kept.watch(Moment::end);
    kept.keeper.check();
    EXPECT_EQ(CheckpointReader(inner / "sums").width(), 1u);
}

TEST(WritingPace, KeepsToSecondsOrToAShareOfTheTime) {
    EXPECT_FALSE(WritingPace(std::nullopt, 1.0).is_time(0.0)) << "at least 5 s";
    EXPECT_TRUE(WritingPace(0.0, 0.0).is_time(1e9)) << "who names seconds decides about the share";
    EXPECT_FALSE(WritingPace(1e9, 1.0).is_time(0.0));
}

}  // namespace
}  // namespace nearlight::core
