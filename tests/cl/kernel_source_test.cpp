// SPDX-License-Identifier: Apache-2.0
#include "host/cl/kernel_source.h"

#include <gtest/gtest.h>

#include <fstream>

#include "kernels/embedded.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using test::error_of;
using test::mentions;

void write(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

TEST(KernelSource, ExpandsEachIncludeOnceAndKeepsLineNumbers) {
    const TemporaryFolder folder;
    write(folder / "stage.cl", "// head\n#include \"lib/a.cl\"\n#include \"lib/b.cl\"\nkernel void f() {}\n");
    write(folder / "lib/a.cl", "#include \"lib/b.cl\"\nint a;\n");
    write(folder / "lib/b.cl", "int b;\n");
    EXPECT_EQ(expand_kernel_source("stage.cl", folder.path()),
              "#line 1 \"stage.cl\"\n"
              "// head\n"
              "#line 1 \"lib/a.cl\"\n"
              "#line 1 \"lib/b.cl\"\n"
              "int b;\n"
              "#line 2 \"lib/a.cl\"\n"
              "int a;\n"
              "#line 3 \"stage.cl\"\n"
              "#line 4 \"stage.cl\"\n"
              "kernel void f() {}\n");
}

TEST(KernelSource, FilesThatIncludeEachOtherEnd) {
    const TemporaryFolder folder;
    write(folder / "a.cl", "#include \"b.cl\"\nint a;\n");
    write(folder / "b.cl", "#include \"a.cl\"\nint b;\n");
    EXPECT_EQ(occurrences(expand_kernel_source("a.cl", folder.path()), "int b;"), 1u);
}

TEST(KernelSource, UnderstandsSpacesAndLeavesOtherDirectivesAlone) {
    const TemporaryFolder folder;
    write(folder / "a.cl", "  #  include \"b.cl\"  // for b\n#define X 1\n#include <math.h>\n");
    write(folder / "b.cl", "int b;\n");
    const std::string text = expand_kernel_source("a.cl", folder.path());
    EXPECT_EQ(occurrences(text, "int b;"), 1u);
    EXPECT_EQ(occurrences(text, "#define X 1\n#include <math.h>\n"), 1u);
}

TEST(KernelSource, EveryEmbeddedKernelExpands) {
    ASSERT_FALSE(embedded_kernel_names().empty());
    for (const std::string_view name : embedded_kernel_names()) {
        const std::string text = expand_kernel_source(std::string(name));
        EXPECT_EQ(occurrences(text, "#include \""), 0u) << name;
        EXPECT_EQ(occurrences(text, "#line 1 \"" + std::string(name) + "\""), 1u) << name;
    }
}

TEST(KernelSource, EmbeddedTextIsTheFileByteForByte) {
    for (const std::string_view name : embedded_kernel_names()) {
        std::ifstream file(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "kernels" / name, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        EXPECT_EQ(embedded_kernel(name), text) << name;
    }
}

TEST(KernelSource, KernelDirWinsOverTheBinary) {
    const TemporaryFolder folder;
    write(folder / "prefix_scan.cl", "int other;\n");
    EXPECT_EQ(expand_kernel_source("prefix_scan.cl", folder.path()),
              "#line 1 \"prefix_scan.cl\"\nint other;\n");
}

TEST(KernelSource, MissingFilesAreNamedWithTheirIncluder) {
    const TemporaryFolder folder;
    write(folder / "a.cl", "#include \"lib/lost.cl\"\n");
    const Error included = error_of([&] { expand_kernel_source("a.cl", folder.path()); });
    EXPECT_EQ(included.kind(), ErrorKind::kernel_build);
    EXPECT_TRUE(mentions(included, "lib/lost.cl"));
    EXPECT_TRUE(mentions(included, "included by a.cl"));
    EXPECT_TRUE(mentions(included, folder.path().string()));

    const Error embedded = error_of([] { expand_kernel_source("no_such_stage.cl"); });
    EXPECT_EQ(embedded.kind(), ErrorKind::kernel_build);
    EXPECT_TRUE(mentions(embedded, "no_such_stage.cl"));
}

}  // namespace
}  // namespace nearlight::core
