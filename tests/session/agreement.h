// SPDX-License-Identifier: Apache-2.0
// Compares the renderer with the reference path tracer on whole pictures, antialiased and with direct light.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/reference/path_tracer.h"
#include "tests/session/convergence.h"
#include "tests/session/rendering.h"

namespace nearlight::core::test {

/// Width and height of the pictures, pixels.
inline constexpr int kAgreementSize = 32;

/// Compares the layers direct and indirect of several seeds with a path-traced picture, as convergence.h
/// explains. `truth_samples` are the path tracer's for each pixel: where its paths meet a lamp by chance, too
/// few of them know nothing of their own noise. If rays of receivers compensate for the clamp radius, the
/// path tracer has none.
inline void expect_agreement(Device& device, const Scene& scene, SamplerKind sampler, float clamp_radius,
                             bool compensate, uint max_depth = 6, int truth_samples = 512) {
    SCOPED_TRACE(compensate ? "compensated" : "clamped");
    constexpr uint kSeeds = 16;
    const Image truth = trace_paths(scene, {.width = kAgreementSize,
                                            .height = kAgreementSize,
                                            .spp = truth_samples,
                                            .max_depth = static_cast<int>(max_depth),
                                            .clamp_radius = compensate ? 0.0f : clamp_radius,
                                            .seed = 9});
    Session session(device, scene);
    const RenderSettings settings{
        .view = {.width = kAgreementSize,
                 .height = kAgreementSize,
                 .clamp_radius = clamp_radius,
                 .max_depth = max_depth},
        .sampling = {.sampler = sampler, .vpl_count = 1000},
        .gather = {.samples_per_pixel = 4, .direct_samples_per_pixel = 64, .compensate = compensate}};
    const std::vector<Image> renders = render_seeds(session, settings, 100, kSeeds);
    for (const std::string layer : {"direct", "indirect"}) {
        const Verdict verdict = judge_convergence(renders, truth, layer);
        EXPECT_TRUE(verdict.agrees) << layer << ": " << verdict.reason;
        EXPECT_LT(verdict.relative_error, 0.02) << layer << ": too noisy to tell anything";
    }
}

inline void expect_agreement(Device& device, const Scene& scene, SamplerKind sampler, float clamp_radius) {
    expect_agreement(device, scene, sampler, clamp_radius, false);
    expect_agreement(device, scene, sampler, clamp_radius, true);
}

}  // namespace nearlight::core::test
