// SPDX-License-Identifier: Apache-2.0
// Writes a picture and its checkpoint to disk while passes are made.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "host/base/stopwatch.h"
#include "host/cli/checkpoint_file.h"
#include "host/session/render.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// Decides when it is time to write something again: after so many seconds, or, if that is open, after 5 s
/// and so seldom that writing takes at most the part `share` of the time.
class WritingPace {
  public:
    WritingPace(std::optional<double> seconds, double share) : seconds_(seconds), max_share_(share) {}

    /// `guess` is how many seconds the first writing takes on a busy machine.
    [[nodiscard]] bool is_time(double guess) const;
    /// To be called before and after writing.
    void begin() { writing_ = Stopwatch(); }
    void end();
    /// What part of the time writing has taken, from 0 to 1.
    [[nodiscard]] double share() const { return spent_ / total_.seconds(); }

  private:
    std::optional<double> seconds_;
    double max_share_;
    Stopwatch total_;
    Stopwatch since_last_;
    Stopwatch writing_;
    double spent_ = 0.0;
    std::optional<double> last_;  ///< seconds that the last writing took
};

class PictureKeeper {
  public:
    struct Actions {
        /// The facts of the picture so far.
        std::function<CheckpointFacts(const PassesSoFar&)> facts;
        std::function<void(const PassesSoFar&)> write_picture;
        /// Told why something could not be written. The render goes on, since the disk may have room later.
        std::function<void(const std::string& why)> warn;
    };

    /// `checkpoint` may be empty. `seconds` is the least time between two writings.
    PictureKeeper(std::filesystem::path checkpoint, std::optional<double> seconds, Actions actions);

    /// Writes what is due. At the end the checkpoint is due, but not the picture.
    void watch(const PassesSoFar& so_far);
    /// Throws what kept the last checkpoint from being written.
    void check() const;
    /// Whether a checkpoint was written. None is before the first row is there.
    [[nodiscard]] bool has_checkpoint() const { return has_checkpoint_; }

  private:
    /// One of the two files.
    struct Kept {
        const char* name;
        WritingPace pace;
        double seconds_per_pixel;        ///< a guess
        std::optional<Error> failure{};  ///< of the last writing
    };
    static bool is_due(const Kept& kept, const PassSums& sums);
    void attempt(Kept& kept, const std::function<void()>& write);

    std::filesystem::path checkpoint_file_;
    Actions actions_;
    Kept checkpoint_;
    Kept picture_;
    bool has_checkpoint_ = false;
};

}  // namespace nearlight::core
