// SPDX-License-Identifier: Apache-2.0
// The number of threads that the driver uses does not show in the picture.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/cl/device_list.h"
#include "tests/cli/run_program.h"
#include "tests/support/device_required.h"

namespace nearlight {
namespace {

/// A floor and a wall under a point light and a dim sky.
constexpr const char* kScene = R"(<scene version="3.0.0">
  <integrator type="path"><integer name="max_depth" value="5"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="60"/>
    <transform name="to_world"><lookat origin="0, -1, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="48"/></film>
  </sensor>
  <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.25, 0.125"/></bsdf></shape>
  <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><translate y="1" z="1"/></transform>
    <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.7, 0.7"/></bsdf></bsdf></shape>
  <emitter type="point"><point name="position" x="0" y="0" z="1"/><rgb name="intensity" value="1, 1, 1"/></emitter>
  <emitter type="constant"><rgb name="radiance" value="0.1, 0.1, 0.2"/></emitter>
</scene>)";

/// image_hash of a render with so many threads of PoCL; other drivers take no notice.
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
    std::ofstream(scene) << kScene;
    const std::string one = hash_with_threads(scene, folder / "one.exr", "1", 3);
    EXPECT_EQ(hash_with_threads(scene, folder / "two.exr", "2", 3), one);
    EXPECT_NE(hash_with_threads(scene, folder / "other.exr", "1", 4), one);
}

}  // namespace
}  // namespace nearlight
