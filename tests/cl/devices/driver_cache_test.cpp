// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/driver_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

/// Has drivers keep their files in another folder during its lifetime.
class DriverCacheAt {
  public:
    explicit DriverCacheAt(const fs::path& folder) {
        const char* const old = std::getenv("POCL_CACHE_DIR");
        old_ = old == nullptr ? "" : old;
        setenv("POCL_CACHE_DIR", folder.c_str(), 1);
    }
    DriverCacheAt(const DriverCacheAt&) = delete;
    DriverCacheAt& operator=(const DriverCacheAt&) = delete;
    ~DriverCacheAt() {
        old_.empty() ? unsetenv("POCL_CACHE_DIR") : setenv("POCL_CACHE_DIR", old_.c_str(), 1);
    }

  private:
    std::string old_;
};

TEST(DriverCache, EmptyKernelsAreRemovedAndNothingElse) {
    const TemporaryFolder folder;
    const DriverCacheAt cache(folder.path());
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
    const DriverCacheAt cache(folder / "none");
    EXPECT_EQ(remove_empty_kernels(), 0u);
}

}  // namespace
}  // namespace nearlight::core
