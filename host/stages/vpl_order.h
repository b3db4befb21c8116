// SPDX-License-Identifier: Apache-2.0
// VPLs in an order in which neighbours are neighbours in space, so that the gather finds its nodes in the
// cache.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "host/stages/compaction.h"
#include "host/stages/morton_sort.h"
#include "host/stages/vpl_buffer.h"

namespace nearlight::core {

class VplOrder {
  public:
    explicit VplOrder(Device& device) : device_(&device), morton_sort_(device), compaction_(device) {}

    /// Along the Morton curve through their bounds.
    VplBuffer sort(std::span<const Vpl> vpls) {
        const Buffer<Vpl> unsorted(*device_, vpls);
        Buffer<uint> order(*device_, vpls.size());
        Buffer<Vpl> sorted(*device_, vpls.size());
        morton_sort_.order(unsorted, vpls.size(), order);
        compaction_.gather(unsorted, order, vpls.size(), sorted);
        return {*device_, std::move(sorted), vpls.size()};
    }

    /// The indices in that order. Only positions are on the device meanwhile, so many more of them fit.
    std::vector<uint> order(std::span<const Vpl> vpls) {
        if (vpls.empty()) {
            return {};
        }
        std::vector<Vec3> positions;
        positions.reserve(vpls.size());
        std::ranges::transform(vpls, std::back_inserter(positions), &Vpl::position);
        Buffer<uint> indices(*device_, vpls.size());
        morton_sort_.order(Buffer<Vec3>(*device_, std::span<const Vec3>(positions)), vpls.size(), indices);
        return indices.download();
    }

    /// The same order on the host.
    std::vector<Vpl> sorted(std::span<const Vpl> vpls) {
        std::vector<Vpl> result;
        result.reserve(vpls.size());
        for (const uint index : order(vpls)) {
            result.push_back(vpls[index]);
        }
        return result;
    }

  private:
    Device* device_;
    MortonSort morton_sort_;
    Compaction compaction_;
};

}  // namespace nearlight::core
