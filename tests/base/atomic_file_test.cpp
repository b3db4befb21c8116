// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
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

/// Runs `action` in a process of its own, which must kill itself.
template <typename Action>
void in_killed_process(const Action& action) {
    const pid_t child = fork();
    if (child == 0) {
        action();
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(AtomicFile, WhatAKilledProcessLeftIsRemoved) {
    const TemporaryFolder folder;
    const AtomicFile living(folder / "a");
    write(living.temporary(), "of a process that lives");
    in_killed_process([&] {
        const AtomicFile file(folder / "a");
        write(file.temporary(), "half");
        const AtomicFile other(folder / "ab");
        write(other.temporary(), "half");
        raise(SIGKILL);
    });
    EXPECT_EQ(folder.file_count(), 3u);
    { const AtomicFile next(folder / "a"); }
    EXPECT_EQ(folder.file_count(), 2u) << "that of another target stays";
    EXPECT_EQ(read_bytes(living.temporary()), "of a process that lives");
    { const AtomicFile next(folder / "ab"); }
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, FilesThatOnlyLookAbandonedStay) {
    const TemporaryFolder folder;
    in_killed_process([&] {
        write(folder / "name", AtomicFile(folder / "a").temporary().filename());
        raise(SIGKILL);
    });
    const std::string own = read_bytes(folder / "name");
    const std::size_t system = own.find('-') + 1;
    std::string elsewhere = own;
    elsewhere[system] = elsewhere[system] == '0' ? '1' : '0';
    for (const std::string& name :
         {elsewhere, own.substr(0, system), own.substr(0, own.find('-', system) + 1), "b" + own}) {
        write(folder / name, "kept");
    }
    { const AtomicFile next(folder / "a"); }
    EXPECT_EQ(folder.file_count(), 5u);
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
