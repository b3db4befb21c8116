// SPDX-License-Identifier: Apache-2.0
#include "viewer/tev_sender.h"

#include <utility>

#include "viewer/channels.h"

namespace nearlight::viewer {

TevSender::TevSender(const std::string& address, std::string name)
    : link_(address),
      name_(std::move(name)),
      thread_([this](const std::stop_token& stopping) { run(stopping); }) {}

void TevSender::send(std::shared_ptr<const Frame> frame) {
    {
        const std::lock_guard lock(mutex_);
        waiting_ = std::move(frame);
    }
    changed_.notify_one();
}

std::string TevSender::error() const {
    const std::lock_guard lock(mutex_);
    return error_;
}

void TevSender::run(const std::stop_token& stopping) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stopping, [this] { return waiting_ != nullptr; })) {
        const std::shared_ptr<const Frame> frame = std::exchange(waiting_, nullptr);
        lock.unlock();
        std::string error;
        try {
            link_.show(name_, with_file_layers(frame->image));
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
