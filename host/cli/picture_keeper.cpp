// SPDX-License-Identifier: Apache-2.0
#include "host/cli/picture_keeper.h"

#include <utility>

#include "host/cli/log.h"

namespace nearlight::core {
namespace {

constexpr double kLeastSeconds = 5.0;
/// What part of the time writing may take, for both files together.
constexpr double kMaxShare = 0.02;
/// What writing a pixel of all layers took on two busy cores (docs/reliability.md).
constexpr double kCheckpointSecondsPerPixel = 1.5e-6;
constexpr double kPictureSecondsPerPixel = 3e-6;

}  // namespace

bool WritingPace::is_time(double guess) const {
    if (seconds_) {
        return since_last_.seconds() >= *seconds_;
    }
    return since_last_.seconds() >= kLeastSeconds &&
           spent_ + last_.value_or(guess) <= max_share_ * total_.seconds();
}

void WritingPace::end() {
    last_ = writing_.seconds();
    spent_ += *last_;
    since_last_ = Stopwatch();
}

PictureKeeper::PictureKeeper(std::filesystem::path checkpoint, std::optional<double> seconds, Actions actions)
    : checkpoint_file_(std::move(checkpoint)),
      actions_(std::move(actions)),
      checkpoint_{"checkpoint", WritingPace(seconds, kMaxShare / 2), kCheckpointSecondsPerPixel},
      picture_{"picture", WritingPace(seconds, checkpoint_file_.empty() ? kMaxShare : kMaxShare / 2),
               kPictureSecondsPerPixel} {}

bool PictureKeeper::is_due(const Kept& kept, const PassSums& sums) {
    return kept.pace.is_time(kept.seconds_per_pixel * static_cast<double>(sums.width() * sums.height()));
}

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
    const PassSums& sums = so_far.average.sums();
    if (!checkpoint_file_.empty() && (is_end || is_due(checkpoint_, sums))) {
        attempt(checkpoint_, [&] {
            const PassRecord record = so_far.record();
            if (record.begun_rows > 0 || !record.whole.front().samples.empty()) {
                write_checkpoint(checkpoint_file_, actions_.facts(so_far), record, sums);
                has_checkpoint_ = true;
            }
        });
    }
    if (so_far.moment == PassesSoFar::Moment::between_passes && is_due(picture_, sums)) {
        attempt(picture_, [&] { actions_.write_picture(so_far); });
    }
}

void PictureKeeper::check() const {
    if (checkpoint_.failure) {
        throw Error(*checkpoint_.failure);
    }
}

}  // namespace nearlight::core
