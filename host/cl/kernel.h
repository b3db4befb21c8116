// SPDX-License-Identifier: Apache-2.0
// A kernel entry point with typed launching.
#pragma once

#include <CL/opencl.hpp>
#include <optional>
#include <string>
#include <type_traits>

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

    /// Launches `item_count` work-items in work-groups of `local_size`, or of fewer where the device has not
    /// that many for this kernel. The last group may exceed `item_count`, so the kernel checks its index.
    /// Arguments are Buffers, LocalMemory, groups of these and plain values, in the kernel's order.
    template <typename... Arguments>
    void launch(std::size_t item_count, std::size_t local_size, const Arguments&... arguments) {
        if (item_count > 0) {
            set_all_arguments(arguments...);
            enqueue({0, item_count}, fitting(local_size));
        }
    }
    /// Launches `item_count` independent work-items in work-groups of the device's usual size
    /// (Tunables::local_size), in parts where they are many (Tunables::launch_items).
    template <typename... Arguments>
    void launch_items(std::size_t item_count, const Arguments&... arguments) {
        if (item_count > 0) {
            set_all_arguments(arguments...);
            enqueue_parts(item_count, fitting(program_.device().tunables().local_size));
        }
    }
    /// Launches one work-group for each bundle of receivers, whose work-items divide it among them
    /// (Tunables::bundle_local_size), in parts where they are many. The index of a bundle is that of the
    /// group plus the global offset ÷ the size of a group, because indices of groups begin at 0 in each part.
    template <typename... Arguments>
    void launch_bundles(std::size_t bundle_count, const Arguments&... arguments) {
        if (bundle_count > 0) {
            set_all_arguments(arguments...);
            const std::size_t local_size = fitting(program_.device().tunables().bundle_local_size);
            enqueue_parts(bundle_count * local_size, local_size);
        }
    }

  private:
    /// Work-items `first` to `first` + `count` − 1.
    struct Items {
        std::size_t first, count;
    };

    /// Waits for the compiler.
    void open();
    /// The size of work-groups nearest to `local_size` that the device has for this kernel.
    [[nodiscard]] std::size_t fitting(std::size_t local_size) const;
    void enqueue(Items items, std::size_t local_size);
    void enqueue_parts(std::size_t item_count, std::size_t local_size);
    [[nodiscard]] std::string description() const;

    template <typename... Arguments>
    void set_all_arguments(const Arguments&... arguments) {
        if (!handle_) {
            open();
        }
        with_opencl_errors(description(), [&] {
            cl_uint index = 0;
            (set_arguments(index, arguments), ...);
        });
    }
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
    std::size_t max_local_size_ = 0;      ///< of a work-group of this kernel on its device; set likewise
    std::size_t part_items_ = 0;          ///< work-items for the next part of a launch; 0 before the first
};

}  // namespace nearlight::core
