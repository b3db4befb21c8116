// SPDX-License-Identifier: Apache-2.0
// Markov chains over walks [Segovia et al., Metropolis Instant Radiosity, Eurographics 2007], in primary
// sample space [Kelemen et al., A Simple and Robust Mutation Strategy for the Metropolis Light Transport
// Algorithm, 2002].
//
// A state is a point of the unit cube, in pairs of numbers: (depth, choice of light), position and direction
// on the light, then NEARLIGHT_WALK_PAIRS_PER_STEP pairs for each surface. It stands for one VPL: the deposit
// of that walk at that depth, with its flux divided by the probability of the depth. Pair p of state i lies
// at p · count + i. Pairs of bounces beyond the state's depth are unused.
//
// - metropolis_seeds: writes the numbers of independent states, by index into a randomised sequence.
// - metropolis_walks: turns numbers into VPLs, of power 0 and without a normal where the walk does not get
//   that far.
// - metropolis_targets: computes what chains follow: the contribution to the camera, plus blind_target for
//   each watt, for what the estimate of the contribution misses. Contributions are in the order of the Morton
//   curve for the gather's sake: entry i is that of state order[i].
// - metropolis_propose: writes the numbers of the next state to try.
// - metropolis_accept: moves there with probability min(1, proposed target / current target).
// - metropolis_keep: writes the VPLs of the states as they are, of power · scale / target.
// One work-item for each state; any work-group size.

#include "lib/light_walk.cl"
#include "lib/random.cl"

/// The share of proposals that forget the state.
#define LARGE_STEPS 0.3f
/// The share of the other proposals that draw a new depth.
#define NEW_DEPTHS 0.25f
/// The minimum and the maximum of a small step of a number.
#define MIN_STEP (1.0f / 1024.0f)
#define MAX_STEP (1.0f / 16.0f)

kernel void metropolis_seeds(const global uint* restrict indices, uint count, uint pair_count, uint seed,
                             global float2* restrict numbers) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    for (uint pair = 0; pair < pair_count; ++pair) {
        numbers[pair * count + index] = sample_2d(indices[index], pair, seed);
    }
}

kernel void metropolis_walks(SCENE_PARAMETERS, WalkAim aim, const global float* restrict depth_cdf,
                             uint bounce_count, const global float2* restrict numbers, uint count,
                             global Vpl* restrict vpls) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const float2 choice = numbers[index];
    const uint last = search_cdf(depth_cdf, bounce_count, choice.x);
    const float probability = step_of_cdf(depth_cdf, last);
    EmittedParticle particle =
        emit_particle(&scene, &aim, choice.y, numbers[count + index], numbers[2 * count + index]);
    MetSurface at;
    float3 reflected = (float3)(0.0f);
    for (uint step = 0; step <= last && !is_black(particle.flux); ++step) {
        const uint pair = NEARLIGHT_WALK_PAIRS_ON_LIGHT + NEARLIGHT_WALK_PAIRS_PER_STEP * step;
        const float2 choice_here = numbers[pair * count + index];
        if (!land(&scene, &particle, choice_here.x, &at)) {
            break;
        }
        if (step == last) {
            reflected = reflected_flux(&scene, &particle, &at);
        } else {
            scatter(&scene, &particle, &at, &aim, choice_here.y, numbers[(pair + 1) * count + index]);
        }
    }
    if (is_black(reflected)) {
        vpls[index] = make_vpl((float3)(0.0f), (float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f), 0, last + 1, 0,
                               (float3)(0.0f));
    } else {
        vpls[index] = make_deposit(&at, last + 1, 0, reflected / probability);
    }
}

kernel void metropolis_targets(const global Vpl* restrict vpls, const global uint* restrict order,
                               const global float* restrict contribution, float blind_target, uint count,
                               global float* restrict targets) {
    const uint place = (uint)get_global_id(0);
    if (place >= count) {
        return;
    }
    const uint index = order[place];
    const float target = contribution[place] + blind_target * luminance(load3(vpls[index].power));
    targets[index] = target > 0.0f && target < INFINITY ? target : 0.0f;
}

/// A number moved by a random step on the unit circle. A step and the step back have the same distribution.
static inline float small_step(float u, uint bits) {
    const float size = MAX_STEP * exp(-log(MAX_STEP / MIN_STEP) * to_unit_float(bits));
    const float moved = bits & 1u ? u + size : u - size;
    return clamp(moved - floor(moved), 0.0f, 0x1.fffffep-1f);
}

/// Random words of one step of a chain. Those of `pair` 0 decide, and those of `pair` p + 1 move pair p.
static inline uint4 step_words(uint chain, uint step, uint pair, uint seed) {
    return random_uint4((uint4)(chain, step, pair, seed));
}

kernel void metropolis_propose(const global float2* restrict current, uint count, uint pair_count, uint step,
                               uint seed, global float2* restrict proposed) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    const uint4 decisions = step_words(index, step, 0, seed);
    const bool is_large = to_unit_float(decisions.x) < LARGE_STEPS;
    const bool is_new_depth = to_unit_float(decisions.y) < NEW_DEPTHS;
    for (uint pair = 0; pair < pair_count; ++pair) {
        const uint4 words = step_words(index, step, pair + 1, seed);
        const float2 anew = (float2)(to_unit_float(words.x), to_unit_float(words.y));
        const float2 old = current[pair * count + index];
        float2 moved = (float2)(small_step(old.x, words.x), small_step(old.y, words.y));
        if (pair == 0) {
            moved.x = is_new_depth ? anew.x : old.x;
        }
        proposed[pair * count + index] = is_large ? anew : moved;
    }
}

kernel void metropolis_accept(const global float2* restrict proposed,
                              const global Vpl* restrict proposed_vpls,
                              const global float* restrict proposed_targets, uint count, uint pair_count,
                              uint step, uint seed, global float2* restrict current,
                              global Vpl* restrict vpls, global float* restrict targets) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    const float chance = to_unit_float(step_words(index, step, 0, seed).z);
    if (!(chance * targets[index] < proposed_targets[index])) {
        return;
    }
    targets[index] = proposed_targets[index];
    vpls[index] = proposed_vpls[index];
    for (uint pair = 0; pair < pair_count; ++pair) {
        current[pair * count + index] = proposed[pair * count + index];
    }
}

kernel void metropolis_keep(const global Vpl* restrict vpls, const global float* restrict targets,
                            float scale, uint count, uint first, global Vpl* restrict kept) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    Vpl vpl = vpls[index];
    vpl.power = store3(load3(vpl.power) * (scale / targets[index]));
    kept[first + index] = vpl;
}
