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

Image picture_of(int width, float value) {
    Image image{.width = width, .height = 1, .channels = picture_channels()};
    image.values.assign(static_cast<std::size_t>(width) * image.channels.size(), value);
    return with_file_layers(image);
}

std::string bytes_of(const Image& image) {
    return {reinterpret_cast<const char*>(image.values.data()), image.values.size() * sizeof(float)};
}

/// It ends only when all is sent.
TEST(TevSender, SendsWhatFilesGet) {
    TevPort port;
    const Image picture = picture_of(2, 0.5f);
    {
        TevSender sender(port.address(), "room");
        port.take_connection();
        sender.send(picture);
    }
    const std::string created = port.packet();
    EXPECT_NE(created.find("room"), std::string::npos);
    EXPECT_NE(created.find("closerange.Y"), std::string::npos);
    EXPECT_EQ(created.find("variance"), std::string::npos);
    EXPECT_TRUE(port.packet().ends_with(bytes_of(picture)));
}

/// Pictures that come faster than the network takes them are passed over, but never the last one.
TEST(TevSender, TheLatestPictureArrives) {
    TevPort port;
    const Image last = picture_of(3, 7.0f);
    {
        TevSender sender(port.address(), "room");
        port.take_connection();
        for (int i = 0; i < 20; ++i) {
            sender.send(picture_of(3, static_cast<float>(i)));
        }
        sender.send(last);
    }
    port.packet();
    const std::string end = bytes_of(last);
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
    const Image picture = picture_of(512 * 512, 1.0f);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    while (sender.error().empty() && std::chrono::steady_clock::now() < end) {
        sender.send(picture);
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
