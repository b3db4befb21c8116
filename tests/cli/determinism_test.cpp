// SPDX-License-Identifier: Apache-2.0
// The picture does not depend on the number of threads that the driver uses.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/cl/devices/device_list.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

/// image_hash of a render with `threads` threads of PoCL; other drivers ignore the number.
std::string hash_with_threads(const std::filesystem::path& scene, const std::filesystem::path& output,
                              const char* threads, int seed) {
    setenv("POCL_MAX_PTHREAD_COUNT", threads, 1);
    const ProgramResult result =
        run_program("render --json --vpls 300 --spp 2 --seed " + std::to_string(seed) + " " + quoted(scene) +
                    " -o " + quoted(output));
    unsetenv("POCL_MAX_PTHREAD_COUNT");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return nlohmann::json::parse(result.output)["image_hash"].dump();
}

TEST(ThreadCount, DoesNotChangeABit) {
    NEARLIGHT_NEEDS_DEVICE();
    const TemporaryFolder folder;
    const std::filesystem::path scene = folder / "scene.xml";
    std::ofstream(scene) << floor_and_wall(
        R"(<emitter type="constant"><rgb name="radiance" value="0.1, 0.1, 0.2"/></emitter>)");
    const std::string one = hash_with_threads(scene, folder / "one.exr", "1", 3);
    EXPECT_EQ(hash_with_threads(scene, folder / "two.exr", "2", 3), one);
    EXPECT_NE(hash_with_threads(scene, folder / "other.exr", "1", 4), one);
}

}  // namespace
}  // namespace nearlight::core
