// SPDX-License-Identifier: Apache-2.0
#include "host/ranks/service.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "host/base/message.h"
#include "host/base/stopwatch.h"

namespace nearlight::core {
namespace {

/// Enough for a progress bar.
constexpr double kProgressSeconds = 0.25;

}  // namespace

void pass_on(Post& post, const Message& picture) {
    const Rank& rank = post.rank();
    for (int to = rank.number + 1; to < rank.count; ++to) {
        if (relay_of(to) == rank.number) {
            post.send(to, picture);
        }
    }
}

Service::Service(Post& post) : post_(post) {
    post_.open([this](int, const Message& message) {
        if (message.head().kind == MessageKind::picture) {
            pass_on(post_, message);
        }
        receive(message);
    });
}

void Service::say_hello(const Hello& hello) {
    post_.send(0, Message({.kind = MessageKind::hello}, {part_of(to_text(hello))}));
}

void Service::refuse(const Error& failure) {
    say_hello({.host = post_.rank().host, .facts = {}, .devices = {}, .failure = failure});
    wait_for_end();
}

void Service::run(const Session& session, const std::string& facts) {
    const std::vector<RemoteDevice> devices = session.own_devices();
    std::vector<std::jthread> threads;
    try {
        for (std::uint32_t device = 0; device < devices.size(); ++device) {
            threads.emplace_back([this, &session, device] { make_bands(session, device); });
        }
        say_hello({.host = post_.rank().host, .facts = facts, .devices = devices});
    } catch (...) {
        stop();  // so that the threads can be joined
        throw;
    }
    wait_for_end();
}

void Service::stop() {
    {
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
    }
    changed_.notify_all();
}

void Service::wait_for_end() {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, std::chrono::seconds(1), [this] { return may_leave_; })) {
        try {
            post_.check_signs_of_life(0, "rank 0");
        } catch (const Error&) {
            has_ended_ = true;  // so that devices stop
            changed_.notify_all();
            throw;
        }
    }
}

void Service::receive(const Message& message) {
    const MessageHead head = message.head();
    const std::lock_guard lock(mutex_);
    switch (head.kind) {
        case MessageKind::picture:
            if (ended_early_.erase(head.picture) == 0) {
                pictures_[head.picture] = std::make_shared<const ShownPicture>(ShownPicture{
                    message.first<PictureTask>(), VplBuffer(message.body<Vpl>(sizeof(PictureTask)))});
            }
            break;
        case MessageKind::order:
            orders_[head.device].push_back({.picture = head.picture, .band = head.band});
            break;
        case MessageKind::end_picture:
            if (pictures_.erase(head.picture) == 0) {
                ended_early_.insert(head.picture);
            }
            for (auto& [device, orders] : orders_) {
                std::erase_if(orders, [&](const Order& order) { return order.picture == head.picture; });
            }
            break;
        case MessageKind::end_job:
            has_ended_ = true;
            post_.send(0, Message({.kind = MessageKind::goodbye}));
            break;
        case MessageKind::break_up_job:
            post_.break_up();
            has_ended_ = may_leave_ = true;
            break;
        case MessageKind::leave_job:
            may_leave_ = true;
            break;
        default:
            break;
    }
    changed_.notify_all();
}

bool Service::is_wanted(PictureNumber picture) {
    const std::lock_guard lock(mutex_);
    return !has_ended_ && pictures_.contains(picture);
}

/// Waits for an order and its picture. Returns nothing at the end of the job.
std::optional<Service::Order> Service::next_order(std::uint32_t device) {
    std::unique_lock lock(mutex_);
    std::deque<Order>& orders = orders_[device];
    changed_.wait(
        lock, [&] { return has_ended_ || (!orders.empty() && pictures_.contains(orders.front().picture)); });
    if (has_ended_) {
        return std::nullopt;
    }
    Order order = orders.front();
    orders.pop_front();
    order.shown = pictures_.at(order.picture);
    return order;
}

/// What makes the bands of a picture on a device. Members refer to those before them.
struct Service::Bands {
    PictureNumber number;
    std::shared_ptr<const ShownPicture> shown;
    BandMaker make;
};

/// Makes what is ordered of a device, in a thread of its own, until it fails or the job ends.
void Service::make_bands(const Session& session, std::uint32_t device) {
    std::optional<Bands> bands;
    std::optional<Stopwatch> since_first;
    Stopwatch watch;
    double busy = 0.0;
    uint made = 0;
    const auto fail = [&](ErrorKind kind, const std::string& text) {
        post_.send(0,
                   Message({.kind = MessageKind::failed, .device = device, .error = kind}, {part_of(text)}));
    };
    try {
        while (const std::optional<Order> order = next_order(device)) {
            since_first = since_first ? since_first : Stopwatch();
            watch.lap();
            if (!bands || bands->number != order->picture) {
                bands.reset();  // the device's memory may not do for both
                const ShownPicture& shown = *order->shown;
                bands =
                    Bands{order->picture, order->shown, session.helper(device, shown.picture, shown.vpls)};
            }
            make_band(device, *order, bands->make);
            busy += watch.lap();
            say_debug("band " + std::to_string(++made) + " of device " + std::to_string(device) +
                      ": busy for " + std::to_string(busy) + " s of " +
                      std::to_string(since_first->seconds()) + " s");
        }
    } catch (const Error& error) {
        fail(error.kind(), error.what());
    } catch (const std::exception& error) {
        fail(ErrorKind::failure, error.what());
    }
}

void Service::make_band(std::uint32_t device, const Order& order, const BandMaker& make) {
    Stopwatch since_told;
    MessageHead head{
        .kind = MessageKind::progress, .device = device, .picture = order.picture, .band = order.band};
    const std::optional<FinishedBand> band = make(order.band, [&](double fraction) {
        if (since_told.seconds() > kProgressSeconds) {
            since_told = Stopwatch();
            head.fraction = fraction;
            post_.send(0, Message(head));
        }
        return is_wanted(order.picture);
    });
    if (band) {
        head.kind = MessageKind::band;
        head.local_lights = band->local_lights;
        post_.send(0, Message(head, {part_of(band->rows)}));
    }
}

}  // namespace nearlight::core
