// SPDX-License-Identifier: Apache-2.0
#include "host/ranks/post.h"

#include <dlfcn.h>

#include <chrono>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <set>

namespace nearlight::core {
namespace {

using namespace std::chrono_literals;

/// How long the thread sleeps between two looks for messages, soon after the last one and later.
constexpr auto kPause = 1ms;
constexpr auto kLongPause = 5ms;
/// Large messages go in parts, each of which needs a look at them on both ends.
constexpr auto kTransferPause = 50us;
constexpr double kAliveSeconds = 1.0;
/// A rank is silent for that long only if its machine is far too busy or is gone.
constexpr double kMaxSilence = 30.0;
constexpr const char* kMaxSilenceVariable = "NEARLIGHT_RANK_SILENCE";
/// How long a leaving rank tries to send what is left, to a rank that may be gone.
constexpr double kLeavingSeconds = 10.0;

int number_in(const char* variable) {
    const char* const text = std::getenv(variable);
    return text == nullptr ? 0 : std::atoi(text);
}

double max_silence() {
    const char* const text = std::getenv(kMaxSilenceVariable);
    const double seconds = text == nullptr ? 0.0 : std::atof(text);
    return seconds > 0.0 ? seconds : kMaxSilence;
}

/// The pause after so many looks at which nothing moved. If messages are on their way, nothing moves for
/// long only if the other rank does not look.
std::chrono::microseconds pause_after(int idle_looks, bool has_transfers) {
    constexpr int kManyLooks = 1000;
    constexpr int kSomeLooks = 100;
    return has_transfers && idle_looks < kManyLooks ? kTransferPause
           : idle_looks < kSomeLooks                ? kPause
                                                    : kLongPause;
}

const MpiFunctions& load_mpi() {
    // The plug-ins of Open MPI look for the symbols of its libraries.
    void* const module = dlopen(kMpiModule, RTLD_NOW | RTLD_GLOBAL);
    const void* const functions = module == nullptr ? nullptr : dlsym(module, kMpiFunctionsName);
    if (functions == nullptr) {
        const char* const reason = dlerror();
        throw Error(ErrorKind::failure,
                    std::string("this nearlight knows no MPI: cannot load ") + kMpiModule + " (" +
                        (reason == nullptr ? "it is empty" : reason) +
                        "); install the package nearlight-mpi, or libopenmpi-dev and build again");
    }
    return *static_cast<const MpiFunctions*>(functions);
}

}  // namespace

bool is_rank_of_job() {
    const bool has_pmix = std::getenv("PMIX_RANK") != nullptr;
    return number_in("OMPI_COMM_WORLD_SIZE") > 1 || (has_pmix && number_in("SLURM_STEP_NUM_TASKS") > 1);
}

Post::Post() : max_silence_(max_silence()) {
    std::promise<Rank> joined;
    joined_ = joined.get_future().share();
    thread_ = std::thread([this, joined = std::move(joined)]() mutable { run(joined); });
}

Post::~Post() {
    {
        const std::lock_guard lock(mutex_);
        leaving_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Post::open(Receiver receiver) {
    const std::lock_guard lock(receiver_mutex_);
    receiver_ = std::move(receiver);
    for (auto& [from, message] : std::exchange(unopened_, {})) {
        receiver_(from, std::move(message));
    }
}

void Post::close() {
    const std::lock_guard lock(receiver_mutex_);
    receiver_ = [](int, const Message&) {};
}

void Post::send(int to, Message message) {
    if (message.bytes().size() > static_cast<std::size_t>(INT_MAX)) {
        throw Error(ErrorKind::out_of_memory,
                    "a message of " + std::to_string(message.bytes().size() >> 20u) +
                        " MiB is too large for MPI; use fewer VPLs or a smaller picture");
    }
    {
        const std::lock_guard lock(mutex_);
        outgoing_.emplace_back(to, std::move(message));
    }
    changed_.notify_all();
}

void Post::check_signs_of_life(int number, const std::string& name) {
    if (has_failed_) {
        throw Error(ErrorKind::failure,
                    name + " cannot be heard of any more, because memory for a message is lacking");
    }
    const auto [silence, is_broken] = [&] {
        const std::lock_guard lock(mutex_);
        const auto rank = static_cast<std::size_t>(number);
        return std::pair(clock_.seconds() - last_heard_[rank], bool{is_broken_[rank]});
    }();
    if (is_broken) {
        has_lost_ = true;
        throw Error(ErrorKind::failure, name + " cannot be reached: MPI lost a message");
    }
    if (silence > max_silence_) {
        has_lost_ = true;
        throw Error(ErrorKind::failure,
                    name + " has not been heard of for " + std::to_string(std::lround(silence)) + " s");
    }
}

void Post::run(std::promise<Rank>& joined) {
    Rank rank;
    try {
        mpi_ = &load_mpi();
        if (const std::string failed = mpi_->start(rank.number, rank.count, rank.host); !failed.empty()) {
            throw Error(ErrorKind::failure, "MPI does not start: " + failed);
        }
    } catch (...) {
        joined.set_exception(std::current_exception());
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        last_heard_.assign(static_cast<std::size_t>(rank.count), clock_.seconds());
        is_broken_.assign(static_cast<std::size_t>(rank.count), false);
    }
    joined.set_value(rank);
    try {
        work(rank);
    } catch (const std::exception&) {
        has_failed_ = has_lost_ = true;
    }
    mpi_->finish(!has_lost_);
}

void Post::work(const Rank& rank) {
    std::optional<Stopwatch> since_leaving;
    int idle_looks = 0;
    for (;;) {
        begin_sending();
        begin_receiving();
        const bool has_received = end_receiving();
        const bool has_sent = end_sending();
        idle_looks = has_received || has_sent ? 0 : idle_looks + 1;
        say_alive(rank);
        std::unique_lock lock(mutex_);
        if (leaving_) {
            since_leaving = since_leaving ? since_leaving : Stopwatch();
            if (outgoing_.empty() && (sending_.empty() || since_leaving->seconds() > kLeavingSeconds)) {
                has_lost_ = has_lost_ || !sending_.empty();
                return;
            }
        }
        changed_.wait_for(lock, pause_after(idle_looks, !sending_.empty() || !receiving_.empty()),
                          [&] { return !outgoing_.empty(); });
    }
}

void Post::begin_sending() {
    std::vector<std::pair<int, Message>> outgoing;
    {
        const std::lock_guard lock(mutex_);
        outgoing.swap(outgoing_);
    }
    for (auto& [to, message] : outgoing) {
        begin_to_send(to, std::move(message));
    }
}

void Post::begin_to_send(int to, Message message) {
    Sending& one = sending_.emplace_back(Sending{.to = to, .message = std::move(message)});
    one.handle = mpi_->begin_send(to, one.message.bytes());
}

/// Returns whether anything was sent.
bool Post::end_sending() {
    return sending_.remove_if([this](const Sending& one) {
        const TransferState state =
            one.handle == nullptr ? TransferState::failed : mpi_->state_of(one.handle);
        if (state == TransferState::failed) {
            mark_broken(one.to);
        }
        return state != TransferState::under_way;
    }) > 0;
}

void Post::begin_receiving() {
    for (;;) {
        Receiving one;
        one.handle = mpi_->begin_receive(one.from, one.bytes);
        if (one.handle == nullptr) {
            return;
        }
        {
            const std::lock_guard lock(mutex_);
            last_heard_[static_cast<std::size_t>(one.from)] = clock_.seconds();
        }
        // Moved bytes stay where they are.
        receiving_.push_back(std::move(one));
    }
}

/// Hands over what is here, in the order in which each rank sent it. Returns whether anything was.
bool Post::end_receiving() {
    std::set<int> late_ranks;
    return receiving_.remove_if([&](Receiving& one) {
        if (one.handle != nullptr) {
            const TransferState state = mpi_->state_of(one.handle);
            if (state == TransferState::failed) {
                mark_broken(one.from);
                return true;
            }
            one.handle = state == TransferState::done ? nullptr : one.handle;
        }
        if (one.handle != nullptr || late_ranks.contains(one.from)) {
            late_ranks.insert(one.from);
            return false;
        }
        hand_over(one.from, Message(std::move(one.bytes)));
        return true;
    }) > 0;
}

void Post::hand_over(int from, Message message) {
    if (!message.is_whole() || message.head().kind == MessageKind::alive) {
        return;
    }
    const std::lock_guard lock(receiver_mutex_);
    if (receiver_) {
        receiver_(from, std::move(message));
    } else {
        unopened_.emplace_back(from, std::move(message));
    }
}

void Post::mark_broken(int number) {
    const std::lock_guard lock(mutex_);
    is_broken_[static_cast<std::size_t>(number)] = true;
}

void Post::say_alive(const Rank& rank) {
    if (since_alive_.seconds() < kAliveSeconds) {
        return;
    }
    since_alive_ = Stopwatch();
    const int first = rank.number == 0 ? 1 : 0;
    const int last = rank.number == 0 ? rank.count - 1 : 0;
    for (int to = first; to <= last; ++to) {
        begin_to_send(to, Message({.kind = MessageKind::alive}));
    }
}

}  // namespace nearlight::core
