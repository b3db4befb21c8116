// SPDX-License-Identifier: Apache-2.0
// The main path: a scene becomes a picture.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/hash.h"
#include "host/session/checkpoint.h"
#include "host/session/pass_average.h"
#include "host/session/session.h"

namespace nearlight::core {

struct RenderSeconds {
    double build_bvh = 0;
    double compile = 0;   ///< time in which programs were compiled or loaded; other work goes on meanwhile
    double upload = 0;    ///< upload of scene and trees
    double generate = 0;  ///< pilot view and VPLs
    double gather = 0;    ///< camera pass, direct light, gather, film
    double total = 0;
};

struct RenderReport {
    int width = 0;    ///< width in pixels of the part of the picture that is rendered
    int height = 0;   ///< its height in pixels
    float range = 0;  ///< distance at which the close range ends, m
    RayBudget ray_budget{};
    uint max_depth = 0;  ///< maximum path length, as Mitsuba counts it
    PixelFilter filter{};
    uint passes = 0;                 ///< number of passes that were begun
    std::vector<uint> pass_samples;  ///< samples per pixel of each of them
    /// What relative_error() says of the picture; empty unless RenderSettings::error asked for it and a
    /// pass is whole.
    std::optional<double> error;
    PassTotals totals{};       ///< of all passes together
    float close_fraction = 0;  ///< share of close-range VPLs in the first pass
    /// VPLs that a pixel asks about where the set has more; 0: it asks about all, or no pass was made here.
    std::size_t asked_count = 0;
    RenderSeconds seconds;
    std::vector<BandShare> shares;  ///< the part that each device had in the picture
    std::size_t device_bytes = 0;   ///< peak allocation, all devices together
    std::uint64_t image_hash = 0;   ///< hash of the beauty's bits; equal pictures have equal hashes
    bool interrupted = false;       ///< the last pass is incomplete; rows that no pass reached were not sent
};

/// Whether samples count in neighbouring pixels in any pass of the picture.
bool has_splats(const RenderReport& report, const GatherSettings& settings);
/// Whether pixels may have got more camera paths than others in any pass of the picture.
bool has_refinement(const RenderReport& report, const GatherSettings& settings);

/// Called when all settings are decided and before the first row, so that files can be opened with the right
/// size and metadata. View and VPLs are those of the first pass. If there are several passes, it is called
/// after the last of them.
using PictureOpener = std::function<void(const RenderReport&, const View&, const VplSet&)>;

/// Called after each pass but the last of a picture that is made until it reaches an error.
using ForecastSink = std::function<void(const PassForecast&)>;

/// What has become of a picture of several passes so far.
struct PassesSoFar {
    enum class Moment { within_pass, between_passes, end };
    Moment moment;
    const RenderReport& report;
    const View& view;  ///< of the first pass that was made
    const PassAverage& average;
    std::function<PassRecord()> record;  ///< with average.sums(), what it takes to go on from here
};
/// Called within passes when rows have come, after each pass and after the last, in the caller's thread,
/// while devices go on. What it throws ends the render.
using PassWatcher = std::function<void(const PassesSoFar&)>;

/// Where passes begin.
struct PassStart {
    uint first = 0;  ///< number of the first pass; those before it are made elsewhere, with the same settings
    std::optional<Checkpoint> checkpoint{};  ///< to go on from
    /// Makes a picture of one pass in the way of several, so that there are sums to be kept.
    bool keeps_sums = false;

    [[nodiscard]] bool is_plain() const { return first == 0 && !checkpoint && !keeps_sums; }
};

/// Makes the VPLs of a pass, as Session::sample() else does. View, sampling and seed are those of the pass.
using VplMaker = std::function<VplSet(const ViewSettings&, const SamplingSettings&, uint seed)>;

/// What a render calls. Those that do nothing here may be left out.
struct RenderHooks {
    PictureOpener open = [](const RenderReport&, const View&, const VplSet&) {};
    RowSink rows = [](std::span<const float>) {};
    WorkProgress progress = [](double) { return true; };  ///< takes how far the whole picture is
    ForecastSink forecast{};
    PassWatcher watcher{};
    VplMaker vpls{};  ///< empty: Session::sample() makes them
};

/// Whether a picture is made in the way of several passes, which spreads single samples
/// (GatherSettings::spread_single_samples).
bool averages_passes(const RenderSettings& settings, const PassStart& pass_start);

/// Adds finished rows to RenderReport::image_hash.
void add_beauty(std::span<const float> rows, Hasher& hasher);

/// Renders one picture, or the mean of several passes. Only a session's first report includes the seconds of
/// getting ready. From a checkpoint of the same scene and settings and the same kind of device, the picture
/// becomes the one of an uninterrupted render, to the bit; the report counts the passes of both, but the
/// time, memory and devices of this one. If the checkpoint has whole passes, `hooks.open` gets a view as pass
/// 0 has it, and no VPLs. Throws Error(ErrorKind::invalid_argument) if averages_passes() and the VPLs come
/// from a file, which has the same for every pass.
RenderReport render(Session& session, const RenderSettings& settings, const RenderHooks& hooks,
                    PassStart pass_start = {});

}  // namespace nearlight::core
