// SPDX-License-Identifier: Apache-2.0
// Tests `render --device` with two devices of PoCL.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/cl/devices/device_list.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

class DeviceOption : public ::testing::Test {
  protected:
    void SetUp() override {
        NEARLIGHT_NEEDS_DEVICE();
        std::ofstream(folder_ / "scene.xml") << floor_and_wall();
    }
    [[nodiscard]] nlohmann::json render(const std::string& device) const {
        const ProgramResult result =
            run_program("render --json --vpls 100 --spp 1 --size 200x150 --device " + device + " " +
                            quoted(folder_ / "scene.xml") + " -o " + quoted(folder_ / "out.exr"),
                        "POCL_DEVICES='pthread pthread'");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_EQ(result.errors.find("warning"), std::string::npos) << result.errors;
        return result.exit_code == 0 ? nlohmann::json::parse(result.output) : nlohmann::json();
    }
    [[nodiscard]] static bool pocl_only() {
        const DeviceList list = list_devices();
        return std::all_of(list.devices.begin(), list.devices.end(), [](const DeviceEntry& entry) {
            return entry.platform == "Portable Computing Language";
        });
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(DeviceOption, AllAndAListShareThePictureWithoutChangingABit) {
    if (!pocl_only()) {
        GTEST_SKIP() << "other drivers are here: devices may be of several types";
    }
    const nlohmann::json one = render("0");
    ASSERT_FALSE(one.is_null());
    EXPECT_EQ(one["device"].size(), 1u);
    EXPECT_EQ(one["device_shares"][0]["share"], 1.0);
    for (const char* choice : {"all", "0,1", "1,0"}) {
        const nlohmann::json two = render(choice);
        ASSERT_FALSE(two.is_null());
        EXPECT_EQ(two["image_hash"], one["image_hash"]) << choice;
        ASSERT_EQ(two["device"].size(), 2u);
        const nlohmann::json& shares = two["device_shares"];
        ASSERT_EQ(shares.size(), 2u);
        EXPECT_GT(shares[0]["bands"].get<int>() + shares[1]["bands"].get<int>(), 8);
        EXPECT_NEAR(shares[0]["share"].get<double>() + shares[1]["share"].get<double>(), 1.0, 1e-9);
        for (const nlohmann::json& share : shares) {
            EXPECT_FALSE(share["failed"].get<bool>());
            EXPECT_GE(share["seconds"].get<double>(), 0.0);
        }
    }
}

TEST_F(DeviceOption, PartsOfADevice) {
    const DeviceList list = list_devices();
    if (list.devices.front().max_parts < 2) {
        GTEST_SKIP() << "the first device cannot be split";
    }
    const nlohmann::json whole = render("0");
    const nlohmann::json halves = render("0/2");
    const nlohmann::json half = render("0/2.1");
    ASSERT_FALSE(whole.is_null() || halves.is_null() || half.is_null());
    EXPECT_EQ(halves["image_hash"], whole["image_hash"]);
    EXPECT_EQ(half["image_hash"], whole["image_hash"]);
    EXPECT_EQ(halves["device"].size(), 2u);
    ASSERT_EQ(half["device"].size(), 1u);
    EXPECT_NE(half["device"][0].get<std::string>().find("part 1 of 2"), std::string::npos);
}

}  // namespace
}  // namespace nearlight::core
