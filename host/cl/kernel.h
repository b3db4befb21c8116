// SPDX-License-Identifier: Apache-2.0
// A kernel entry point with typed launching.
#pragma once

#include <CL/opencl.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "host/base/division.h"
#include "host/cl/buffer.h"
#include "host/cl/program.h"

namespace nearlight::core {

/// An argument of a kernel that is memory of each work-group, without a value.
struct LocalMemory {
    std::size_t bytes;
};

class Kernel {
  public:
    /// Does not wait for the compiler. The first launch waits, and throws what Program::kernel() throws.
    Kernel(const Program& program, std::string name) : program_(program), name_(std::move(name)) {}

    /// Launches `item_count` work-items in work-groups of `local_size`. The last group may exceed
    /// `item_count`, so the kernel checks its index. Arguments are Buffers, LocalMemory, groups of these and
    /// plain values, in the kernel's order.
    template <typename... Arguments>
    void launch(std::size_t item_count, std::size_t local_size, const Arguments&... arguments) {
        if (item_count == 0) {
            return;
        }
        const std::size_t global_size = round_up_to_multiple(item_count, local_size);
        if (!handle_) {
            handle_ = program_.kernel(name_);
        }
        Device& device = program_.device();
        with_opencl_errors("kernel " + name_ + " on device " + device.name(), [&] {
            cl_uint index = 0;
            (set_arguments(index, arguments), ...);
            cl::Event event;
            device.queue().enqueueNDRangeKernel(*handle_, cl::NullRange, cl::NDRange(global_size),
                                                cl::NDRange(local_size), nullptr, &event);
            device.profiler().record(name_, std::move(event));
        });
    }
    /// Launches `item_count` work-items in work-groups of the device's usual size (Tunables::local_size).
    template <typename... Arguments>
    void launch_items(std::size_t item_count, const Arguments&... arguments) {
        launch(item_count, program_.device().tunables().local_size, arguments...);
    }
    /// Launches one work-group for each bundle of receivers, whose work-items divide it among them
    /// (Tunables::bundle_local_size).
    template <typename... Arguments>
    void launch_bundles(std::size_t bundle_count, const Arguments&... arguments) {
        const std::size_t local_size = program_.device().tunables().bundle_local_size;
        launch(bundle_count * local_size, local_size, arguments...);
    }

  private:
    template <typename T>
    void set_arguments(cl_uint& index, const Buffer<T>& buffer) {
        if (buffer.handle()() == nullptr) {
            throw Error(ErrorKind::failure, "kernel " + name_ + ": argument " + std::to_string(index) +
                                                " is a buffer that was never made; upload the data for it");
        }
        handle_->setArg(index++, buffer.handle());
    }
    /// Sets the buffers of a group, such as a DeviceScene, which visits them in the kernel's order.
    template <typename T>
    requires requires(const T& group) {
        group.for_each_buffer([](const auto&) {});
    }
    void set_arguments(cl_uint& index, const T& group) {
        group.for_each_buffer([&](const auto& buffer) { set_arguments(index, buffer); });
    }
    void set_arguments(cl_uint& index, const LocalMemory& memory) {
        handle_->setArg(index++, cl::Local(memory.bytes));
    }
    template <typename T>
    void set_arguments(cl_uint& index, const T& value) {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool> && !std::is_pointer_v<T>);
        handle_->setArg(index++, value);
    }

    Program program_;
    std::string name_;
    std::optional<cl::Kernel> handle_{};  ///< set by the first launch
};

}  // namespace nearlight::core
