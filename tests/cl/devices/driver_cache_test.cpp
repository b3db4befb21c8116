// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/driver_cache.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/image/environment_variable.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

TEST(DriverCache, EmptyKernelsAreRemovedAndNothingElse) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("POCL_CACHE_DIR", folder.path().string());
    const fs::path program = folder / "AB" / "CDEF";
    const fs::path empty = program / "sort" / "0-0-0" / "sort.so";
    const fs::path whole = program / "scan" / "0-0-0" / "scan.so";
    const fs::path begun = folder / "tempfile_123.so";
    for (const fs::path& file : {empty, whole, begun, program / "program.bc"}) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << (file == whole ? "code" : "");
    }
    EXPECT_EQ(remove_empty_kernels(), 1u);
    EXPECT_FALSE(fs::exists(empty));
    EXPECT_TRUE(fs::exists(whole) && fs::exists(begun) && fs::exists(program / "program.bc"));
    EXPECT_EQ(remove_empty_kernels(), 0u);
}

TEST(DriverCache, AFolderThatIsNotThereHasNoKernels) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("POCL_CACHE_DIR", (folder / "none").string());
    EXPECT_EQ(remove_empty_kernels(), 0u);
}

}  // namespace
}  // namespace nearlight::core
