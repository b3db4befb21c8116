// SPDX-License-Identifier: Apache-2.0
#include "host/image/tev_link.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <thread>

#include "nearlight/error.h"
#include "tests/support/tev_port.h"

namespace nearlight::core {
namespace {

using test::TevPort;

template <typename Number>
std::string number(Number value) {
    std::string text(sizeof value, 0);
    std::memcpy(text.data(), &value, sizeof value);
    return text;
}

std::string word(const std::string& text) {
    return text + '\0';
}

const std::vector<std::string> kChannels{"R", "depth.Z"};

TEST(TevLink, SendsThePacketsOfTheProtocol) {
    TevPort port;
    TevLink link(port.address());
    port.take_connection();
    const std::vector<float> row{1.0f, 2.0f, 3.0f, 4.0f};
    link.create("room", 2, 3, kChannels);
    link.update("room", 1, 2, kChannels, row);
    using std::int32_t, std::int64_t;
    EXPECT_EQ(port.packet(), std::string("\4\0", 2) + word("room") + number(int32_t{2}) + number(int32_t{3}) +
                                 number(int32_t{2}) + word("R") + word("depth.Z"));
    EXPECT_EQ(port.packet(), std::string("\6\0", 2) + word("room") + number(int32_t{2}) + word("R") +
                                 word("depth.Z") + number(int32_t{0}) + number(int32_t{1}) +
                                 number(int32_t{2}) + number(int32_t{1}) + number(int64_t{0}) +
                                 number(int64_t{1}) + number(int64_t{2}) + number(int64_t{2}) + number(1.0f) +
                                 number(2.0f) + number(3.0f) + number(4.0f));
}

std::string error_of(const std::string& address, ErrorKind kind) {
    try {
        const TevLink link(address);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind);
        return error.what();
    }
    ADD_FAILURE() << "connected to " << address;
    return "";
}

TEST(TevLink, SaysThatNobodyListens) {
    TevPort port;
    const std::string address = port.address();
    port.close_all();
    EXPECT_NE(error_of(address, ErrorKind::failure).find("start tev first"), std::string::npos);
}

TEST(TevLink, RefusesWhatIsNoAddress) {
    for (const char* const address :
         {"", ":14158", "localhost:", "localhost:tev", "localhost:99999", "[::1"}) {
        error_of(address, ErrorKind::invalid_argument);
    }
}

/// What is said when a link that sends 100 MB fails.
std::string error_of_sending(TevLink& link) {
    const Image image = make_image(512, 512, kChannels);
    try {
        for (int i = 0; i < 50; ++i) {
            link.create("room", image.width, image.height, image.channels);
            link.update("room", 0, image.width, image.channels, image.values);
        }
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::failure);
        return error.what();
    }
    ADD_FAILURE() << "everything was sent";
    return "";
}

TEST(TevLink, SaysThatTevIsGone) {
    TevPort port;
    TevLink link(port.address());
    port.take_connection();
    port.close_all();
    const std::string error = error_of_sending(link);
    EXPECT_TRUE(error.starts_with("tev at ")) << error;
    EXPECT_NE(error.find(" takes no more pictures ("), std::string::npos) << error;
}

TEST(TevLink, SaysThatTevDoesNotRead) {
    TevPort port;
    TevLink link(port.address());
    port.take_connection();
    EXPECT_EQ(error_of_sending(link),
              "tev at " + port.address() + " takes no more pictures (it has not read for 2 s)");
}

/// What a socket does not take at once waits until tev reads.
TEST(TevLink, WaitsWhileTevReads) {
    TevPort port;
    std::jthread tev;  // ends when the link does
    TevLink link(port.address());
    port.take_connection();
    const Image image = make_image(1024, 1024, kChannels);
    const std::size_t half = image.values.size() / 2 * sizeof(float);
    tev = std::jthread([&port, half] {
        for (int i = 0; i < 8; ++i) {
            EXPECT_GT(port.packet().size(), half) << i;
        }
    });
    for (int i = 0; i < 4; ++i) {
        link.update("room", 0, image.width, image.channels, image.values);
    }
}

}  // namespace
}  // namespace nearlight::core
