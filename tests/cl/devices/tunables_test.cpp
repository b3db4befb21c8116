// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/tunables.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "nearlight/error.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

DeviceEntry make_entry() {
    DeviceEntry entry;
    entry.name = "a device";
    entry.platform = "a platform";
    entry.driver = "1.2";
    entry.kind = DeviceKind::cpu;
    return entry;
}

Tunables unusual() {
    Tunables tunables = tunables_row(DeviceKind::cpu).values;
    tunables.beam_width = 32;
    tunables.runs_per_unit = 7;
    return tunables;
}

std::vector<std::string> measured_kernels() {
    return {"prefix_scan.cl", "film.cl"};
}

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

TEST(Tunables, EveryKindOfDeviceHasARowOfValuesThatMakeSense) {
    for (const DeviceKind kind : {DeviceKind::cpu, DeviceKind::gpu, DeviceKind::other}) {
        const TunablesRow& row = tunables_row(kind);
        EXPECT_EQ(row.kind, kind);
        for (const TunableField& field : tunable_fields()) {
            EXPECT_TRUE(field.allows(row.values.*field.value)) << row.name << ", " << field.name;
        }
    }
}

TEST(Tunables, WithoutAFileTheyAreTheTables) {
    const TemporaryFolder folder;
    for (const std::filesystem::path& dir :
         {folder.path(), std::filesystem::path("none"), std::filesystem::path()}) {
        const ChosenTunables chosen = choose_tunables(make_entry(), dir, {});
        EXPECT_EQ(chosen.values, tunables_row(DeviceKind::cpu).values);
        EXPECT_EQ(chosen.source, "table for CPUs");
        EXPECT_FALSE(chosen.is_tuned);
        EXPECT_EQ(chosen.warning, "");
    }
    EXPECT_THROW(store_tunables(unusual(), measured_kernels(), make_entry(), "none", {}), Error);
}

TEST(Tunables, WhatWasStoredIsUsedForThatDeviceAndDriverOnly) {
    const TemporaryFolder folder;
    store_tunables(unusual(), measured_kernels(), make_entry(), folder.path() / "new", {});
    const ChosenTunables chosen = choose_tunables(make_entry(), folder.path() / "new", {});
    EXPECT_EQ(chosen.values, unusual());
    EXPECT_TRUE(chosen.is_tuned);
    EXPECT_EQ(chosen.source, tunables_file(make_entry(), folder.path() / "new").string());
    DeviceEntry other = make_entry();
    other.driver = "1.3";
    EXPECT_FALSE(choose_tunables(other, folder.path() / "new", {}).is_tuned);
    // This simulates a hash collision.
    std::filesystem::rename(chosen.source, tunables_file(other, folder.path() / "new"));
    const ChosenTunables strange = choose_tunables(other, folder.path() / "new", {});
    EXPECT_FALSE(strange.is_tuned);
    EXPECT_NE(strange.warning.find("another device"), std::string::npos) << strange.warning;
}

TEST(Tunables, FoundWithOtherKernelsTheyAreOld) {
    const TemporaryFolder folder;
    store_tunables(unusual(), measured_kernels(), make_entry(), folder.path(), {});
    const std::filesystem::path file = tunables_file(make_entry(), folder.path());
    std::string text = text_of(file);
    char& digit = text[text.find("kernels ") + 8];
    digit = digit == '0' ? '1' : '0';
    std::ofstream(file) << text;
    const ChosenTunables chosen = choose_tunables(make_entry(), folder.path(), {});
    EXPECT_FALSE(chosen.is_tuned);
    EXPECT_NE(chosen.warning.find("other kernels"), std::string::npos) << chosen.warning;
    EXPECT_NE(chosen.warning.find("nearlight tune"), std::string::npos) << chosen.warning;
}

TEST(Tunables, OnlyTheKernelsThatWereMeasuredMakeThemOld) {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name) << text;
    };
    write("measured.cl", "#include \"included.cl\"\n");
    write("included.cl", "// one\n");
    write("other.cl", "// one\n");
    const std::vector<std::string> kernels{"measured.cl"};
    store_tunables(unusual(), kernels, make_entry(), folder.path(), folder.path());
    const auto is_tuned = [&] {
        return choose_tunables(make_entry(), folder.path(), folder.path()).is_tuned;
    };
    EXPECT_TRUE(is_tuned());
    write("other.cl", "// two\n");
    EXPECT_TRUE(is_tuned());
    write("included.cl", "// two\n");
    EXPECT_FALSE(is_tuned());
    write("included.cl", "// one\n");
    EXPECT_TRUE(is_tuned());
    std::filesystem::remove(folder / "measured.cl");
    EXPECT_FALSE(is_tuned());
    EXPECT_THROW(store_tunables(unusual(), kernels, make_entry(), folder.path(), folder.path()), Error);
}

TEST(Tunables, DamagedFilesAreRefusedWithAWarning) {
    const TemporaryFolder folder;
    store_tunables(unusual(), measured_kernels(), make_entry(), folder.path(), {});
    const std::filesystem::path file = tunables_file(make_entry(), folder.path());
    const std::string whole = text_of(file);
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = whole;
        return text.replace(text.find(from), from.size(), to);
    };
    for (const std::string& text :
         {std::string(), std::string("rubbish"), whole.substr(0, whole.find("launch_ms")),
          with("beam_width 32", "beam_width 33"), with("beam_width 32", "beam_width 512"),
          with("beam_width 32", "beam_width -32"), with("beam_width 32", "beam_width 32 or so"),
          with("beam_width 32", "beam_width"), with("runs_per_unit 7", "runs_per_unit 99999999999999999999"),
          with("runs_per_unit 7", "local_size 8"), with("tunables 3", "tunables 2")}) {
        std::ofstream(file) << text;
        const ChosenTunables chosen = choose_tunables(make_entry(), folder.path(), {});
        EXPECT_EQ(chosen.values, tunables_row(DeviceKind::cpu).values) << text;
        EXPECT_NE(chosen.warning.find(file.string()), std::string::npos) << text;
    }
    std::ofstream(file) << whole;
    EXPECT_TRUE(choose_tunables(make_entry(), folder.path(), {}).is_tuned);
}

}  // namespace
}  // namespace nearlight::core
