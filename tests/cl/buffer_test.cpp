// SPDX-License-Identifier: Apache-2.0
#include "host/cl/buffer.h"

#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>

#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"
#include "tests/support/kernel_probe.h"

namespace nearlight::core {
namespace {

using test::error_of;
using test::mentions;

class BufferTest : public test::DeviceTest {};

/// Holds back everything that is enqueued after it until open() or its destruction.
class Gate {
  public:
    explicit Gate(Device& device) : event_(device.context()) {
        const std::vector<cl::Event> events{event_};
        device.queue().enqueueBarrierWithWaitList(&events);
    }
    ~Gate() { open(); }
    Gate(const Gate&) = delete;
    Gate& operator=(const Gate&) = delete;

    void open() {
        if (!std::exchange(is_open_, true)) {
            event_.setStatus(CL_COMPLETE);
        }
    }

  private:
    cl::UserEvent event_;
    bool is_open_ = false;
};

/// Counts the buffers whose memory OpenCL has released. It outlives them, because their callbacks use it.
std::atomic<int> deleted_buffers{0};

void count_when_deleted(const Buffer<uint>& buffer) {
    cl::Buffer handle = buffer.handle();
    handle.setDestructorCallback([](cl_mem, void*) { ++deleted_buffers; });
}

/// Drivers may delete a buffer a little after the command that used it has finished.
int deleted_buffers_after_a_while(int expected) {
    for (int i = 0; i < 1000 && deleted_buffers < expected; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return deleted_buffers;
}

std::vector<uint> ascending(std::size_t count) {
    std::vector<uint> values(count);
    std::iota(values.begin(), values.end(), 0u);
    return values;
}

TEST_F(BufferTest, GivesBackWhatWasPutIn) {
    on_each_device([](Device& device) {
        for (const std::size_t count : {0u, 1u, 1000u, 1u << 20u}) {
            const std::vector<uint> values = ascending(count);
            EXPECT_EQ(Buffer<uint>(device, values).download(), values);
        }
    });
}

TEST_F(BufferTest, PartsGoWhereTheyShould) {
    on_each_device([](Device& device) {
        Buffer<uint> buffer(device, ascending(10));
        buffer.upload(std::vector<uint>{100, 101}, 4);
        EXPECT_EQ(buffer.download(), (std::vector<uint>{0, 1, 2, 3, 100, 101, 6, 7, 8, 9}));
        EXPECT_EQ(buffer.download_one(5), 101u);
        std::vector<uint> part(3);
        buffer.download(part, 7);
        EXPECT_EQ(part, (std::vector<uint>{7, 8, 9}));
        buffer.fill_zero();
        EXPECT_EQ(buffer.download(), std::vector<uint>(10));
    });
}

TEST_F(BufferTest, PartsBeyondTheEndAreRefused) {
    on_each_device([](Device& device) {
        Buffer<uint> buffer(device, ascending(10));
        EXPECT_THROW(buffer.upload(std::vector<uint>{1, 2}, 9), Error);
        EXPECT_THROW((void)buffer.download_one(10), Error);
        EXPECT_EQ(buffer.download(), ascending(10));
    });
}

TEST_F(BufferTest, MovingHandsOverTheMemoryAndItsAccount) {
    on_each_device([](Device& device) {
        const std::size_t before = device.peak_bytes();
        {
            Buffer<uint> first(device, ascending(100));
            Buffer<uint> second = std::move(first);
            first = Buffer<uint>(device, ascending(50));
            EXPECT_EQ(second.download(), ascending(100));
            second = std::move(first);
            EXPECT_EQ(second.download(), ascending(50));
        }
        Buffer<uint> later(device, 150);
        EXPECT_EQ(device.peak_bytes() - before, 150 * sizeof(uint)) << "released memory is still counted";
    });
}

TEST_F(BufferTest, CountsMemoryThatEndsInOtherThreads) {
    on_each_device([](Device& device) {
        const std::size_t before = device.peak_bytes();
        {
            std::vector<std::jthread> threads;
            for (int i = 0; i < 4; ++i) {
                threads.emplace_back([&] {
                    for (int round = 0; round < 50'000; ++round) {
                        device.add_allocated(1);
                        device.remove_allocated(1);
                    }
                });
            }
        }
        EXPECT_LE(device.peak_bytes(), before + 4);
        const std::size_t more = before + 1000;
        device.add_allocated(more);
        EXPECT_EQ(device.peak_bytes(), more) << "all that was added is gone";
        device.remove_allocated(more);
    });
}

TEST_F(BufferTest, LivesOnForKernelsThatWaitToRun) {
    on_each_device([](Device& shared) {
        test::KernelProbe add(shared,
                              "kernel void probe(global const uint* from, global uint* to, uint count) {\n"
                              "    const uint i = get_global_id(0);\n"
                              "    if (i < count) {\n        to[i] += from[i];\n    }\n}\n");
        for (const std::size_t count : {std::size_t{1000}, kMinHugeBytes / sizeof(uint)}) {
            constexpr int kBuffers = 8;
            deleted_buffers = 0;
            const std::vector<uint> ones(count, 1);
            Buffer<uint> sum(add.device(), std::vector<uint>(count, 0));
            std::vector<Buffer<uint>> addends;
            for (int i = 0; i < kBuffers; ++i) {
                count_when_deleted(addends.emplace_back(add.device(), ones));
            }
            Gate gate(add.device());
            for (const Buffer<uint>& addend : addends) {
                add.kernel().launch_items(count, addend, sum, static_cast<uint>(count));
            }
            addends.clear();
            EXPECT_EQ(deleted_buffers, 0) << count;
            gate.open();
            EXPECT_EQ(sum.download(), std::vector<uint>(count, kBuffers)) << count;
            EXPECT_EQ(deleted_buffers_after_a_while(kBuffers), kBuffers) << count;
        }
    });
}

TEST_F(BufferTest, MoreThanTheDeviceAllowsIsOutOfMemory) {
    on_each_device([](Device& device) {
        const std::size_t count = device.entry().max_allocation_bytes / sizeof(uint) + 1;
        const Error error = error_of([&] { Buffer<uint>(device, count); });
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        EXPECT_TRUE(mentions(error, device.name()));
        EXPECT_TRUE(mentions(error, "MiB"));
    });
}

TEST_F(BufferTest, CountsWhoseBytesOverflowAreOutOfMemoryToo) {
    on_each_device([](Device& device) {
        const std::size_t count = std::numeric_limits<std::size_t>::max() / sizeof(uint) + 2;
        EXPECT_EQ(error_of([&] { Buffer<uint>(device, count); }).kind(), ErrorKind::out_of_memory);
    });
}

}  // namespace
}  // namespace nearlight::core
