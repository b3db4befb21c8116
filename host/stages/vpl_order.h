// SPDX-License-Identifier: Apache-2.0
// Orders VPLs so that neighbours in the array are neighbours in space, and a gather finds tree nodes in the
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

    /// Uploads VPLs in their order along the Morton curve through their bounding box.
    VplBuffer sort(std::span<const Vpl> vpls) {
        const Buffer<Vpl> unsorted(*device_, vpls);
        Buffer<uint> order(*device_, vpls.size());
        Buffer<Vpl> sorted(*device_, vpls.size());
        morton_sort_.order(unsorted, vpls.size(), order);
        compaction_.gather(unsorted, order, vpls.size(), sorted);
        return {*device_, std::move(sorted), vpls.size()};
    }

    /// Returns the indices of VPLs in their order along the Morton curve. Only the positions are on the
    /// device meanwhile, so that many more VPLs fit.
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

    /// Returns VPLs in their order along the Morton curve, on the host.
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
