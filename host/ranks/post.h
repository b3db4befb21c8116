// SPDX-License-Identifier: Apache-2.0
// Sends and receives messages between the ranks of a job.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <list>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/ranks/message.h"
#include "host/ranks/mpi_functions.h"

namespace nearlight::core {

/// Whether `mpirun`, or Slurm's `srun` with PMIx, started this process as one of several. Their variables say
/// so, because asking MPI would take half a second in every process that is not.
bool is_rank_of_job();

/// This process in its job.
struct Rank {
    int number = 0;  ///< rank 0 leads
    int count = 1;   ///< of processes in the job
    std::string host;
};

/// The post office of a rank. A thread of its own does all that is done with MPI. MPI waits by turning in
/// circles, which would take a core from the rendering, so the thread sleeps for milliseconds between two
/// looks for messages instead, and for less while messages are on their way.
class Post {
  public:
    using Receiver = std::function<void(int from, Message message)>;

    /// Begins to join the job. Compile workers must be started before.
    Post();
    /// Sends what is left and leaves the job together with the other ranks.
    ~Post();
    Post(const Post&) = delete;
    Post& operator=(const Post&) = delete;

    /// Waits until this process has joined the job. Throws Error(ErrorKind::failure) if it could not.
    [[nodiscard]] const Rank& rank() { return joined_.get(); }
    /// Has messages given to `receiver` from now on, in the thread of the post office, in the order in which
    /// each rank sent them. Earlier ones come first. `receiver` must not throw.
    void open(Receiver receiver);
    /// No message is given to the receiver after this returns.
    void close();
    /// Throws Error(ErrorKind::out_of_memory) for a message of 2 GiB or more, which MPI does not send.
    void send(int to, Message message);

    /// Throws Error(ErrorKind::failure) if a rank has not been heard of for 30 s, or for as many as the
    /// environment variable NEARLIGHT_RANK_SILENCE says, if a message to or from it was lost, or if the
    /// thread had to end. Each rank says something to the leading one every second, and hears from it.
    void check_signs_of_life(int number, const std::string& name);
    /// Whether any rank has been lost.
    [[nodiscard]] bool has_lost() const { return has_lost_; }
    /// Leaves the job without waiting for the other ranks when the time comes.
    void break_up() { has_lost_ = true; }

  private:
    struct Sending {
        int to = 0;
        Message message;
        void* handle = nullptr;
    };
    struct Receiving {
        int from = 0;
        std::vector<std::byte> bytes{};
        void* handle = nullptr;  ///< null once the bytes are here
    };

    void run(std::promise<Rank>& joined);
    void work(const Rank& rank);
    void begin_sending();
    void begin_to_send(int to, Message message);
    bool end_sending();
    void begin_receiving();
    bool end_receiving();
    void hand_over(int from, Message message);
    void mark_broken(int number);
    void say_alive(const Rank& rank);

    std::shared_future<Rank> joined_;
    const MpiFunctions* mpi_ = nullptr;
    // These are of the thread alone.
    std::list<Sending> sending_;
    std::list<Receiving> receiving_;  ///< in the order in which their heads came
    Stopwatch since_alive_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::pair<int, Message>> outgoing_;
    std::vector<double> last_heard_;  ///< seconds of clock_ for each rank
    std::vector<bool> is_broken_;     ///< for each rank, whether a message to or from it was lost
    Stopwatch clock_;
    bool leaving_ = false;
    std::atomic<bool> has_lost_{false};
    /// The thread has ended, because there was no memory for a message.
    std::atomic<bool> has_failed_{false};
    double max_silence_;

    std::mutex receiver_mutex_;
    Receiver receiver_;
    std::vector<std::pair<int, Message>> unopened_;
    std::thread thread_;
};

}  // namespace nearlight::core
