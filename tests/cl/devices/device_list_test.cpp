// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/device_list.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using test::error_of;
using test::mentions;

DeviceEntry entry(int index, const std::string& name, DeviceKind kind, const std::string& unusable = "") {
    DeviceEntry result;
    result.index = index;
    result.name = name;
    result.platform = "Some Platform";
    result.kind = kind;
    result.unusable_because = unusable;
    return result;
}

/// Unsets NEARLIGHT_DEVICE, on which the choice depends and which may be set on this machine.
class ChooseDevices : public ::testing::Test {
  protected:
    void SetUp() override { unsetenv("NEARLIGHT_DEVICE"); }
    void TearDown() override { unsetenv("NEARLIGHT_DEVICE"); }

    static DeviceList some_devices() {
        return {.devices = {entry(0, "pthread-Common CPU", DeviceKind::cpu),
                            entry(1, "Broken GPU", DeviceKind::gpu, "its driver has no compiler"),
                            entry(2, "Fast GPU", DeviceKind::gpu), entry(3, "Other GPU", DeviceKind::gpu)},
                .problems = {}};
    }
    static std::vector<int> chosen(const std::string& choice) {
        std::vector<int> indices;
        for (const DeviceEntry& device : choose_devices(some_devices(), choice)) {
            indices.push_back(device.index);
        }
        return indices;
    }
};

using Indices = std::vector<int>;

TEST_F(ChooseDevices, ByIndexAndByPartOfANameInAnyCase) {
    EXPECT_EQ(chosen("0"), Indices{0});
    EXPECT_EQ(chosen("3"), Indices{3});
    EXPECT_EQ(chosen("fast"), Indices{2});
    EXPECT_EQ(chosen("COMMON"), Indices{0});
    EXPECT_EQ(chosen("some platform"), Indices{0});
}

TEST_F(ChooseDevices, ByKindAndAll) {
    EXPECT_EQ(chosen("cpu"), Indices{0});
    EXPECT_EQ(chosen("all"), (Indices{0, 2, 3})) << "what cannot be used is left out";
}

TEST_F(ChooseDevices, AListGivesEachOnceInItsOrder) {
    EXPECT_EQ(chosen("3,0"), (Indices{3, 0}));
    EXPECT_EQ(chosen("cpu,fast,2,cpu"), (Indices{0, 2}));
    EXPECT_EQ(chosen("other,all"), (Indices{3, 0, 2}));
}

TEST_F(ChooseDevices, AListWithAnUnknownOrEmptyItemIsRefused) {
    for (const char* choice : {"0,17", ",", "0,,2"}) {
        EXPECT_EQ(error_of([&] { chosen(choice); }).kind(), ErrorKind::no_device) << choice;
    }
}

TEST_F(ChooseDevices, WhatCannotBeSplitSaysSo) {
    const Error error = error_of([] { chosen("0/2"); });
    EXPECT_EQ(error.kind(), ErrorKind::no_device);
    EXPECT_TRUE(mentions(error, "pthread-Common CPU"));
    EXPECT_TRUE(mentions(error, "1 to 1 parts"));
    EXPECT_EQ(error_of([] { chosen("0/0"); }).kind(), ErrorKind::no_device);
    EXPECT_EQ(error_of([] { chosen("0/x"); }).kind(), ErrorKind::no_device) << "is no name either";
}

TEST_F(ChooseDevices, PartsOfARealDevice) {
    const DeviceList list = list_devices();
    for (const DeviceEntry& whole : list.devices) {
        if (whole.max_parts < 2 || !whole.unusable_because.empty()) {
            continue;
        }
        const std::string index = std::to_string(whole.index);
        const std::vector<DeviceEntry> halves = choose_devices(list, index + "/2");
        ASSERT_EQ(halves.size(), 2u);
        for (const DeviceEntry& half : halves) {
            EXPECT_EQ(half.compute_units, whole.compute_units / 2);
            EXPECT_EQ(half.index, whole.index);
            EXPECT_EQ(half.name, whole.name);
            EXPECT_NE(half.label(), whole.label());
        }
        EXPECT_NE(halves[0].part, halves[1].part);
        const std::vector<DeviceEntry> second = choose_devices(list, index + "/2.1," + index + "/2.1");
        ASSERT_EQ(second.size(), 1u);
        EXPECT_EQ(second[0].part, halves[1].part);
        EXPECT_TRUE(mentions(error_of([&] { choose_devices(list, index + "/2.2"); }), "0 to 1"));
        const std::string too_many = std::to_string(whole.max_parts + 1);
        EXPECT_EQ(error_of([&] { choose_devices(list, index + "/" + too_many); }).kind(),
                  ErrorKind::no_device);
    }
}

