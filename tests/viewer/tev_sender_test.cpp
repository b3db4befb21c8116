// SPDX-License-Identifier: Apache-2.0
#include "viewer/tev_sender.h"

#include <gtest/gtest.h>

#include <chrono>

#include "nearlight/error.h"
#include "tests/support/tev_port.h"
#include "viewer/channels.h"

namespace nearlight::viewer {
namespace {

using core::test::TevPort;

std::shared_ptr<const Frame> frame_of(int width, float value) {
    auto frame = std::make_shared<Frame>();
    frame->image = {.width = width, .height = 1, .channels = picture_channels()};
    frame->image.values.assign(static_cast<std::size_t>(width) * frame->image.channels.size(), value);
    frame->smoothed = frame->image;
    frame->smoothed->values.assign(frame->image.values.size(), -1.0f);
    return frame;
}

std::string bytes_of(const Image& image) {
    return {reinterpret_cast<const char*>(image.values.data()), image.values.size() * sizeof(float)};
}

/// Without the layers that files get only on demand, and not smoothed. It ends only when all is sent.
TEST(TevSender, SendsWhatFilesGet) {
    TevPort port;
    const auto frame = frame_of(2, 0.5f);
    const Image expected = with_file_layers(frame->image);
    {
        TevSender sender(port.address(), "room");
        port.take_connection();
        sender.send(frame);
    }
    const std::string created = port.packet();
    EXPECT_NE(created.find("room"), std::string::npos);
    EXPECT_NE(created.find("closerange.Y"), std::string::npos);
    EXPECT_EQ(created.find("variance"), std::string::npos);
    EXPECT_TRUE(port.packet().ends_with(bytes_of(expected)));
}

/// Pictures that come faster than the network takes them are passed over, but never the last one.
TEST(TevSender, TheLatestFrameArrives) {
    TevPort port;
    const auto last = frame_of(3, 7.0f);
    {
        TevSender sender(port.address(), "room");
        port.take_connection();
        for (int i = 0; i < 20; ++i) {
            sender.send(frame_of(3, static_cast<float>(i)));
        }
        sender.send(last);
    }
    port.packet();
    const std::string end = bytes_of(with_file_layers(last->image));
    int updates = 1;
    while (updates < 21 && !port.packet().ends_with(end)) {
        ++updates;
    }
    EXPECT_LE(updates, 21);
}

TEST(TevSender, SaysThatTevIsGone) {
    TevPort port;
    TevSender sender(port.address(), "room");
    port.take_connection();
    port.close_all();
    const auto frame = frame_of(512 * 512, 1.0f);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    while (sender.error().empty() && std::chrono::steady_clock::now() < end) {
        sender.send(frame);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_NE(sender.error().find("takes no more pictures"), std::string::npos) << sender.error();
}

TEST(TevSender, SaysThatNobodyListens) {
    TevPort port;
    const std::string address = port.address();
    port.close_all();
    EXPECT_THROW(TevSender(address, "room"), Error);
}

}  // namespace
}  // namespace nearlight::viewer
