// SPDX-License-Identifier: Apache-2.0
// Decides how many passes a picture has, and how many samples each of them.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "host/base/stopwatch.h"
#include "kernels/shared/types.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// The maximum number of passes towards RenderSettings::error, if RenderSettings::passes does not say
/// another.
inline constexpr uint kMaxPassesToError = 1000;

/// What the passes so far let one expect.
struct PassForecast {
    double error = 0;     ///< so far, see relative_error()
    double passes = 0;    ///< until the error is reached, if those to come have full length
    double seconds = 0;   ///< from the beginning until then
    bool reaches = true;  ///< whether the limits of passes and seconds allow that
};

/// What passes have taken so far, by which the next are planned.
struct PassPace {
    std::optional<double> sample_seconds;  ///< of one sample per pixel
    double vpl_seconds = 0;                ///< of making the VPLs of a pass
};

/// Passes follow one another until their list is used up, or their number, the time or the error is reached.
/// The error falls as the root of the samples. Where less than a pass is missing, or less than a pass fits in
/// the time, the pass has fewer samples. If already the first pass turns out not to fit, it is begun again
/// with fewer.
class PassSchedule {
  public:
    /// The time of the settings begins now.
    explicit PassSchedule(const RenderSettings& settings);

    /// Goes on after passes of `samples`, whose picture has the error `error` if it is known, with a pass of
    /// `begun_samples` per pixel that is done to the part `begun_part`. If `begun_samples` is 0, the next
    /// pass is chosen as usual. To be called before the first begin().
    void resume(std::vector<uint> samples, std::optional<double> error, const PassPace& pace,
                uint begun_samples, double begun_part);

    /// Begins a pass and returns its samples per pixel, or nothing if there is to be none. If is_too_long()
    /// said so of the present pass, and that was given up, begins it again with fewer samples.
    std::optional<uint> begin();
    /// Sets how many passes it takes to believe that an error is reached; 1 at first. An error of 0 is always
    /// believed.
    void believe_after(uint passes) { believed_passes_ = passes; }
    /// To be called when the VPLs of the pass are there. Those of the next pass may take
    /// `seconds_unless_kept`, if that is more than these took (VplSet).
    void note_vpls(double seconds_unless_kept = 0.0) {
        pace_.vpl_seconds = pass_watch_.seconds();
        next_vpl_seconds_ = std::max(pace_.vpl_seconds, seconds_unless_kept);
    }
    /// Whether the present pass should be given up, as it would take far longer than the time allows.
    /// `of_pass` is how far its gather is, from 0 to 1.
    bool is_too_long(double of_pass);
    /// To be called when the pass is there. `error` is that of the picture so far, if it is known.
    void end(std::optional<double> error);

    /// The samples of the pass after the present one, which begin() will say; 0 if that cannot be told yet or
    /// there will be none.
    [[nodiscard]] uint sure_next_samples() const;

    /// How far all passes are, from 0 to 1, if the present one is as far as `of_pass`, also from 0 to 1.
    [[nodiscard]] double fraction(double of_pass) const;
    /// Nothing, unless passes are made until an error is reached and one of them is there.
    [[nodiscard]] std::optional<PassForecast> forecast() const;
    /// The samples of each pass that has ended.
    [[nodiscard]] const std::vector<uint>& samples() const { return samples_; }
    [[nodiscard]] const PassPace& pace() const { return pace_; }

  private:
    [[nodiscard]] uint next_samples() const;
    [[nodiscard]] double seconds_left() const;
    /// The number of samples whose pass would end in time; may be negative.
    [[nodiscard]] double fitting_samples() const;
    /// The number of samples per pixel that the error needs in all.
    [[nodiscard]] double needed_samples() const;
    [[nodiscard]] bool is_at_error() const;
    /// Whether the present pass is begun again with fewer samples if it turns out not to fit in the time.
    [[nodiscard]] bool may_be_given_up() const;
    /// What the present pass still takes if it is as far as `of_pass`; 0 if nothing is known.
    [[nodiscard]] double rest_seconds(double of_pass) const;

    std::vector<uint> list_;  ///< samples of each pass; empty: as the limits allow
    uint full_samples_;
    uint min_samples_;        ///< of the first pass
    uint min_later_samples_;  ///< of each pass after it
    uint max_passes_;
    std::optional<double> seconds_;
    std::optional<double> target_;
    Stopwatch watch_;

    std::vector<uint> samples_;
    double done_samples_ = 0;
    uint believed_passes_ = 1;
    std::optional<double> error_;
    PassPace pace_;  ///< of the present or the last pass
    double next_vpl_seconds_ = 0.0;
    bool is_resumed_ = false;
    uint begun_samples_ = 0;  ///< of the pass to go on with; 0: there is none

    uint present_samples_ = 0;
    double present_part_ = 1.0;  ///< of the present pass, the part that was not made before resume()
    Stopwatch pass_watch_;
    /// The moment from which the pace of the present pass is judged, in seconds after its beginning, and how
    /// far the pass was then. What comes before has the driver's compiling in it.
    struct Mark {
        double seconds = 0;
        double fraction = 0;
    };
    std::optional<Mark> mark_;
};

}  // namespace nearlight::core