TEST_F(ChooseDevices, TheKindSkipsDevicesThatCannotBeUsed) {
    EXPECT_EQ(chosen("gpu"), Indices{2});
}

TEST_F(ChooseDevices, WithoutAChoiceTheFirstUsableGpuElseTheFirstCpuElseTheFirst) {
    EXPECT_EQ(chosen(""), Indices{2});
    DeviceList list{.devices = {entry(0, "FPGA emulator", DeviceKind::other)}, .problems = {}};
    EXPECT_EQ(choose_devices(list, "").at(0).index, 0);
    list.devices.push_back(entry(1, "CPU", DeviceKind::cpu));
    EXPECT_EQ(choose_devices(list, "").at(0).index, 1);
}

TEST(KernelsMiss, VersionsBelow12AndEmbeddedProfiles) {
    EXPECT_EQ(what_kernels_miss({"OpenCL 1.2 x", "OpenCL C 1.2"}, "FULL_PROFILE"), "");
    EXPECT_EQ(what_kernels_miss({"OpenCL 3.0 PoCL HSTR: 1.1", "OpenCL C 10.0"}, "FULL_PROFILE"), "");
    EXPECT_EQ(what_kernels_miss({"no number"}, "FULL_PROFILE"), "");
    EXPECT_EQ(what_kernels_miss({"OpenCL 1.1 Mesa", "OpenCL C 1.1"}, "FULL_PROFILE"),
              "it has OpenCL 1.1 Mesa, and the kernels need 1.2");
    EXPECT_NE(what_kernels_miss({"OpenCL 1.2", "OpenCL C 1.1"}, "FULL_PROFILE"), "");
    EXPECT_NE(what_kernels_miss({"OpenCL 3.0", "OpenCL C 1.2"}, "EMBEDDED_PROFILE"), "");
}

TEST_F(ChooseDevices, TheEnvironmentChoosesWhereNothingElseDoes) {
    setenv("NEARLIGHT_DEVICE", "other", 1);
    EXPECT_EQ(chosen(""), Indices{3});
    EXPECT_EQ(chosen("cpu"), Indices{0});
}

TEST_F(ChooseDevices, NoMatchListsWhatThereIs) {
    for (const char* choice : {"riva tnt", "17"}) {
        const Error error = error_of([&] { chosen(choice); });
        EXPECT_EQ(error.kind(), ErrorKind::no_device);
        EXPECT_TRUE(mentions(error, choice));
        EXPECT_TRUE(mentions(error, "0 = pthread-Common CPU"));
        EXPECT_TRUE(mentions(error, "2 = Fast GPU"));
    }
}

TEST_F(ChooseDevices, ADeviceThatCannotBeUsedSaysWhy) {
    const Error error = error_of([] { chosen("1"); });
    EXPECT_EQ(error.kind(), ErrorKind::no_device);
    EXPECT_TRUE(mentions(error, "Broken GPU"));
    EXPECT_TRUE(mentions(error, "its driver has no compiler"));
}

TEST_F(ChooseDevices, NoDeviceAtAllSaysWhatToInstall) {
    for (const char* choice : {"", "all", "gpu"}) {
        const Error error = error_of([&] { choose_devices({}, choice); });
        EXPECT_EQ(error.kind(), ErrorKind::no_device);
        EXPECT_TRUE(mentions(error, "pocl-opencl-icd"));
    }
    const DeviceList broken{.devices = {}, .problems = {"platform 'X' is broken"}};
    EXPECT_TRUE(mentions(error_of([&] { choose_devices(broken, ""); }), "platform 'X' is broken"));
}

std::size_t variable_count() {
    std::size_t count = 0;
    while (environ[count] != nullptr) {
        ++count;
    }
    return count;
}

/// Other threads may read the environment meanwhile, which is no longer safe once a variable is new.
TEST(DeviceList, DriversThatLookForDevicesAddNoVariable) {
    set_driver_defaults();
    const std::size_t before = variable_count();
    list_devices();
    EXPECT_EQ(variable_count(), before);
}

TEST(DeviceList, EntriesAreNumberedInOrderAndDescribed) {
    const DeviceList list = list_devices();
    for (std::size_t i = 0; i < list.devices.size(); ++i) {
        const DeviceEntry& device = list.devices[i];
        EXPECT_EQ(device.index, static_cast<int>(i));
        EXPECT_FALSE(device.name.empty());
        EXPECT_NE(device.name.back(), '\0');
        EXPECT_GT(device.compute_units, 0u);
        EXPECT_GT(device.max_allocation_bytes, 0u);
        EXPECT_LE(device.max_allocation_bytes, device.global_bytes);
    }
}

}  // namespace
}  // namespace nearlight::core
