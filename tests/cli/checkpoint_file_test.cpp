// SPDX-License-Identifier: Apache-2.0
#include "host/cli/checkpoint_file.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

PassRange passes_of(uint seed, std::vector<uint> samples = {}) {
    return {.seed = seed, .first = 2, .samples = std::move(samples)};
}

struct Contents {
    Contents() {
        facts.version = "1";
        facts.settings = {{"--vpls", 7}};
        facts.maker = {{"--bvh", "fast"}};
    }

    CheckpointFacts facts;
    PassRecord record{.whole = {passes_of(3, {4, 1})}, .choice = PassChoice{}};
};

/// Why a file with these contents is not read; empty if it is.
std::string refusal_of(const Contents& contents) {
    const TemporaryFolder folder;
    write_checkpoint(folder / "sums", contents.facts, contents.record, PassSums(3, 2));
    try {
        static_cast<void>(CheckpointReader(folder / "sums").read_sums());
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::file);
        return error.what();
    }
    return "";
}

void expect_damaged(const Contents& contents) {
    EXPECT_NE(refusal_of(contents).find("it is damaged or incomplete"), std::string::npos)
        << refusal_of(contents);
}

TEST(CheckpointFile, GivesBackItsFactsAndItsRecord) {
    const TemporaryFolder folder;
    const Contents contents;
    write_checkpoint(folder / "sums", contents.facts, contents.record, PassSums(3, 2));
    const CheckpointReader reader(folder / "sums");
    EXPECT_EQ(reader.facts().settings, contents.facts.settings);
    EXPECT_EQ(reader.facts().maker, contents.facts.maker);
    EXPECT_EQ(reader.record().whole.front().samples, contents.record.whole.front().samples);
    EXPECT_EQ(reader.record().choice, contents.record.choice);
    EXPECT_EQ(reader.read_sums().row(1).samples, 5u);
}

TEST(CheckpointFile, OfABegunFirstPassHasNoChoiceYet) {
    Contents begun;
    begun.record = {.whole = {passes_of(3)}, .begun_samples = 4, .begun_rows = 1};
    EXPECT_EQ(refusal_of(begun), "");
    begun.record.begun_rows = 2;
    expect_damaged(begun);
    begun.record.begun_rows = 0;
    expect_damaged(begun);
}

TEST(CheckpointFile, ThatContradictsItselfIsDamaged) {
    Contents contents;
    contents.record.choice.reset();
    expect_damaged(contents);
    contents = {};
    contents.record.whole.push_back(passes_of(4));
    expect_damaged(contents);
    contents.record = {.whole = {passes_of(3), passes_of(4)}};
    expect_damaged(contents);
    contents = {};
    contents.record.whole.clear();
    expect_damaged(contents);
}

TEST(CheckpointFile, WithNumbersThatSettingsCannotHaveIsDamaged) {
    for (float RayBudget::*number : {&RayBudget::clamp_radius, &RayBudget::shared_limit}) {
        Contents contents;
        contents.record.choice->ray_budget.*number = -1.0f;
        expect_damaged(contents);
    }
    Contents contents;
    contents.record.choice->range = -1.0f;
    expect_damaged(contents);
    contents = {};
    contents.record.choice->ray_budget.direct_samples_per_pixel = 2'000'000;
    expect_damaged(contents);
    contents.record = {.whole = {passes_of(3)}, .begun_samples = 100'000, .begun_rows = 1};
    expect_damaged(contents);
}

TEST(CheckpointFile, WithListsInPlaceOfNamedFactsIsDamaged) {
    for (auto CheckpointFacts::*facts : {&CheckpointFacts::settings, &CheckpointFacts::maker}) {
        for (const char* text : {"[]", "[1, 2]", "null", "7"}) {
            Contents contents;
            contents.facts.*facts = nlohmann::ordered_json::parse(text);
            expect_damaged(contents);
        }
    }
}

}  // namespace
}  // namespace nearlight::core
