// SPDX-License-Identifier: Apache-2.0
// Rendering into an Image, for tests.
#pragma once

#include <utility>
#include <vector>

#include "host/image/image.h"
#include "host/session/render.h"
#include "host/stages/film_layers.h"

namespace nearlight::core::test {

struct Rendering {
    Image image;
    RenderReport report;
};

/// Settings that are cheap and use every kind of light and random number.
inline RenderSettings few_vpls(SamplerKind sampler = SamplerKind::close_range) {
    return {.sampling = {.sampler = sampler, .vpl_count = 60},
            .gather = {.samples_per_pixel = 2, .direct_samples_per_pixel = 4},
            .seed = 5};
}

/// Hooks of a render may be added; those that take the picture are replaced.
inline Rendering render_image(Session& session, const RenderSettings& settings, RenderHooks hooks = {},
                              PassStart pass_start = {}) {
    Rendering rendering;
    hooks.open = [&](const RenderReport& report, const View&, const VplSet&) {
        rendering.image = {report.width, report.height, layer_channels(), {}};
    };
    hooks.rows = [&](std::span<const float> rows) {
        rendering.image.values.insert(rendering.image.values.end(), rows.begin(), rows.end());
    };
    rendering.report = render(session, settings, hooks, std::move(pass_start));
    return rendering;
}
inline Rendering render_image(Device& device, const Scene& scene, const RenderSettings& settings) {
    Session session(device, scene);
    return render_image(session, settings);
}

/// Pictures with the seeds first, first + 1, …
inline std::vector<Image> render_seeds(Session& session, RenderSettings settings, uint first, uint count) {
    std::vector<Image> images;
    for (uint i = 0; i < count; ++i) {
        settings.seed = first + i;
        images.push_back(render_image(session, settings).image);
    }
    return images;
}

}  // namespace nearlight::core::test
