// SPDX-License-Identifier: Apache-2.0
// The steps of one pass of a picture, and what they add to its report.
#pragma once

#include "host/session/render.h"

namespace nearlight::core {

/// The products of look and sample, which a gather needs.
struct Prepared {
    View view;
    VplSet vpls{};
    RenderSettings settings;                    ///< those of the pass
    double seconds = 0;                         ///< seconds that look and sample took
    std::shared_ptr<PlannedPicture> planned{};  ///< null: it is planned when it is gathered
};

/// Looks at the scene, and notes in the report what the view decides.
View look(Session& session, const RenderSettings& settings, RenderReport& report);

/// Looks at the scene and makes VPLs, with `vpls` unless that is empty. `settings` are those of the pass.
Prepared prepare(Session& session, const RenderSettings& settings, const VplMaker& vpls);
/// Gives a pass its part of the light samples that the pilot chose for it, which are those of all samples of
/// a pixel that `whole` has.
void scale_light_samples(const RenderSettings& whole, Prepared& pass);
/// Adds a pass to the report: the number of VPLs, and, for the first pass, what was decided for all samples
/// of a pixel that `whole` has.
void note_pass(const RenderSettings& whole, const Prepared& pass, RenderReport& report);

/// Gathers the rows of the pass. `next` is PictureSequence::next.
void gather(Session& session, const Prepared& pass, const RowSink& sink, const WorkProgress& progress,
            RenderReport& report, std::function<std::shared_ptr<PlannedPicture>()> next = {});

}  // namespace nearlight::core
