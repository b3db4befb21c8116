// SPDX-License-Identifier: Apache-2.0
// How work is divided for a device. Only speed depends on it: every division gives the same bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "host/cl/devices/device_list.h"

namespace nearlight::core {

struct Tunables {
    std::uint32_t beam_width;         ///< receivers that gather_packets takes through the tree together
    std::uint32_t local_size;         ///< work-group of kernels whose work-items are independent
    std::uint32_t run_local_size;     ///< the same where each has a run of elements (host/stages/chunks.h)
    std::uint32_t runs_per_unit;      ///< such runs for each compute unit of the device
    std::uint32_t shortest_run;       ///< elements of such a run, at least
    std::uint32_t shortest_sort_run;  ///< the same where a run costs a histogram
    std::uint32_t roulette_run;       ///< VPLs of a work-item that bounds them for the roulette
    std::uint32_t launch_bundles;     ///< of 256 receivers, of one launch of a gather, at most
    std::uint32_t launch_ms;          ///< how long such a launch should take, milliseconds
    std::uint32_t batch_receivers;    ///< that go from the camera pass to the film together, at most

    bool operator==(const Tunables&) const = default;
};

/// A member of Tunables, by name.
struct TunableField {
    const char* name;
    std::uint32_t Tunables::*value;
    std::uint32_t low, high;  ///< values that make sense
    bool is_power_of_two;

    [[nodiscard]] bool allows(std::uint32_t x) const;
};
std::span<const TunableField> tunable_fields();

/// What suits devices of a kind.
struct TunablesRow {
    const char* name;
    DeviceKind kind;
    Tunables values;
};
/// A row a kind. CPUs with vectors of 4, 8 and 16 floats want the same (bench/log/tunables.md).
std::span<const TunablesRow> tunables_table();
const TunablesRow& tunables_row(DeviceKind kind);

/// What a device is used with, and where that is from.
struct ChosenTunables {
    Tunables values;
    std::string source;  ///< for people: a row of the table, or a file
    bool is_tuned = false;
    std::string warning;  ///< why a file that is there was passed over; empty: there is none, or it was taken
};

/// Those that `nearlight tune` found for the device and its driver and stored in `cache_dir`, else the
/// table's. A file that is damaged, or was found with other kernels, is passed over.
ChosenTunables choose_tunables(const DeviceEntry& entry, const std::filesystem::path& cache_dir,
                               const std::filesystem::path& kernel_dir);

/// Where they are stored; empty where nothing is kept ("" and "none").
std::filesystem::path tunables_file(const DeviceEntry& entry, const std::filesystem::path& cache_dir);
/// `kernels` are the files under kernels/ that were measured, one at least: once the text of any has changed,
/// choose_tunables() passes the stored tunables over. Throws Error(ErrorKind::file) where they cannot be
/// written, Error(ErrorKind::kernel_build) where there is no such kernel, Error(ErrorKind::invalid_argument)
/// where nothing is kept.
void store_tunables(const Tunables& tunables, std::span<const std::string> kernels, const DeviceEntry& entry,
                    const std::filesystem::path& cache_dir, const std::filesystem::path& kernel_dir);

}  // namespace nearlight::core
