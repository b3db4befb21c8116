// SPDX-License-Identifier: Apache-2.0
// The other ranks of a job, as the leading rank sees them.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "host/ranks/hello.h"
#include "host/ranks/post.h"
#include "host/session/remote_devices.h"

namespace nearlight::core {

class Helpers {
  public:
    /// Keeps a reference to `post`, whose messages it receives.
    explicit Helpers(Post& post);
    /// Ends the job of all helpers, and waits until they have heard of it or are lost.
    ~Helpers();
    Helpers(const Helpers&) = delete;
    Helpers& operator=(const Helpers&) = delete;

    /// Waits until each rank has said that it is ready; the first element is rank 1. Throws the Error of a
    /// rank that is not ready, with its number and host, and Error(ErrorKind::failure) if one is lost.
    [[nodiscard]] std::vector<Hello> wait_until_ready();

    /// The devices of all helpers, once they are ready. Keeps a reference to this object.
    [[nodiscard]] RemoteDevices devices();

  private:
    /// A picture's number, the number of a device and that of a band.
    using Key = std::tuple<PictureNumber, std::size_t, uint>;
    /// How far an ordered band is, or the band.
    using Answer = std::variant<double, FinishedBand>;
    struct Device {
        int rank = 0;
        std::size_t number = 0;  ///< among those of the rank
        std::optional<Error> failure{};
    };

    PictureNumber show(const PictureTask& picture, std::span<const Vpl> vpls);
    void order(const Key& key);
    std::optional<FinishedBand> fetch(const Key& key, const WorkProgress& progress);
    void end(PictureNumber picture);
    void wait_for_goodbyes();
    void receive(int from, const Message& message);
    void take_answer(int from, const Message& message);
    [[nodiscard]] std::string name_of(int rank) const;

    Post& post_;
    const int rank_count_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<int, Hello> hellos_;
    std::set<int> goodbyes_;
    std::vector<Device> devices_;
    std::map<Key, Answer> ordered_;
    PictureNumber shown_ = 0;  ///< number of pictures so far
};

}  // namespace nearlight::core
