// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

class Tune : public testing::Test {
  protected:
    [[nodiscard]] ProgramResult tune(const std::string& options) const {
        return run_program("tune --repeats 1 --triangles 500 --json --cache-dir " + quoted(folder_.path()) +
                           " " + options);
    }
    /// The facts that `devices` prints about the first device.
    [[nodiscard]] nlohmann::json tunables_in_use() const {
        const ProgramResult result = run_program("devices --json --cache-dir " + quoted(folder_.path()));
        return nlohmann::json::parse(result.output)["devices"][0]["tunables"];
    }

    TemporaryFolder folder_;
};

TEST_F(Tune, WhatItFindsIsUsedUntilReset) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult dry = tune("--device 0 --dry-run");
    ASSERT_EQ(dry.exit_code, 0) << dry.errors;
    EXPECT_EQ(nlohmann::json::parse(dry.output)["file"], "");
    EXPECT_FALSE(tunables_in_use()["is_tuned"]);

    const ProgramResult result = tune("--device 0");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_GE(json["trials"].size(), 2u);
    for (const nlohmann::json& trial : json["trials"]) {
        EXPECT_EQ(json["chosen"][trial["tunable"].get<std::string>()], trial["chosen"]);
        for (const nlohmann::json& candidate : trial["candidates"]) {
            EXPECT_GT(candidate["seconds"], 0.0) << candidate;
        }
    }
    const nlohmann::json in_use = tunables_in_use();
    EXPECT_TRUE(in_use["is_tuned"]);
    EXPECT_EQ(in_use["source"], json["file"]);
    for (const auto& [name, value] : json["chosen"].items()) {
        EXPECT_EQ(in_use[name], value) << name;
    }

    std::ofstream(json["file"].get<std::string>()) << "rubbish";
    EXPECT_FALSE(tunables_in_use()["is_tuned"]);
    const ProgramResult sorting =
        run_program("bench sort --device 0 --count 1000 --repeats 1 --cache-dir " + quoted(folder_.path()));
    EXPECT_EQ(sorting.exit_code, 0) << sorting.errors;
    EXPECT_NE(sorting.errors.find("nearlight tune"), std::string::npos) << sorting.errors;

    EXPECT_EQ(nlohmann::json::parse(tune("--device 0 --reset").output)["removed"], json["file"]);
    EXPECT_EQ(nlohmann::json::parse(tune("--device 0 --reset").output)["removed"], nullptr);
    EXPECT_FALSE(std::filesystem::exists(json["file"].get<std::string>()));
}

TEST_F(Tune, WantsAFolderToKeepThingsIn) {
    NEARLIGHT_NEEDS_DEVICE();
    EXPECT_EQ(run_program("tune --cache-dir none").exit_code, 2);
    EXPECT_EQ(run_program("tune --repeats 0").exit_code, 2);
}

}  // namespace
}  // namespace nearlight::core
