// SPDX-License-Identifier: Apache-2.0
// How work is divided for a device. Only speed depends on it, because every division gives the same bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "host/cl/devices/device_list.h"

namespace nearlight::core {

struct Tunables {
    std::uint32_t beam_width;         ///< receivers that gather_packets takes through the tree together
    std::uint32_t local_size;         ///< work-group size of kernels whose work-items are independent
    std::uint32_t run_local_size;     ///< work-group size of kernels with runs (host/stages/runs.h)
    std::uint32_t bundle_local_size;  ///< work-items that divide a bundle of receivers among them
    std::uint32_t runs_per_unit;      ///< number of runs per compute unit of the device
    std::uint32_t shortest_run;       ///< minimum number of elements in a run
    std::uint32_t shortest_sort_run;  ///< minimum number of elements in a run that costs a histogram
    std::uint32_t roulette_run;       ///< VPLs per work-item that computes bounds for Russian roulette
    std::uint32_t launch_bundles;     ///< maximum number of bundles (256 receivers) in a launch of a gather
    std::uint32_t launch_items;       ///< launches of more independent work-items are divided into parts
    std::uint32_t launch_ms;  ///< how long a launch of a gather, or a part, should take, in milliseconds
    std::uint32_t batch_receivers;  ///< maximum number of receivers in a batch of camera samples

    bool operator==(const Tunables&) const = default;
};

/// A member of Tunables with its name and its range.
struct TunableField {
    const char* name;
    std::uint32_t Tunables::*value;
    std::uint32_t min, max;
    bool is_power_of_two;

    [[nodiscard]] bool allows(std::uint32_t x) const;
};
std::span<const TunableField> tunable_fields();

/// The tunables that suit a kind of device.
struct TunablesRow {
    const char* name;
    DeviceKind kind;
    Tunables values;
};
/// The row of a kind of device in the table of tunables. The same values suit CPUs with vectors of 4, 8 and
/// 16 floats (bench/log/tunables.md).
const TunablesRow& tunables_row(DeviceKind kind);

/// The tunables of a device, and where they come from.
struct ChosenTunables {
    Tunables values;
    std::string source;  ///< text that names a row of the table or a file
    bool is_tuned = false;
    std::string warning;  ///< why an existing file was not used; empty if there is no such file
};

/// Returns the tunables that `nearlight tune` found for the device and its driver and stored in `cache_dir`,
/// or else those of the table. A file that is damaged or was made with other kernels is not used.
ChosenTunables choose_tunables(const DeviceEntry& entry, const std::filesystem::path& cache_dir,
                               const std::filesystem::path& kernel_dir);

/// The file that stores a device's tunables. It is empty if `cache_dir` is "" or "none", which keep nothing.
std::filesystem::path tunables_file(const DeviceEntry& entry, const std::filesystem::path& cache_dir);
/// Stores tunables for choose_tunables(). `kernels`, one or more, are the files under kernels/ that were
/// measured; if the text of any changes, the stored tunables are no longer used. Throws Error:
/// ErrorKind::file if the file cannot be written, ErrorKind::kernel_build if a kernel does not exist,
/// ErrorKind::invalid_argument if `cache_dir` keeps nothing.
void store_tunables(const Tunables& tunables, std::span<const std::string> kernels, const DeviceEntry& entry,
                    const std::filesystem::path& cache_dir, const std::filesystem::path& kernel_dir);

}  // namespace nearlight::core
