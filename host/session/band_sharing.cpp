// SPDX-License-Identifier: Apache-2.0
#include "host/session/band_sharing.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>
#include <utility>

#include "host/base/message.h"
#include "host/base/stopwatch.h"

namespace nearlight::core {
namespace {

std::string message_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const std::exception& exception) {
        return exception.what();
    } catch (...) {
        return "unknown error";
    }
}

/// The state that workers and caller share. One mutex guards all members.
class Board {
  public:
    Board(uint band_count, uint window, std::span<const BandWorker> workers)
        : band_count_(band_count), window_(window), fractions_(workers.size()), working_(workers.size()) {
        for (uint band = 0; band < band_count; ++band) {
            waiting_.insert(waiting_.end(), band);
        }
        for (const BandWorker& worker : workers) {
            if (worker.first_band) {
                waiting_.erase(*worker.first_band);
            }
        }
    }

    // Workers call the next functions.

    /// Waits for and takes the first waiting band. Returns nothing when all bands are finished or the work
    /// was stopped. Calls `wait`, and empties it, when no band waits any more.
    std::optional<uint> take(std::function<void()>& wait) {
        std::unique_lock lock(mutex_);
        if (wait && waiting_.empty() && !stopping_) {
            lock.unlock();
            std::exchange(wait, nullptr)();
            lock.lock();
        }
        // A band that another worker has may yet come back.
        changed_.wait(lock, [&] { return stopping_ || finished_count_ == band_count_ || may_take(); });
        if (stopping_ || waiting_.empty()) {
            return std::nullopt;
        }
        return waiting_.extract(waiting_.begin()).value();
    }
    bool advance(std::size_t worker, double fraction) {
        const std::lock_guard lock(mutex_);
        fractions_[worker] = fraction;
        announce();
        return !stopping_;
    }
    void finish(std::size_t worker, uint band, FinishedBand result) {
        const std::lock_guard lock(mutex_);
        finished_.emplace(band, std::move(result));
        ++finished_count_;
        fractions_[worker] = 0;
        announce();
    }
    /// Ends a worker. Its unfinished band, if any, waits again.
    void leave(std::size_t worker, std::optional<uint> unfinished, std::exception_ptr error) {
        const std::lock_guard lock(mutex_);
        fractions_[worker] = 0;
        if (unfinished) {
            waiting_.insert(*unfinished);
        }
        if (error) {
            failures_.push_back({worker, std::move(error)});
        }
        --working_;
        announce();
    }

    // The caller of share_bands() calls the next functions.

    struct Failure {
        std::size_t worker;
        std::exception_ptr error;
    };
    struct News {
        std::vector<FinishedBand> bands;  ///< finished bands that follow those of earlier news
        std::vector<Failure> failures;
        double fraction = 0;
        std::size_t working = 0;  ///< number of workers that have not ended
        bool complete = false;    ///< every band was handed out
    };
    /// Waits until there is news and returns it. The first call does not wait.
    News wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return is_new_; });
        return news();
    }
    void stop() {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        announce();
    }

  private:
    [[nodiscard]] bool may_take() const {
        return !waiting_.empty() && *waiting_.begin() < next_out_ + window_;
    }
    void announce() {
        is_new_ = true;
        changed_.notify_all();
    }
    News news() {
        is_new_ = false;
        News result{.bands = {}, .failures = std::exchange(failures_, {}), .working = working_};
        while (!finished_.empty() && finished_.begin()->first == next_out_) {
            result.bands.push_back(std::move(finished_.extract(finished_.begin()).mapped()));
            ++next_out_;
        }
        if (!result.bands.empty()) {
            changed_.notify_all();  // the window has moved
        }
        const double in_hand = std::accumulate(fractions_.begin(), fractions_.end(), 0.0);
        result.fraction = band_count_ == 0 ? 1.0 : (finished_count_ + in_hand) / band_count_;
        result.complete = next_out_ == band_count_;
        return result;
    }

    const uint band_count_;
    const uint window_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::set<uint> waiting_;
    std::map<uint, FinishedBand> finished_;  ///< finished bands that were not handed out
    uint finished_count_ = 0;
    uint next_out_ = 0;              ///< the first band that was not handed out
    std::vector<double> fractions_;  ///< how far each worker is with its band
    std::size_t working_;
    std::vector<Failure> failures_;  ///< failures that no news has reported
    bool stopping_ = false;
    bool is_new_ = true;  ///< something changed since the last news
};

