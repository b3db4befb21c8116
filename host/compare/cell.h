// SPDX-License-Identifier: Apache-2.0
// The smallest piece of a comparison: one picture and its measurements.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/compare/method.h"
#include "host/compare/picture_error.h"
#include "host/compare/settings.h"

namespace nearlight::core {

struct CellId {
    Method method;
    uint vpls = 0;  ///< number of VPLs that was asked for
    uint seed = 0;

    bool operator==(const CellId&) const = default;
};

struct Cell {
    CellId id;
    std::size_t close_vpls = 0;    ///< gathered VPLs in the close range
    std::size_t distant_vpls = 0;  ///< gathered VPLs elsewhere
    std::size_t sparse_vpls = 0;   ///< VPLs that only lit other VPLs
    PictureError error{};
    double generate_seconds = 0;  ///< time for the view, the pilots and the VPLs
    double gather_seconds = 0;    ///< time for camera pass, gather and film
    std::string image_hash{};     ///< hash of the picture's bits

    [[nodiscard]] std::size_t gathered_vpls() const { return close_vpls + distant_vpls; }
    [[nodiscard]] double seconds() const { return generate_seconds + gather_seconds; }
};

/// All cells of a scene in the order in which they are measured: seed by seed, so that other load on the
/// machine affects all methods alike and an early stop leaves complete seeds.
std::vector<CellId> cells_of(const CompareSettings& settings);

}  // namespace nearlight::core
