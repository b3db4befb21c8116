// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/registered_drivers.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/image/environment_variable.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

TEST(RegisteredDrivers, ThoseThatDoNotLoadAreTold) {
    const TemporaryFolder folder;
    const EnvironmentVariable place("OCL_ICD_VENDORS", folder.path().string());
    EXPECT_TRUE(drivers_that_do_not_load().empty());
    std::ofstream(folder / "good.icd") << "libc.so.6\n";
    std::ofstream(folder / "bad.icd") << "libno-such-driver.so \n";
    std::ofstream(folder / "empty.icd");
    std::ofstream(folder / "notes.txt") << "libno-such-driver.so\n";
    const std::vector<std::string> problems = drivers_that_do_not_load();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_TRUE(problems[0].starts_with("the driver 'libno-such-driver.so', which '" +
                                        (folder / "bad.icd").string() + "' names, cannot be loaded: "))
        << problems[0];
}

TEST(RegisteredDrivers, TheRegistryMayBeMissingOrOneFile) {
    const TemporaryFolder folder;
    {
        const EnvironmentVariable place("OCL_ICD_VENDORS", (folder / "none").string());
        EXPECT_TRUE(drivers_that_do_not_load().empty());
    }
    std::ofstream(folder / "bad.icd") << "libno-such-driver.so";
    const EnvironmentVariable place("OCL_ICD_VENDORS", (folder / "bad.icd").string());
    EXPECT_EQ(drivers_that_do_not_load().size(), 1u);
}

}  // namespace
}  // namespace nearlight::core
