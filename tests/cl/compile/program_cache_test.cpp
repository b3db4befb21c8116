// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/program_cache.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

const std::vector<unsigned char> kBinary{0, 1, 2, 0, 255, '\n', 7};

std::filesystem::path only_file(const std::filesystem::path& folder) {
    return std::filesystem::directory_iterator(folder)->path();
}

TEST(ProgramCache, GivesBackWhatWasStoredUnderTheSameKeyOnly) {
    const TemporaryFolder folder;
    const ProgramCache cache(folder / "new folder");
    EXPECT_EQ(cache.find("key"), std::nullopt);
    cache.store("key", kBinary);
    EXPECT_EQ(cache.find("key"), kBinary);
    EXPECT_EQ(cache.find("other key"), std::nullopt);
    EXPECT_EQ(ProgramCache(folder / "new folder").find("key"), kBinary);
}

TEST(ProgramCache, StoringAgainReplacesAndLeavesNoTemporaryFile) {
    const TemporaryFolder folder;
    const ProgramCache cache(folder.path());
    cache.store("key", kBinary);
    cache.store("key", {9, 9});
    EXPECT_EQ(cache.find("key"), (std::vector<unsigned char>{9, 9}));
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(ProgramCache, AFileOfAnotherKeyIsNotTakenForThisOne) {
    const TemporaryFolder folder;
    const ProgramCache cache(folder / "a");
    const ProgramCache other(folder / "b");
    cache.store("key 1", kBinary);
    other.store("key 2", kBinary);
    // This simulates a hash collision: the file of key 1 has the name of key 2.
    std::filesystem::rename(only_file(folder / "a"), only_file(folder / "b"));
    EXPECT_EQ(other.find("key 2"), std::nullopt);
}

TEST(ProgramCache, DamagedAndTruncatedFilesAreRefused) {
    const TemporaryFolder folder;
    const ProgramCache cache(folder.path());
    cache.store("key", kBinary);
    const std::filesystem::path file = only_file(folder.path());
    std::ifstream stream(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 1);
        std::ofstream(file, std::ios::binary) << damaged;
        EXPECT_EQ(cache.find("key"), std::nullopt) << "byte " << i << " changed";
        std::ofstream(file, std::ios::binary) << whole.substr(0, i);
        EXPECT_EQ(cache.find("key"), std::nullopt) << "cut after " << i << " bytes";
    }
}

std::vector<unsigned char> bytes_of(std::string_view text) {
    return {text.begin(), text.end()};
}

TEST(ProgramCache, ProgramsOfPoclThatLackAKernelAreRefused) {
    using namespace std::string_view_literals;
    const TemporaryFolder folder;
    const ProgramCache cache(folder.path());
    const std::vector<unsigned char> empty = bytes_of("poclbin\x16\0\0\0/add/0-0-0/add.so\0\0\0\0more"sv);
    EXPECT_TRUE(lacks_a_kernel(empty));
    cache.store("key", empty);
    EXPECT_EQ(cache.find("key"), std::nullopt);
    for (const std::string_view whole : {"/add/0-0-0/add.so\x03\0\0\0ELF"sv, "/add/0-0-0/sub.so\0\0\0\0"sv,
                                         ".so\0\0\0\0"sv, "/add/0-0-0/add.so"sv, ""sv}) {
        EXPECT_FALSE(lacks_a_kernel(bytes_of(whole))) << whole;
    }
}

TEST(ProgramCache, WithoutAFolderItKeepsNothing) {
    for (const char* dir : {"", "none"}) {
        const ProgramCache cache{dir};
        cache.store("key", kBinary);
        EXPECT_EQ(cache.find("key"), std::nullopt);
    }
    EXPECT_FALSE(std::filesystem::exists("none"));
}

TEST(ProgramCache, AFolderThatCannotBeMadeIsNoError) {
    const TemporaryFolder folder;
    std::ofstream(folder / "file") << "in the way";
    const ProgramCache cache(folder / "file" / "below");
    EXPECT_NO_THROW(cache.store("key", kBinary));
    EXPECT_EQ(cache.find("key"), std::nullopt);
}

}  // namespace
}  // namespace nearlight::core
