// SPDX-License-Identifier: Apache-2.0
// The facts about its picture that `nearlight render` puts into the file, into JSON and on the terminal.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/cl/device.h"
#include "host/cli/rendered_picture.h"
#include "host/cli/scene_options.h"
#include "host/image/image_io.h"
#include "host/session/render.h"

namespace nearlight::core {

/// A number for metadata. Whole numbers of pictures have 32 bits; greater ones are written as text.
Metadata::mapped_type count_value(std::uint64_t count);

/// The EXR's attributes `nearlight:…` and those of its camera.
Metadata render_metadata(std::uint64_t scene_hash, const SceneOptions& scene, const RenderSettings& settings,
                         const RenderReport& report, const View& view,
                         const std::vector<std::unique_ptr<Device>>& devices,
                         const std::string& command_line);

/// The time of the first finished rows of the picture.
struct FirstRows {
    double seconds = 0.0;            ///< since the command began
    double processor_seconds = 0.0;  ///< of all threads since the process began, including the loader's

    /// Records the times; only the first call has an effect.
    void note(const Stopwatch& since_begin);
};

/// What the object of `render --json` is made of.
struct RenderFacts {
    const SceneOptions& scene;
    std::vector<std::string> outputs;  ///< files that were written
    const RenderSettings& settings;
    BvhQuality bvh;
    const RenderReport& report;
    const RenderedPicture& picture;
    double load_seconds;
    const FirstRows& first_rows;
    const std::vector<std::unique_ptr<Device>>& devices;
};

/// The object that `render --json` prints.
nlohmann::ordered_json render_json(const RenderFacts& facts);

/// Logs the share of the picture that each device made, if there were several.
void tell_shares(const RenderReport& report);

}  // namespace nearlight::core
