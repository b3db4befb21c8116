// SPDX-License-Identifier: Apache-2.0
// A device that work is sent to: its context, in-order queue, profiler and programs.
#pragma once

#include <CL/opencl.hpp>
#include <atomic>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/cl/devices/device_list.h"
#include "host/cl/devices/tunables.h"
#include "host/cl/profiler.h"

namespace nearlight::core {

class ProgramCompiler;

struct DeviceOptions {
    /// Kernels are read from this folder; if it is empty, those in the binary are used.
    std::filesystem::path kernel_dir;
    /// Compiled programs and tunables are kept in this folder; empty means default_cache_dir(), "none" keeps
    /// nothing.
    std::filesystem::path cache_dir;
    /// Whether single rays use the wide tree; unset means on CPUs only. Other choices are for tests and
    /// comparisons.
    std::optional<bool> wide_rays{};
    /// Compiles programs for this device; null gives it one of its own. Devices of a kind that share one
    /// compile each program once.
    std::shared_ptr<ProgramCompiler> compiler{};
};

/// The first of $NEARLIGHT_CACHE_DIR, $XDG_CACHE_HOME/nearlight and ~/.cache/nearlight whose variable is set;
/// empty if there is no home.
std::filesystem::path default_cache_dir();

/// A device that work is sent to through one in-order queue. It cannot be copied, because stages hold
/// references to it. For one thread at a time.
class Device {
  public:
    explicit Device(const DeviceEntry& entry, const DeviceOptions& options = {});
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceEntry& entry() const { return entry_; }
    [[nodiscard]] const std::string& name() const { return entry_.name; }
    [[nodiscard]] bool is_cpu() const { return entry_.kind == DeviceKind::cpu; }
    /// Whether kernels that trace one ray at a time use the wide tree (kernels/lib/ray_tree.cl).
    [[nodiscard]] bool has_wide_rays() const { return options_.wide_rays.value_or(is_cpu()); }
    [[nodiscard]] const DeviceOptions& options() const { return options_; }
    [[nodiscard]] const cl::Context& context() const { return context_; }
    [[nodiscard]] const cl::CommandQueue& queue() const { return queue_; }
    [[nodiscard]] Profiler& profiler() { return profiler_; }

    /// How stages divide their work: the values of choose_tunables() unless set_tunables() replaced them.
    [[nodiscard]] const Tunables& tunables() const { return tunables_.values; }
    [[nodiscard]] const ChosenTunables& chosen_tunables() const { return tunables_; }
    /// Sets the tunables for stages that are made from now on, and for the launches of all stages.
    void set_tunables(const Tunables& tunables) { tunables_ = {tunables, "set by the program", false, {}}; }
    /// The number of work-items for kernels that give each a long run of elements (scan, sort).
    [[nodiscard]] std::size_t worker_count() const;

    /// Begins to build a program from `source`, the expanded text of kernels/`file`, or returns the same
    /// program begun earlier, if that has not failed.
    std::shared_future<cl::Program> start_build(const std::string& file, std::string source,
                                                std::string options);
    [[nodiscard]] ProgramCompiler& compiler() const { return *options_.compiler; }

    /// Waits for all enqueued work. Throws errors of that work too.
    void finish();

    /// Counts the bytes of a new Buffer, and keeps the maximum for peak_bytes(). Buffers may end in any
    /// thread, so all three are for several threads at a time.
    void add_allocated(std::size_t bytes);
    void remove_allocated(std::size_t bytes) { allocated_bytes_ -= bytes; }
    /// The maximum total size of all live Buffers so far, in bytes.
    [[nodiscard]] std::size_t peak_bytes() const { return peak_bytes_; }

  private:
    DeviceEntry entry_;
    DeviceOptions options_;
    ChosenTunables tunables_;
    cl::Context context_;
    cl::CommandQueue queue_;
    Profiler profiler_;
    std::map<std::string, std::shared_future<cl::Program>> programs_;  ///< by their keys, for start_build()
    std::atomic<std::size_t> allocated_bytes_ = 0;
    std::atomic<std::size_t> peak_bytes_ = 0;
};

/// Opens one or more devices, which share options.compiler, or a new one if that is null. Devices that do not
/// start are left out with a warning. Throws the last one's error if no device starts.
std::vector<std::unique_ptr<Device>> open_devices(std::span<const DeviceEntry> entries,
                                                  const DeviceOptions& options);

}  // namespace nearlight::core
