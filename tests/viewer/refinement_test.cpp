// SPDX-License-Identifier: Apache-2.0
#include "viewer/refinement.h"

#include <gtest/gtest.h>

namespace nearlight::viewer {
namespace {

constexpr double kFast = 0.1;  ///< seconds of a step that changes no divisor

/// Ends the next step and returns its kind.
StepKind make(Refinement& refinement, double seconds = kFast) {
    const std::optional<Step> step = refinement.next();
    EXPECT_TRUE(step);
    refinement.finish(*step, true, seconds);
    return step->kind;
}

TEST(Refinement, GoesFromSmallToWholeToFine) {
    Refinement refinement(3);
    EXPECT_EQ(make(refinement), StepKind::reduced);
    EXPECT_EQ(make(refinement), StepKind::full);
    EXPECT_EQ(refinement.next()->pass, 1u);
    EXPECT_EQ(make(refinement), StepKind::refining);
    EXPECT_EQ(make(refinement), StepKind::refining);
    EXPECT_FALSE(refinement.next());
}

TEST(Refinement, BeginsAnewAfterAChange) {
    Refinement refinement(3);
    make(refinement), make(refinement), make(refinement);
    refinement.restart();
    EXPECT_EQ(make(refinement), StepKind::reduced);
    EXPECT_EQ(make(refinement), StepKind::full);
    EXPECT_EQ(refinement.next()->pass, 1u);
}

TEST(Refinement, MakesSmallPicturesAsLongAsItMoves) {
    Refinement refinement(3);
    for (int i = 0; i < 5; ++i) {
        const Step step = *refinement.next();
        EXPECT_EQ(step.kind, StepKind::reduced);
        refinement.restart();
        EXPECT_FALSE(refinement.is_outdated(step)) << "small pictures are shown during the motion";
        refinement.finish(step, true, kFast);
    }
    EXPECT_EQ(make(refinement), StepKind::reduced);
    EXPECT_EQ(make(refinement), StepKind::full);
}

TEST(Refinement, ChangesStopWholePictures) {
    Refinement refinement(3);
    make(refinement);
    const Step full = *refinement.next();
    EXPECT_FALSE(refinement.is_outdated(full));
    refinement.restart();
    EXPECT_TRUE(refinement.is_outdated(full));
    refinement.finish(full, false, kFast);
    EXPECT_EQ(make(refinement), StepKind::reduced);
}

/// A step may end just when something changes; its result then counts for nothing.
TEST(Refinement, FinishedStepsOfAnOldStateDoNotCount) {
    Refinement refinement(3);
    make(refinement);
    const Step full = *refinement.next();
    refinement.restart();
    refinement.finish(full, true, kFast);
    EXPECT_EQ(refinement.next()->kind, StepKind::reduced);
}

TEST(Refinement, AStoppedStepIsMadeAgain) {
    Refinement refinement(3);
    make(refinement);
    refinement.finish(*refinement.next(), false, kFast);
    EXPECT_EQ(refinement.next()->kind, StepKind::full);
}

TEST(Refinement, MorePassesGoOn) {
    Refinement refinement(2);
    make(refinement), make(refinement), make(refinement);
    EXPECT_FALSE(refinement.next());
    refinement.set_max_passes(5);
    EXPECT_EQ(refinement.next()->pass, 2u);
    refinement.set_max_passes(1);
    EXPECT_FALSE(refinement.next());
}

/// A step that fails is not tried again and again.
TEST(Refinement, RestsAfterAFailureUntilSomethingChanges) {
    Refinement refinement(3);
    refinement.give_up(*refinement.next());
    EXPECT_FALSE(refinement.next());
    refinement.set_max_passes(5);
    EXPECT_FALSE(refinement.next());
    refinement.restart();
    EXPECT_EQ(make(refinement), StepKind::reduced);
    EXPECT_EQ(make(refinement), StepKind::full);
}

/// What fails after something has changed says nothing about the new state.
TEST(Refinement, FailuresOfAnOldStateDoNotCount) {
    Refinement refinement(3);
    make(refinement);
    const Step full = *refinement.next();
    refinement.restart();
    refinement.give_up(full);
    EXPECT_EQ(make(refinement), StepKind::reduced);
}

TEST(Refinement, SmallPicturesAdaptToTheirTime) {
    Refinement refinement(2);
    EXPECT_EQ(refinement.next()->divisor, 2);
    for (int i = 0; i < 5; ++i) {
        refinement.restart();
        make(refinement, 1.0);
    }
    refinement.restart();
    EXPECT_EQ(refinement.next()->divisor, 8);
    for (int i = 0; i < 5; ++i) {
        refinement.restart();
        make(refinement, 0.01);
    }
    refinement.restart();
    EXPECT_EQ(refinement.next()->divisor, 2);
}

}  // namespace
}  // namespace nearlight::viewer
