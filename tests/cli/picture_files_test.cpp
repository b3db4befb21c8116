// SPDX-License-Identifier: Apache-2.0
#include "host/cli/picture_files.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

namespace nearlight::core {
namespace {

using testing::FloatNear;
using testing::Pointwise;

/// A point times a matrix of the metadata, in OpenEXR's row-vector convention, after division by w.
std::array<float, 3> transformed(const Metadata& metadata, const char* name, std::array<float, 4> point) {
    const auto& m = std::get<std::vector<float>>(metadata.at(name));
    std::array<float, 4> result{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
            result.at(column) += point.at(row) * m.at(4 * row + column);
        }
    }
    return {result[0] / result[3], result[1] / result[3], result[2] / result[3]};
}

/// The camera stands at the origin and looks along +Z, with +Y up. Seen so, +X is on the left.
TEST(CameraMetadata, XPointsRightInOpenExrsCameraSpace) {
    SceneCamera camera;
    camera.to_world = Mat4();
    const Metadata metadata = camera_metadata(camera);
    const auto seen = transformed(metadata, "worldToCamera", {-0.25f, 0.5f, 2, 1});
    EXPECT_THAT(seen, Pointwise(FloatNear(1e-6f), {0.25f, 0.5f, 2.0f}));
    const auto on_screen = transformed(metadata, "worldToNDC", {-0.25f, 0.5f, 2, 1});
    EXPECT_GT(on_screen[0], 0.5f) << "to the right of the middle";
    EXPECT_LT(on_screen[1], 0.5f) << "above the middle";
}

}  // namespace
}  // namespace nearlight::core
