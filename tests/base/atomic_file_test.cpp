// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "host/base/files.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

TEST(AtomicFile, TakesTheTargetsNameOnCommit) {
    const TemporaryFolder folder;
    write(folder / "a", "old");
    for (const Durability durability : {Durability::cache, Durability::result}) {
        AtomicFile file(folder / "a");
        write(file.temporary(), "new");
        EXPECT_EQ(file.temporary().parent_path(), folder.path());
        EXPECT_FALSE(file.commit(durability));
        EXPECT_EQ(read_bytes(folder / "a"), "new");
        EXPECT_EQ(folder.file_count(), 1u);
    }
}

TEST(AtomicFile, WithoutACommitTheOldFileStays) {
    const TemporaryFolder folder;
    write(folder / "a", "old");
    {
        const AtomicFile file(folder / "a");
        write(file.temporary(), "half");
        EXPECT_EQ(folder.file_count(), 2u);
    }
    EXPECT_EQ(read_bytes(folder / "a"), "old");
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, AFailedCommitLeavesNothingBehind) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "occupied/by a folder");
    for (const Durability durability : {Durability::cache, Durability::result}) {
        AtomicFile file(folder / "occupied");
        write(file.temporary(), "new");
        EXPECT_TRUE(file.commit(durability));
    }
    EXPECT_EQ(folder.file_count(), 1u);
    EXPECT_TRUE(AtomicFile(folder / "never written").commit(Durability::result));
    EXPECT_TRUE(AtomicFile(folder / "never written").commit(Durability::cache));
}

TEST(AtomicFile, TheOneThatWasMovedToOwnsTheFile) {
    const TemporaryFolder folder;
    AtomicFile first(folder / "a");
    write(first.temporary(), "new");
    AtomicFile second = std::move(first);
    { AtomicFile third = AtomicFile(folder / "b"); }
    EXPECT_EQ(folder.file_count(), 1u);
    EXPECT_FALSE(second.commit(Durability::cache));
    EXPECT_EQ(read_bytes(folder / "a"), "new");
}

TEST(AtomicFile, ThreadsThatWriteOneTargetDoNotMeet) {
    const TemporaryFolder folder;
    std::mutex mutex;
    std::set<std::filesystem::path> names;
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&, text = std::string(10'000, static_cast<char>('a' + i))] {
            for (int turn = 0; turn < 20; ++turn) {
                AtomicFile file(folder / "a");
                {
                    const std::scoped_lock lock(mutex);
                    names.insert(file.temporary());
                }
                write(file.temporary(), text);
                EXPECT_FALSE(file.commit(Durability::cache));
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(names.size(), 160u);
    const std::string text = read_bytes(folder / "a");
    EXPECT_EQ(text, std::string(10'000, text.at(0)));
}

}  // namespace
}  // namespace nearlight::core
