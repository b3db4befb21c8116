// SPDX-License-Identifier: Apache-2.0
#include "viewer/tev_sender.h"

#include <utility>

namespace nearlight::viewer {

TevSender::TevSender(const std::string& address, std::string name)
    : link_(address),
      name_(std::move(name)),
      thread_([this](const std::stop_token& stopping) { run(stopping); }) {}

void TevSender::send(Image image) {
    {
        const std::lock_guard lock(mutex_);
        waiting_ = std::move(image);
    }
    changed_.notify_one();
}

std::string TevSender::error() const {
    const std::lock_guard lock(mutex_);
    return error_;
}

void TevSender::run(const std::stop_token& stopping) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stopping, [this] { return waiting_.has_value(); })) {
        const Image image = *std::exchange(waiting_, std::nullopt);
        lock.unlock();
        std::string error;
        try {
            link_.show(name_, image);
        } catch (const std::exception& exception) {
            error = exception.what();
        }
        lock.lock();
        if (!error.empty()) {
            error_ = std::move(error);
            return;
        }
    }
}

}  // namespace nearlight::viewer
