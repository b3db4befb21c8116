// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/tunables.h"

#include <algorithm>
#include <array>
#include <bit>

namespace nearlight::core {
namespace {

constexpr std::array kFields{
    TunableField{"beam_width", &Tunables::beam_width, 16, 256, true},
    TunableField{"local_size", &Tunables::local_size, 1, 256, true},
    TunableField{"run_local_size", &Tunables::run_local_size, 1, 256, true},
    TunableField{"bundle_local_size", &Tunables::bundle_local_size, 1, 256, true},
    TunableField{"runs_per_unit", &Tunables::runs_per_unit, 1, 1024, false},
    TunableField{"shortest_run", &Tunables::shortest_run, 16, 1u << 20u, false},
    TunableField{"shortest_sort_run", &Tunables::shortest_sort_run, 16, 1u << 20u, false},
    TunableField{"roulette_run", &Tunables::roulette_run, 1, 4096, false},
    TunableField{"launch_bundles", &Tunables::launch_bundles, 1, 1u << 20u, false},
    TunableField{"launch_items", &Tunables::launch_items, 1, ~0u, false},
    TunableField{"launch_ms", &Tunables::launch_ms, 1, 2000, false},
    TunableField{"batch_receivers", &Tunables::batch_receivers, 1u << 10u, 1u << 24u, false},
};

/// On CPUs one thread runs a work-group, so work-items are few and long, with several per core to balance the
/// load. A launch takes more VPLs rather than more bundles, because each bundle costs time to start. No
/// driver of a CPU stops a launch that takes long. GPUs need enough work-items to fill their lanes, also
/// where an item is a bundle of 256 receivers.
constexpr Tunables kCpu{.beam_width = 256,
                        .local_size = 8,
                        .run_local_size = 1,
                        .bundle_local_size = 1,
                        .runs_per_unit = 4,
                        .shortest_run = 1024,
                        .shortest_sort_run = 4096,
                        .roulette_run = 64,
                        .launch_bundles = 256,
                        .launch_items = ~0u,
                        .launch_ms = 200,
                        .batch_receivers = 1u << 18u};
constexpr Tunables kGpu{.beam_width = 256,
                        .local_size = 64,
                        .run_local_size = 64,
                        .bundle_local_size = 64,
                        .runs_per_unit = 128,
                        .shortest_run = 32,
                        .shortest_sort_run = 256,
                        .roulette_run = 1,
                        .launch_bundles = 4096,
                        .launch_items = 1u << 16u,
                        .launch_ms = 200,
                        .batch_receivers = 1u << 23u};

constexpr std::array kTable{
    TunablesRow{"CPUs", DeviceKind::cpu, kCpu},
    TunablesRow{"GPUs", DeviceKind::gpu, kGpu},
    TunablesRow{"other devices", DeviceKind::other, kGpu},
};

}  // namespace

bool TunableField::allows(std::uint32_t x) const {
    return x >= min && x <= max && (!is_power_of_two || std::has_single_bit(x));
}

std::span<const TunableField> tunable_fields() {
    return kFields;
}

const TunablesRow& tunables_row(DeviceKind kind) {
    return *std::ranges::find(kTable, kind, &TunablesRow::kind);
}

}  // namespace nearlight::core
