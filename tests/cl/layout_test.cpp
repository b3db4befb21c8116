// SPDX-License-Identifier: Apache-2.0
// Checks that sizes and offsets of structs on the device, which kernels/layout_probe.cl finds, are those on
// the host.
#include <gtest/gtest.h>

#include "host/cl/kernel.h"
#include "host/cl/shared_layout.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class LayoutTest : public test::DeviceTest {};

TEST_F(LayoutTest, DeviceAgreesWithHostOnEveryFact) {
    constexpr uint kUnwritten = 0xdeadbeef;
    const std::vector<LayoutFact> facts = shared_layout();
    on_each_device([&](Device& device) {
        Kernel probe(Program(device, "layout_probe.cl"), "layout_probe");
        Buffer<uint> out(device, std::vector<uint>(facts.size() + 64, kUnwritten));
        probe.launch(1, 1, out);
        const std::vector<uint> found = out.download();
        for (std::size_t i = 0; i < facts.size(); ++i) {
            EXPECT_EQ(found[i], facts[i].value) << facts[i].name;
        }
        EXPECT_EQ(found[facts.size()], kUnwritten) << "the probe knows more facts than this test";
    });
}

}  // namespace
}  // namespace nearlight::core
