// SPDX-License-Identifier: Apache-2.0
// Markov chains over light walks, which all take their steps together.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"
#include "host/stages/morton_sort.h"
#include "host/stages/pilot_view.h"
#include "host/stages/vpl_contribution.h"
#include "kernels/shared/walk_aim.h"

namespace nearlight::core {

/// How many pairs of numbers lead a walk of so many bounces.
uint walk_pair_count(uint bounce_count);

/// States of chains or their seeds: points of the unit cube, and the VPLs that they stand for.
struct PathStates {
    PathStates(Device& device, std::size_t state_count, uint bounce_count);

    uint count;
    uint pair_count;        ///< of each state, walk_pair_count()
    Buffer<float> numbers;  ///< in [0, 1), laid out as kernels/metropolis_chains.cl says
    Buffer<Vpl> vpls;       ///< the power of each VPL by itself is an estimate of all light
    Buffer<float> targets;  ///< the density that chains follow, not normalised
};

/// The space that chains move in and the density that they follow. It must not change while they run, and it
/// must not depend on their seeds.
struct PathSpace {
    const DeviceScene& scene;
    const PilotView& view;
    float clamp_radius = 0.0f;
    float blind_target = 1.0f;  ///< added to the target for each watt (luminance) of a VPL
    uint seed = 0;
    uint bounce_count = 1;
    WalkAim aim{};            ///< of walks from far away
    Buffer<float> depth_cdf;  ///< bounce_count values, the last 1; every depth has a positive probability
};

/// Cumulative probabilities of the depths 1 to bounce_count, in proportion to s^depth, where s is mean_albedo
/// within [kMinSurvival, kMaxSurvival]. No depth has less than 1e-4 of the first one's probability.
Buffer<float> make_depth_cdf(Device& device, uint bounce_count, float mean_albedo);

class MetropolisChains {
  public:
    /// Keeps a reference to `vpl_contribution`, which must outlive the object.
    MetropolisChains(Device& device, VplContribution& vpl_contribution);

    /// Makes independent states from the states.count elements of `indices`, which are places in a randomised
    /// sequence.
    void seed(const PathSpace& space, const Buffer<uint>& indices, PathStates& states);
    /// Takes one step of each chain. `proposed` is scratch of the same size as `chains`. Each step of a run
    /// must have its own number `step`.
    void advance(const PathSpace& space, uint step, PathStates& chains, PathStates& proposed);
    /// Sets kept[first + i] to the VPL of chain i, with its power multiplied by scale / target.
    void keep(const PathStates& chains, float scale, Buffer<Vpl>& kept, std::size_t first);

  private:
    void evaluate(const PathSpace& space, PathStates& states);

    Device* device_;
    VplContribution* vpl_contribution_;
    Program program_;
    Kernel seeds_;
    Kernel walks_;
    Kernel targets_;
    Kernel propose_;
    Kernel accept_;
    Kernel keep_;
    MortonSort morton_sort_;
    Compaction compaction_;
};

}  // namespace nearlight::core
