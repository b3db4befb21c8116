// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/device_turns.h"

#include <chrono>

#include "nearlight/error.h"

namespace nearlight::python {

namespace py = pybind11;

void DeviceTurns::begin() {
    constexpr std::chrono::milliseconds kBetweenSignals{100};
    const std::thread::id self = std::this_thread::get_id();
    bool has_it_already = false;
    while (!has_it_already) {
        {
            const py::gil_scoped_release released;
            std::unique_lock lock(guard_);
            has_it_already = is_taken_ && by_ == self;
            if (!has_it_already && is_free_.wait_for(lock, kBetweenSignals, [&] { return !is_taken_; })) {
                is_taken_ = true;
                by_ = self;
                return;
            }
        }
        if (PyErr_CheckSignals() != 0) {
            throw py::error_already_set();
        }
    }
    throw Error(ErrorKind::invalid_argument,
                "the devices are at work in this thread; a callback for progress cannot use a session");
}

void DeviceTurns::end() {
    // While leftovers are destroyed, other threads may leave more. The turn ends in the same moment in which
    // none is left, because nobody else would destroy what is left after that.
    std::vector<std::shared_ptr<void>> leftovers;
    do {
        leftovers.clear();
        const std::scoped_lock lock(guard_);
        leftovers.swap(leftovers_);
        is_taken_ = !leftovers.empty();
    } while (!leftovers.empty());
    is_free_.notify_one();
}

void DeviceTurns::dispose(std::shared_ptr<void> product) {
    {
        const std::scoped_lock lock(guard_);
        if (is_taken_) {
            leftovers_.push_back(std::move(product));
            return;
        }
        is_taken_ = true;
        by_ = std::this_thread::get_id();
    }
    product.reset();
    end();
}

}  // namespace nearlight::python
