// SPDX-License-Identifier: Apache-2.0
// A device that work is sent to: context, in-order queue, profiler, and where its programs come from.
#pragma once

#include <CL/opencl.hpp>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "host/cl/devices/device_list.h"
#include "host/cl/devices/tunables.h"
#include "host/cl/profiler.h"

namespace nearlight::core {

class ProgramCompiler;

struct DeviceOptions {
    /// Kernels are read from here where set, else from the binary.
    std::filesystem::path kernel_dir;
    /// Compiled programs and tunables are kept here; empty: default_cache_dir(). "none" keeps nothing.
    std::filesystem::path cache_dir;
    /// Single rays go through the wide tree; unset: on CPUs. (The other form is for tests and comparisons.)
    std::optional<bool> wide_rays{};
    /// Compiles for this device; empty: one of its own. Devices of a kind that share one compile once.
    std::shared_ptr<ProgramCompiler> compiler{};
};

/// $NEARLIGHT_CACHE_DIR, or $XDG_CACHE_HOME/nearlight, or ~/.cache/nearlight; empty where there is no home.
std::filesystem::path default_cache_dir();

/// Not copyable: stages hold a reference to it. All work goes through one in-order queue. For one thread at a
/// time.
class Device {
  public:
    explicit Device(const DeviceEntry& entry, const DeviceOptions& options = {});
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceEntry& entry() const { return entry_; }
    [[nodiscard]] const std::string& name() const { return entry_.name; }
    [[nodiscard]] bool is_cpu() const { return entry_.kind == DeviceKind::cpu; }
    /// Which tree kernels take that trace one ray (kernels/lib/ray_tree.cl).
    [[nodiscard]] bool has_wide_rays() const { return options_.wide_rays.value_or(is_cpu()); }
    [[nodiscard]] const DeviceOptions& options() const { return options_; }
    [[nodiscard]] const cl::Context& context() const { return context_; }
    [[nodiscard]] const cl::CommandQueue& queue() const { return queue_; }
    [[nodiscard]] Profiler& profiler() { return profiler_; }

    /// How stages divide their work; those of choose_tunables() unless set.
    [[nodiscard]] const Tunables& tunables() const { return tunables_.values; }
    [[nodiscard]] const ChosenTunables& chosen_tunables() const { return tunables_; }
    /// For stages made from now on, and for launches of all.
    void set_tunables(const Tunables& tunables) { tunables_ = {tunables, "set by the program", false, {}}; }
    /// How many work-items a kernel should have that gives each a long run of elements (scan, sort).
    [[nodiscard]] std::size_t worker_count() const;

    /// Begins to build a program from expanded `source` of kernels/`file`, or gives the one begun before.
    std::shared_future<cl::Program> start_build(const std::string& file, std::string source,
                                                std::string options);
    [[nodiscard]] ProgramCompiler& compiler() const { return *options_.compiler; }

    /// Waits for everything enqueued; asynchronous failures surface here.
    void finish();

    /// Bytes of all live Buffers, and the most there ever were.
    void add_allocated(std::size_t bytes);
    void remove_allocated(std::size_t bytes) { allocated_bytes_ -= bytes; }
    [[nodiscard]] std::size_t peak_bytes() const { return peak_bytes_; }

  private:
    DeviceEntry entry_;
    DeviceOptions options_;
    ChosenTunables tunables_;
    cl::Context context_;
    cl::CommandQueue queue_;
    Profiler profiler_;
    std::map<std::string, std::shared_future<cl::Program>> programs_;  ///< by their keys
    std::size_t allocated_bytes_ = 0;
    std::size_t peak_bytes_ = 0;
};

}  // namespace nearlight::core
