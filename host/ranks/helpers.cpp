// SPDX-License-Identifier: Apache-2.0
#include "host/ranks/helpers.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "host/ranks/service.h"

namespace nearlight::core {
namespace {

using namespace std::chrono_literals;

/// How often a waiting thread looks whether it is to stop.
constexpr auto kPatience = 100ms;

}  // namespace

Helpers::Helpers(Post& post) : post_(post), rank_count_(post.rank().count) {
    post_.open([this](int from, const Message& message) { receive(from, message); });
}

Helpers::~Helpers() {
    const auto say_to_all = [this](MessageKind kind) {
        for (int rank = 1; rank < rank_count_; ++rank) {
            post_.send(rank, Message({.kind = kind}));
        }
    };
    say_to_all(MessageKind::end_job);
    wait_for_goodbyes();
    say_to_all(post_.has_lost() ? MessageKind::break_up_job : MessageKind::leave_job);
    post_.close();
}

/// MPI would wait for ever for a rank that died when nobody waited for a band of it.
void Helpers::wait_for_goodbyes() {
    std::unique_lock lock(mutex_);
    for (int rank = 1; rank < rank_count_ && !post_.has_lost(); ++rank) {
        try {
            while (!changed_.wait_for(lock, kPatience, [&] { return goodbyes_.contains(rank); })) {
                post_.check_signs_of_life(rank, name_of(rank));
            }
        } catch (const Error&) {
            return;  // the post office knows that it is lost
        }
    }
}

std::string Helpers::name_of(int rank) const {
    const auto found = hellos_.find(rank);
    return "rank " + std::to_string(rank) +
           (found == hellos_.end() || found->second.host.empty() ? "" : " on " + found->second.host);
}

std::vector<Hello> Helpers::wait_until_ready() {
    std::unique_lock lock(mutex_);
    std::vector<Hello> result;
    for (int rank = 1; rank < rank_count_; ++rank) {
        while (!changed_.wait_for(lock, kPatience, [&] { return hellos_.contains(rank); })) {
            post_.check_signs_of_life(rank, name_of(rank));
        }
        const Hello& hello = hellos_[rank];
        if (hello.failure) {
            throw Error(hello.failure->kind(), name_of(rank) + ": " + hello.failure->what());
        }
        for (const RemoteDevice& device : hello.devices) {
            devices_.push_back({.rank = rank, .number = device.number});
        }
        result.push_back(hello);
    }
    return result;
}

RemoteDevices Helpers::devices() {
    RemoteDevices remote{
        .devices = {},
        .show = [this](const PictureTask& picture, std::span<const Vpl> vpls) { return show(picture, vpls); },
        .order =
            [this](PictureNumber picture, std::size_t device, uint band) {
                order({picture, device, band});
            },
        .fetch =
            [this](PictureNumber picture, std::size_t device, uint band, const WorkProgress& progress) {
                return fetch({picture, device, band}, progress);
            },
        .end = [this](PictureNumber picture) { end(picture); }};
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < devices_.size(); ++i) {
        const RemoteDevice& device = hellos_[devices_[i].rank].devices[devices_[i].number];
        remote.devices.push_back({.number = i,
                                  .name = name_of(devices_[i].rank) + ": " + device.name,
                                  .batch_receivers = device.batch_receivers});
    }
    return remote;
}

PictureNumber Helpers::show(const PictureTask& picture, std::span<const Vpl> vpls) {
    const PictureNumber number = [this] {
        const std::lock_guard lock(mutex_);
        return ++shown_;
    }();
    const Message message({.kind = MessageKind::picture, .picture = number},
                          {part_of(std::span(&picture, 1)), part_of(vpls)});
    pass_on(post_, message);
    return number;
}

void Helpers::order(const Key& key) {
    const auto& [picture, device, band] = key;
    {
        const std::lock_guard lock(mutex_);
        if (!ordered_.emplace(key, 0.0).second) {
            return;
        }
    }
    post_.send(devices_[device].rank, Message({.kind = MessageKind::order,
                                               .device = static_cast<std::uint32_t>(devices_[device].number),
                                               .picture = picture,
                                               .band = band}));
}

std::optional<FinishedBand> Helpers::fetch(const Key& key, const WorkProgress& progress) {
    order(key);
    const Device& device = devices_[std::get<1>(key)];
    std::unique_lock lock(mutex_);
    for (;;) {
        Answer& answer = ordered_.at(key);
        if (auto* const band = std::get_if<FinishedBand>(&answer)) {
            FinishedBand result = std::move(*band);
            ordered_.erase(key);
            return result;
        }
        if (device.failure) {
            throw Error(*device.failure);
        }
        // Without the ranks that pass pictures on to it, a rank has nothing to do.
        for (int rank = device.rank; rank > 0; rank = relay_of(rank)) {
            post_.check_signs_of_life(rank, name_of(rank));
        }
        const double fraction = std::get<double>(answer);
        lock.unlock();
        const bool goes_on = progress(fraction);
        lock.lock();
        if (!goes_on) {
            return std::nullopt;
        }
        changed_.wait_for(lock, kPatience, [&] {
            return device.failure || std::holds_alternative<FinishedBand>(ordered_.at(key));
        });
    }
}

void Helpers::end(PictureNumber picture) {
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(ordered_, [&](const auto& item) { return std::get<0>(item.first) == picture; });
    }
    for (int rank = 1; rank < rank_count_; ++rank) {
        post_.send(rank, Message({.kind = MessageKind::end_picture, .picture = picture}));
    }
}

void Helpers::receive(int from, const Message& message) {
    {
        const std::lock_guard lock(mutex_);
        if (message.head().kind == MessageKind::hello) {
            hellos_[from] = parse_hello(message.text());
        } else if (message.head().kind == MessageKind::goodbye) {
            goodbyes_.insert(from);
        } else {
            take_answer(from, message);
        }
    }
    changed_.notify_all();
}

/// Takes what a rank says of a band or a device. Nobody waits any more for bands of ended pictures.
void Helpers::take_answer(int from, const Message& message) {
    const MessageHead head = message.head();
    const auto device = std::ranges::find_if(
        devices_, [&](const Device& one) { return one.rank == from && one.number == head.device; });
    if (device == devices_.end()) {
        return;
    }
    if (head.kind == MessageKind::failed) {
        device->failure.emplace(head.error, message.text());
        return;
    }
    const auto found =
        ordered_.find({head.picture, static_cast<std::size_t>(device - devices_.begin()), head.band});
    if (found == ordered_.end()) {
        return;
    }
    if (head.kind == MessageKind::band) {
        found->second = FinishedBand{.rows = message.body<float>(), .local_lights = head.local_lights};
    } else {
        found->second = head.fraction;
    }
}

}  // namespace nearlight::core
