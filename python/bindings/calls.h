// SPDX-License-Identifier: Apache-2.0
// How Python's calls run the library: without the GIL, with messages, Ctrl-C and callbacks.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <optional>
#include <type_traits>
#include <utility>

#include "python/bindings/device_turns.h"

namespace nearlight::python {

namespace py = pybind11;

/// Collects the library's messages from now on.
void collect_messages();
/// Hands the messages so far to Python's logger `nearlight`. The library sends them from any thread, and a
/// thread that has to wait for the GIL there could wait for ever; so they wait in a list until a call ends or
/// tells its progress.
void deliver_messages();

/// Runs library code, then hands its messages on, whether it failed or not.
template <typename Work>
auto with_messages(Work&& work) {
    using Result = std::invoke_result_t<Work>;
    if constexpr (std::is_void_v<Result>) {
        with_messages([&] {
            work();
            return true;
        });
    } else {
        std::optional<Result> result;
        std::exception_ptr failure;
        try {
            result.emplace(work());
        } catch (...) {
            failure = std::current_exception();
        }
        deliver_messages();
        if (failure) {
            std::rethrow_exception(failure);
        }
        return std::move(*result);
    }
}

/// The same without the GIL.
template <typename Work>
auto without_gil(Work&& work) {
    return with_messages([&] {
        const py::gil_scoped_release released;
        return work();
    });
}

/// The same, in a turn on devices.
template <typename Work>
auto in_turn(DeviceTurns& turns, Work&& work) {
    const Turn turn(turns);
    return without_gil(std::forward<Work>(work));
}

/// A callback for progress. It stops the work if the Python function returns False or raises, and if Ctrl-C
/// comes. What was raised is kept for rethrow().
class ProgressCall {
  public:
    explicit ProgressCall(py::object function);
    /// Called by the library, without the GIL.
    bool operator()(double fraction);
    /// Called with the GIL when the work is done.
    void rethrow() const;

  private:
    py::object function_;
    std::exception_ptr raised_;
};

}  // namespace nearlight::python
