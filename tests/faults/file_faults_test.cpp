// SPDX-License-Identifier: Apache-2.0
// Runs the program where files, descriptors and memory run out. tests/cli/bad_input_test.cpp has folders that
// cannot be written, and standard streams that are closed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <regex>
#include <vector>

#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

class FileFaults : public testing::Test {
  protected:
    void SetUp() override {
        NEARLIGHT_NEEDS_DEVICE();
        std::ofstream(folder_ / "scene.xml") << floor_and_wall();
        fs::create_directory(folder_ / "pictures");
        std::ofstream(picture()) << "old";
    }
    [[nodiscard]] fs::path picture() const { return folder_ / "pictures" / "picture.exr"; }
    [[nodiscard]] std::string task(const std::string& more = "",
                                   const std::string& work = "--vpls 32 --spp 1") const {
        return "render " + quoted(folder_ / "scene.xml") + " --json -o " + quoted(picture()) + " " + work +
               " " + more;
    }
    /// The part of the program's JSON that tells the picture's bits.
    static std::string hash_in(const ProgramResult& result) {
        std::smatch match;
        const bool found = std::regex_search(result.output, match, std::regex("\"image_hash\": \"\\w+\""));
        EXPECT_TRUE(found) << result.errors;
        return match.str();
    }
    /// One line, and the old picture.
    void expect_error(const ProgramResult& result, const std::vector<int>& exit_codes,
                      const std::string& part) const {
        EXPECT_THAT(exit_codes, testing::Contains(result.exit_code));
        const std::size_t line = result.errors.find("nearlight: error: ");
        ASSERT_NE(line, std::string::npos) << result.errors;
        EXPECT_EQ(result.errors.find('\n', line), result.errors.size() - 1) << result.errors;
        EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
        EXPECT_EQ(file_text(picture()), "old");
        EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "pictures"), fs::directory_iterator()), 1);
    }

    TemporaryFolder folder_;
};

TEST_F(FileFaults, AFileThatMayNotGrow) {
    ASSERT_EQ(run_program(task("--size 200x150")).exit_code, 0) << "this compiles the kernels";
    std::ofstream(picture()) << "old";
    expect_error(run_program(task("--size 200x150"), "ulimit -f 16;"), {3}, "is the disk full");
}

TEST_F(FileFaults, AFolderThatGoesWhileThePictureIsMade) {
    // The temporary file of a picture is there from the first rows on. The parentheses give the loop no part
    // in the program's streams.
    const std::string pictures = quoted(folder_ / "pictures");
    const std::string when_begun = "(for i in $(seq 3000); do ls " + pictures +
                                   " | grep -q partial && break; sleep 0.01; done; rm -r " + pictures +
                                   ") >/dev/null 2>&1 & timeout 120";
    const ProgramResult result = run_program(task("--size 400x300", "--vpls 500 --spp 64"), when_begun);
    EXPECT_EQ(result.exit_code, 3) << result.errors;
    EXPECT_NE(result.errors.find("its folder gone"), std::string::npos) << result.errors;
    EXPECT_FALSE(fs::exists(folder_ / "pictures"));
}

TEST_F(FileFaults, FewDescriptors) {
    const std::string right = hash_in(run_program(task()));
    for (const int count : {4, 5, 6, 7, 8, 12, 20, 40}) {
        SCOPED_TRACE(count);
        std::ofstream(picture()) << "old";
        const ProgramResult result = run_program(task(), "prlimit --nofile=" + std::to_string(count));
        if (result.exit_code == 0) {
            EXPECT_EQ(hash_in(result), right);
        } else if (result.exit_code == 127) {
            EXPECT_LT(count, 12);  // ld.so has too few for the program's libraries
        } else {
            EXPECT_LT(count, 20);
            expect_error(result, {1, 3, 4}, "ulimit -n");
        }
    }
}

// PoCL 3.1 does so where it cannot start the linker, and would end every later process.
TEST_F(FileFaults, KernelsThatTheDriverLeftEmptyAreRemoved) {
    const fs::path cache = folder_ / "driver";
    const std::string use = "env POCL_CACHE_DIR=" + quoted(cache);
    const std::string render = task("--cache-dir " + quoted(folder_ / "binaries"));
    const std::string right = hash_in(run_program(render, use));
    std::vector<fs::path> kernels;
    for (const auto& entry : fs::recursive_directory_iterator(cache)) {
        if (entry.path().extension() == ".so") {
            kernels.push_back(entry.path());
        }
    }
    if (kernels.empty()) {
        GTEST_SKIP() << "this driver keeps no kernels there";
    }
    for (const fs::path& kernel : kernels) {
        fs::resize_file(kernel, 0);
    }
    std::ofstream(picture()) << "old";
    expect_error(run_program(render, use), {1}, "run the command again");
    EXPECT_EQ(hash_in(run_program(render, use)), right);
}

// Trees are in tests/bvh/bvh_cache_test.cpp.
TEST_F(FileFaults, DamagedAndHinderedCachesOfKernels) {
    const fs::path cache = folder_ / "cache";
    const std::string use = "--cache-dir " + quoted(cache);
    const std::string right = hash_in(run_program(task(use)));
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(cache)) {
        std::string bytes = file_text(entry.path());
        if (++count % 2 == 0) {
            bytes.resize(bytes.size() * count / (count + 3));
        } else {
            bytes[bytes.size() * count / (count + 3)] ^= 4;
        }
        std::ofstream(entry.path(), std::ios::binary) << bytes;
    }
    EXPECT_GT(count, 3u);
    EXPECT_EQ(hash_in(run_program(task(use))), right);
    EXPECT_EQ(hash_in(run_program(task("--cache-dir " + quoted(folder_ / "scene.xml")))), right);
}

#ifndef NEARLIGHT_RESERVES_ADDRESSES
TEST_F(FileFaults, LittleMemory) {
    const std::string right = hash_in(run_program(task()));
    for (const long kib :
         {300000, 360000, 380000, 400000, 500000, 550000, 600000, 700000, 800000, 1000000, 2000000}) {
        SCOPED_TRACE(kib);
        std::ofstream(picture()) << "old";
        const ProgramResult result =
            run_program(task(), "timeout 60 prlimit --as=" + std::to_string(1024 * kib));
        if (result.exit_code == 0) {
            EXPECT_EQ(hash_in(result), right);
        } else {
            expect_error(result, {4, 6}, "");
        }
    }
}

/// A mesh of `count` triangles that are all the same.
void write_mesh(const fs::path& file, std::size_t count) {
    std::ofstream out(file, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        << "property float z\nelement face " << count
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    const std::array<float, 9> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    out.write(reinterpret_cast<const char*>(corners.data()), sizeof(corners));
    std::string face(13, '\0');
    face[0] = 3;
    face[5] = 1;
    face[9] = 2;
    for (std::size_t i = 0; i < count; ++i) {
        out << face;
    }
}

TEST_F(FileFaults, AMeshThatDoesNotFitIsRefusedBeforeItsTreeIsBuilt) {
    write_mesh(folder_ / "mesh.ply", 6'000'000);
    std::ofstream(folder_ / "scene.xml")
        << R"(<scene version="3.0.0"><shape type="ply"><string name="filename" value="mesh.ply"/></shape></scene>)";
    expect_error(run_program(task(), "prlimit --as=1600000000"), {6}, "6000000 triangles, needs about");
}
#endif

}  // namespace
}  // namespace nearlight::core
