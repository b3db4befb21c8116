// SPDX-License-Identifier: Apache-2.0
// What `nearlight render` says of its picture: in the file, as JSON, and to the user.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/cl/device.h"
#include "host/image/image_io.h"
#include "host/session/render.h"

namespace nearlight::core {

/// The EXR's `nearlight:…` entries and those of its camera.
Metadata render_metadata(std::uint64_t scene_hash, const RenderSettings& settings, const RenderReport& report,
                         const View& view, const std::vector<std::unique_ptr<Device>>& devices);

/// When the first rows of the picture came: how long one waits for a first answer.
struct FirstRows {
    double seconds = 0.0;            ///< since the command began
    double processor_seconds = 0.0;  ///< of all threads, since the process began; the loader's too

    /// The first call counts.
    void note(const Stopwatch& since_begin);
};

/// What `render --json` prints.
nlohmann::ordered_json render_json(const std::string& scene_file, const std::vector<std::string>& outputs,
                                   const RenderSettings& settings, BvhQuality bvh, const RenderReport& report,
                                   double load_seconds, const FirstRows& first_rows,
                                   const std::vector<std::unique_ptr<Device>>& devices);

/// Which device made how much of the picture, where there were several.
void tell_shares(const RenderReport& report);

}  // namespace nearlight::core
