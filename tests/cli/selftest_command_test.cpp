// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/cl/devices/device_list.h"
#include "tests/cli/run_program.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

TEST(Selftest, EveryKernelPassesAndJsonSaysSo) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = run_program("selftest --json --device all");
    ASSERT_EQ(result.exit_code, 0) << result.output << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["pass"], true);
    ASSERT_FALSE(json["devices"].empty());
    for (const nlohmann::json& device : json["devices"]) {
        EXPECT_FALSE(device["device"].get<std::string>().empty());
        EXPECT_EQ(device["pass"], true);
        std::string names;
        for (const nlohmann::json& check : device["checks"]) {
            names += (names.empty() ? "" : ", ") + check["name"].get<std::string>();
            EXPECT_GT(check["cases"], 10) << check;
            EXPECT_EQ(check["mismatches"], 0) << check;
            EXPECT_EQ(check["pass"], true) << check;
        }
        EXPECT_EQ(names,
                  "layout, scan, compaction, sort, morton, classify, light visibility, placement, "
                  "patch VPLs, VPL light, closest hit, any hit, gather packets, gather rays, roulette, "
                  "light cuts, BSDFs, direct light, paths of receivers, shared lights, shared sky, "
                  "shared veiled, shared reflections, light tracing, caustic walks, VPL contribution, "
                  "reverse VPLs, metropolis chains, local lights, camera pass, first surfaces, camera "
                  "lights, film, splats");
    }
}

/// The selftest finds a wrong kernel: one with a planted fault, which is read from a folder.
TEST(Selftest, ABrokenKernelFailsItsCheckAndNoOther) {
    NEARLIGHT_NEEDS_DEVICE();
    const TemporaryFolder folder;
    const std::filesystem::path kernels = folder / "kernels";
    std::filesystem::copy(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "kernels", kernels,
                          std::filesystem::copy_options::recursive);
    std::string text = file_text(kernels / "receiver_paths.cl");
    const std::string right = "store_irradiance(direct + packet, lane, light.direct);";
    ASSERT_NE(text.find(right), std::string::npos);
    text.replace(text.find(right), right.size(),
                 "store_irradiance(direct + packet, lane, 1.05f * light.direct);");
    std::ofstream(kernels / "receiver_paths.cl") << text;
    std::ofstream(kernels / "ray_caster.cl") << "this is no kernel";

    const ProgramResult result =
        run_program("selftest --json --cache-dir none --kernel-dir " + quoted(kernels));
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["pass"], false);
    for (const nlohmann::json& check : json["devices"][0]["checks"]) {
        const std::string name = check["name"];
        const bool broken = name == "direct light" || name == "closest hit" || name == "any hit";
        EXPECT_EQ(check["pass"], !broken) << check;
        EXPECT_EQ(check.contains("problem"), name == "closest hit" || name == "any hit") << check;
    }
}

TEST(Selftest, AnUnknownDeviceIsNoDevice) {
    const ProgramResult result = run_program("selftest --device no-such-device");
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_EQ(result.output, "");
}

}  // namespace
}  // namespace nearlight::core
