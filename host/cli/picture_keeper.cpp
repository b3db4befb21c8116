// SPDX-License-Identifier: Apache-2.0
#include "host/cli/picture_keeper.h"

#include <utility>

#include "host/cli/log.h"

namespace nearlight::core {
namespace {

constexpr double kLeastSeconds = 5.0;
constexpr double kShare = 0.01;
/// What writing a pixel takes on a slow disk, or where a picture is compressed.
constexpr double kGuessedSecondsPerPixel = 2e-6;

double guessed_seconds(const PassesSoFar& so_far) {
    const PassSums& sums = so_far.average.sums();
    return kGuessedSecondsPerPixel * static_cast<double>(sums.width() * sums.height());
}

}  // namespace

bool WritingPace::is_time(double guess) const {
    if (seconds_) {
        return since_last_.seconds() >= *seconds_;
    }
    return since_last_.seconds() >= kLeastSeconds &&
           spent_ + last_.value_or(guess) <= kShare * total_.seconds();
}

void WritingPace::end() {
    last_ = writing_.seconds();
    spent_ += *last_;
    since_last_ = Stopwatch();
}

PictureKeeper::PictureKeeper(std::filesystem::path checkpoint, std::optional<double> seconds, Actions actions)
    : checkpoint_file_(std::move(checkpoint)),
      actions_(std::move(actions)),
      checkpoint_{"checkpoint", WritingPace(seconds)},
      picture_{"picture", WritingPace(seconds)} {}

void PictureKeeper::attempt(Kept& kept, const std::function<void()>& write) {
    kept.pace.begin();
    try {
        write();
        kept.failure.reset();
    } catch (const Error& error) {
        if (!kept.failure) {
            actions_.warn(error.what());
        }
        kept.failure = error;
    }
    kept.pace.end();
    spdlog::debug("{} written; writing has taken {:.2f} % of the time", kept.name, 100.0 * kept.pace.share());
}

void PictureKeeper::watch(const PassesSoFar& so_far) {
    const bool is_end = so_far.moment == PassesSoFar::Moment::end;
    const double guess = guessed_seconds(so_far);
    if (!checkpoint_file_.empty() && (is_end || checkpoint_.pace.is_time(guess))) {
        attempt(checkpoint_, [&] {
            const PassRecord record = so_far.record();
            if (record.begun_rows > 0 || !record.whole.front().samples.empty()) {
                write_checkpoint(checkpoint_file_, actions_.facts(so_far), record, so_far.average.sums());
            }
        });
    }
    if (so_far.moment == PassesSoFar::Moment::between_passes && picture_.pace.is_time(guess)) {
        attempt(picture_, [&] { actions_.write_picture(so_far); });
    }
}

void PictureKeeper::check() const {
    if (checkpoint_.failure) {
        throw Error(*checkpoint_.failure);
    }
}

}  // namespace nearlight::core
