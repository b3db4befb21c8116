// SPDX-License-Identifier: Apache-2.0
// A helping rank: it makes bands until the leading rank ends the job.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "host/ranks/hello.h"
#include "host/ranks/post.h"
#include "host/session/session.h"

namespace nearlight::core {

/// Sends a picture to the ranks that this one passes pictures on to. Each rank has two of them, so that not
/// one rank sends a picture as many times as there are ranks.
void pass_on(Post& post, const Message& picture);
/// The rank that passes pictures on to this one, which is not 0.
constexpr int relay_of(int rank) {
    return (rank - 1) / 2;
}

class Service {
  public:
    /// Keeps a reference to `post`, whose messages it receives.
    explicit Service(Post& post);
    ~Service() { post_.close(); }
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    // Both throw Error(ErrorKind::failure) if the leading rank is lost.

    /// Says why this rank is not ready, and waits for the end of the job.
    void refuse(const Error& failure);
    /// Says that the session is ready, and makes bands on its devices until the end of the job. `facts` are
    /// Hello::facts.
    void run(const Session& session, const std::string& facts);

  private:
    struct ShownPicture {
        PictureTask picture;
        VplBuffer vpls;
    };
    struct Order {
        PictureNumber picture = 0;
        uint band = 0;
        std::shared_ptr<const ShownPicture> shown{};  ///< once it is there
    };
    struct Bands;

    void receive(const Message& message);
    void say_hello(const Hello& hello);
    void make_bands(const Session& session, std::uint32_t device);
    void make_band(std::uint32_t device, const Order& order, const BandMaker& make);
    std::optional<Order> next_order(std::uint32_t device);
    bool is_wanted(PictureNumber picture);
    void wait_for_end();
    void stop();

    Post& post_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<PictureNumber, std::shared_ptr<const ShownPicture>> pictures_;
    /// Pictures that were ended before they came, because they come through other ranks.
    std::set<PictureNumber> ended_early_;
    std::map<std::uint32_t, std::deque<Order>> orders_;  ///< by device
    bool has_ended_ = false;                             ///< no more bands are wanted
    bool may_leave_ = false;
};

}  // namespace nearlight::core