/// Takes and makes bands until none are left; runs in the worker's thread.
void work(Board& board, std::size_t index, const BandWorker& worker, BandShare& share) {
    std::optional<uint> in_hand = worker.first_band;
    Stopwatch watch;
    std::exception_ptr error;
    try {
        const BandMaker make = worker.start();
        std::function<void()> wait = worker.wait;
        while (in_hand || (in_hand = board.take(wait))) {
            watch.lap();
            auto band = make(*in_hand, [&](double fraction) { return board.advance(index, fraction); });
            share.seconds += watch.lap();
            if (!band) {
                break;
            }
            ++share.bands;
            board.finish(index, *std::exchange(in_hand, std::nullopt), std::move(*band));
        }
    } catch (...) {
        share.seconds += in_hand ? watch.lap() : 0.0;
        share.failed = true;
        error = std::current_exception();
    }
    // From then on, only the caller holds the exception. Its references are counted in a library that
    // sanitizers cannot see into, so that they would report a race if this thread let go of it, too.
    board.leave(index, in_hand, std::move(error));
}

/// The workers' threads. The destructor stops and joins them, so that no exception leaves them running.
class Crew {
  public:
    Crew(Board& board, std::span<const BandWorker> workers, std::vector<BandShare>& shares) : board_(board) {
        try {
            for (std::size_t i = 0; i < workers.size(); ++i) {
                threads_.emplace_back([&, i, worker = &workers[i]] { work(board, i, *worker, shares[i]); });
            }
        } catch (...) {
            board.stop();  // The threads that did start are joined, and would wait for the others for ever.
            throw;
        }
    }
    ~Crew() { board_.stop(); }
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

  private:
    Board& board_;
    std::vector<std::jthread> threads_;  // joined after stop()
};

/// Warns of workers that failed. If no worker is left to do their part, rethrows the last one's exception.
void tell_failures(const Board::News& news, std::span<const BandWorker> workers) {
    const bool lost = news.working == 0 && !news.complete;
    for (const Board::Failure& failure : news.failures) {
        if (lost && &failure == &news.failures.back()) {
            std::rethrow_exception(failure.error);
        }
        say_lost_device(workers[failure.worker].name, message_of(failure.error));
    }
}

/// Runs the workers. Returns false if `progress` stopped them. No worker is running afterwards.
bool work_together(Board& board, std::span<const BandWorker> workers, std::vector<BandShare>& shares,
                   const std::function<void(FinishedBand& band)>& sink, const WorkProgress& progress) {
    const Crew crew(board, workers, shares);
    for (;;) {
        Board::News news = board.wait();
        for (FinishedBand& band : news.bands) {
            sink(band);
        }
        tell_failures(news, workers);
        if (news.complete) {
            return true;
        }
        if (!progress(news.fraction)) {
            return false;
        }
    }
}

}  // namespace

BandOutcome share_bands(uint band_count, uint window, std::span<const BandWorker> workers,
                        const std::function<void(FinishedBand& band)>& sink, const WorkProgress& progress) {
    BandOutcome outcome;
    for (const BandWorker& worker : workers) {
        outcome.shares.push_back({.name = worker.name});
    }
    Board board(band_count, std::max(window, 1u), workers);
    outcome.interrupted = !work_together(board, workers, outcome.shares, sink, progress);
    return outcome;
}

void add_shares(std::span<const BandShare> shares, std::vector<BandShare>& sum) {
    if (sum.empty()) {
        sum.assign(shares.begin(), shares.end());
        return;
    }
    auto place = sum.begin();  // devices may share a name
    for (const BandShare& share : shares) {
        place = std::find_if(place, sum.end(), [&](const BandShare& one) { return one.name == share.name; });
        if (place == sum.end()) {
            return;
        }
        place->bands += share.bands;
        place->seconds += share.seconds;
        place->failed = place->failed || share.failed;
        ++place;
    }
}

}  // namespace nearlight::core
