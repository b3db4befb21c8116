// SPDX-License-Identifier: Apache-2.0
// Stands for the image viewer tev.
#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <string>

namespace nearlight::core::test {

/// A port of this machine on which someone listens, as tev does.
class TevPort {
  public:
    TevPort() : listening_(socket(AF_INET, SOCK_STREAM, 0)) {
        // What nobody reads has little room, however large the system lets buffers grow.
        const int room = 1 << 20;
        setsockopt(listening_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
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
    /// The next packet, without its length; empty if none comes.
    std::string packet() {
        const std::string head = bytes(4);
        if (head.size() < 4) {
            return "";
        }
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
                all.resize(got);
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

}  // namespace nearlight::core::test
