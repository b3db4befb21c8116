// SPDX-License-Identifier: Apache-2.0
#include "host/stages/caustic_aims.h"

#include <algorithm>
#include <array>
#include <bit>

namespace nearlight::core {
namespace {

constexpr uint kWalksPerBatch = 1u << 13u;
constexpr uint kMaxBatches = 12;
/// Walks end with the batch that reaches so many landings.
constexpr std::size_t kEnoughLandings = 1u << 12u;
/// Fewer landings after so many batches tell too little.
constexpr std::size_t kMinLandings = 16;
constexpr uint kBatchesToMin = 4;
/// Cells above level 0 have at least so many landings.
constexpr std::size_t kMinPerCell = 8;
/// The side of a cell of level 0 is this part of the largest side of the box around all landings.
constexpr float kCoarsestPart = 0.125f;

using Coordinates = std::array<int, 3>;

struct PlacedLanding {
    Coordinates cell;
    uint landing;
};

/// The landings of all cells with a given side, in the order of the cells: each in the eight cells that are
/// nearest to it.
std::vector<PlacedLanding> place_in_cells(std::span<const CausticLanding> landings, float side) {
    std::vector<PlacedLanding> placed;
    placed.reserve(8 * landings.size());
    const auto lower = [&](float x) { return caustic_coordinate(x, side, -0.5f); };
    for (uint i = 0; i < landings.size(); ++i) {
        const Vec3 at = landings[i].place;
        for (int corner = 0; corner < 8; ++corner) {
            placed.push_back(
                {{lower(at.x) + corner % 2, lower(at.y) + corner / 2 % 2, lower(at.z) + corner / 4}, i});
        }
    }
    std::ranges::sort(placed, [](const PlacedLanding& a, const PlacedLanding& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.landing < b.landing;
    });
    return placed;
}

/// Adds a cell with an even choice of the targets of its landings.
void add_cell(std::span<const PlacedLanding> inside, std::span<const CausticLanding> landings, uint level,
              std::vector<CausticCell>& cells, std::vector<Vec3>& targets) {
    const std::size_t kept = std::min<std::size_t>(inside.size(), NEARLIGHT_MAX_CAUSTIC_TARGETS);
    const Coordinates& at = inside.front().cell;
    cells.push_back({at[0], at[1], at[2], level, static_cast<uint>(targets.size()), static_cast<uint>(kept)});
    for (std::size_t i = 0; i < kept; ++i) {
        targets.push_back(landings[inside[i * inside.size() / kept].landing].target);
    }
}

std::vector<CausticCell> table_of(std::span<const CausticCell> cells) {
    std::vector<CausticCell> entries(std::bit_ceil(2 * cells.size()), CausticCell{});
    const std::size_t mask = entries.size() - 1;
    for (const CausticCell& cell : cells) {
        std::size_t at = caustic_hash(cell.x, cell.y, cell.z, cell.level) & mask;
        while (entries[at].count != 0) {
            at = (at + 1) & mask;
        }
        entries[at] = cell;
    }
    return entries;
}

/// The largest side of the box around all landings, m.
float extent_of(std::span<const CausticLanding> landings) {
    Vec3 low = landings.front().place;
    Vec3 high = low;
    for (const CausticLanding& landing : landings) {
        low = min(low, landing.place);
        high = max(high, landing.place);
    }
    return max_component(high - low);
}

}  // namespace

CausticWalks::CausticWalks(Device& device)
    : device_(&device), caustic_walks_(Program(device, "caustic_aims.cl"), "caustic_walks") {}

std::vector<CausticLanding> CausticWalks::run(const DeviceScene& scene, uint first_walk, uint walk_count,
                                              uint seed) {
    Buffer<CausticLanding> all(*device_, walk_count);
    caustic_walks_.launch_items(walk_count, scene, first_walk, walk_count, seed, all);
    std::vector<CausticLanding> landings = all.download();
    std::erase_if(landings, [](const CausticLanding& landing) { return landing.is_there == 0; });
    return landings;
}

CausticCells sort_into_cells(std::span<const CausticLanding> landings, float scene_extent) {
    CausticCells sorted;
    if (landings.empty()) {
        return sorted;
    }
    const float side = std::max(kCoarsestPart * extent_of(landings), 1e-3f * scene_extent);
    std::vector<CausticCell> cells;
    for (uint level = 0; level < NEARLIGHT_CAUSTIC_LEVELS; ++level) {
        const std::vector<PlacedLanding> placed =
            place_in_cells(landings, side / static_cast<float>(1u << level));
        for (auto first = placed.begin(); first != placed.end();) {
            const auto end = std::find_if(first, placed.end(),
                                          [&](const PlacedLanding& p) { return p.cell != first->cell; });
            if (level == 0 || static_cast<std::size_t>(end - first) >= kMinPerCell) {
                add_cell({first, end}, landings, level, cells, sorted.targets);
            }
            first = end;
        }
    }
    sorted.entries = table_of(cells);
    sorted.table = {.size = static_cast<uint>(sorted.entries.size()), .side = side};
    return sorted;
}

CausticAims find_caustic_aims(Device& device, const DeviceScene& scene, uint seed) {
    CausticWalks walks(device);
    std::vector<CausticLanding> landings;
    for (uint batch = 0; batch < kMaxBatches && landings.size() < kEnoughLandings; ++batch) {
        const std::vector<CausticLanding> more =
            walks.run(scene, batch * kWalksPerBatch, kWalksPerBatch, seed);
        landings.insert(landings.end(), more.begin(), more.end());
        if (batch + 1 >= kBatchesToMin && landings.size() < kMinLandings) {
            return CausticAims(device);
        }
    }
    const CausticCells sorted = sort_into_cells(landings, scene.host_info.extent);
    CausticAims aims(device);
    aims.table = sorted.table;
    aims.cells = Buffer<CausticCell>(device, sorted.entries);
    aims.targets = Buffer<Vec3>(device, sorted.targets);
    return aims;
}

}  // namespace nearlight::core
