// SPDX-License-Identifier: Apache-2.0
// Turns on devices: sessions that share devices are for one thread at a time, and Python has many.
#pragma once

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace nearlight::python {

/// Gives devices to one thread at a time. It also ends what lives on the devices, when nobody works there.
class DeviceTurns {
  public:
    /// Waits until no other thread has the devices; the caller holds the GIL, which is released meanwhile.
    /// Throws KeyboardInterrupt if Ctrl-C comes, and Error(ErrorKind::invalid_argument) if the calling thread
    /// has the devices already, as a callback for progress does.
    void begin();
    /// Ends the turn that the thread has. Needs no GIL.
    void end();
    /// Ends `product` now, or if a thread has the devices, when that is done.
    void dispose(std::shared_ptr<void> product);

  private:
    std::mutex guard_;  ///< is held for moments only, never while the GIL is awaited
    std::condition_variable is_free_;
    bool is_taken_ = false;
    std::thread::id by_;
    std::vector<std::shared_ptr<void>> leftovers_;
};

/// A turn for as long as this lives.
class Turn {
  public:
    explicit Turn(DeviceTurns& turns) : turns_(turns) { turns_.begin(); }
    ~Turn() { turns_.end(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

  private:
    DeviceTurns& turns_;
};

/// A Session, View or VplSet as Python's objects have it: it ends between turns.
template <typename Product>
class OnDevices {
  public:
    OnDevices(Product product, std::shared_ptr<DeviceTurns> turns)
        : product_(std::make_shared<Product>(std::move(product))), turns_(std::move(turns)) {}
    ~OnDevices() {
        if (turns_) {
            turns_->dispose(std::move(product_));
        }
    }
    OnDevices(OnDevices&&) noexcept = default;
    OnDevices& operator=(OnDevices&&) = delete;

    [[nodiscard]] Product& get() const { return *product_; }
    [[nodiscard]] const std::shared_ptr<DeviceTurns>& turns() const { return turns_; }

  private:
    std::shared_ptr<Product> product_;
    std::shared_ptr<DeviceTurns> turns_;
};

}  // namespace nearlight::python
