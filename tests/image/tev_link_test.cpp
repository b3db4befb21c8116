// SPDX-License-Identifier: Apache-2.0
#include "host/image/tev_link.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// A port of this machine on which someone listens, as tev does.
class TevPort {
  public:
    TevPort() : listening_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        bind(listening_, reinterpret_cast<sockaddr*>(&place), sizeof place);
        listen(listening_, 1);
        socklen_t size = sizeof place;
        getsockname(listening_, reinterpret_cast<sockaddr*>(&place), &size);
        port_ = ntohs(place.sin_port);
    }
    ~TevPort() { close_all(); }
    TevPort(const TevPort&) = delete;
    TevPort& operator=(const TevPort&) = delete;

    [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
    void close_all() {
        for (int* const one : {&listening_, &connection_}) {
            if (*one >= 0) {
                close(*one);
                *one = -1;
            }
        }
    }
    void take_connection() { connection_ = accept(listening_, nullptr, nullptr); }
    /// The next packet, without its length.
    std::string packet() {
        const std::string head = bytes(4);
        std::uint32_t length = 0;
        std::memcpy(&length, head.data(), 4);
        return bytes(length - 4);
    }

  private:
    std::string bytes(std::size_t count) {
        std::string all(count, 0);
        std::size_t got = 0;
        while (got < count) {
            const ssize_t more = recv(connection_, all.data() + got, count - got, 0);
            if (more <= 0) {
                ADD_FAILURE() << "a packet ends after " << got << " of " << count << " bytes";
                break;
            }
            got += static_cast<std::size_t>(more);
        }
        return all;
    }

    int listening_;
    int connection_ = -1;
    int port_ = 0;
};

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

TEST(TevLink, SaysThatTevIsGone) {
    TevPort port;
    TevLink link(port.address());
    port.take_connection();
    port.close_all();
    const Image image = make_image(512, 512, kChannels);
    EXPECT_THROW(
        for (int i = 0; i < 50; ++i) { link.show("room", image); }, Error);
}

}  // namespace
}  // namespace nearlight::core
