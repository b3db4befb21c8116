// SPDX-License-Identifier: Apache-2.0
#include "host/image/tev_link.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr int kConnectMilliseconds = 3000;
/// How long tev may read nothing while there is something to send. The render waits meanwhile.
constexpr std::chrono::seconds kSendTime{2};
/// Rows are sent in packets of about this many floats.
constexpr std::size_t kFloatsPerPacket = std::size_t{1} << 20u;

// The kinds of packets, as tev numbers them.
constexpr char kUpdateImage = 6;  ///< with offsets and strides of channels
constexpr char kCreateImage = 4;

/// A packet while it is put together.
class TevPacket {
  public:
    explicit TevPacket(char kind) {
        put(std::uint32_t{0});  // the length is known at the end
        bytes_.push_back(kind);
        bytes_.push_back(0);  // does not take the focus
    }
    void put(const std::string& text) {
        bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
    }
    void put(std::uint32_t value) { put_little_endian(value); }
    void put(std::int32_t value) { put_little_endian(static_cast<std::uint32_t>(value)); }
    void put(std::int64_t value) { put_little_endian(static_cast<std::uint64_t>(value)); }
    void put(std::span<const float> values) {
        static_assert(std::endian::native == std::endian::little);
        const char* const begin = reinterpret_cast<const char*>(values.data());
        bytes_.insert(bytes_.end(), begin, begin + values.size_bytes());
    }
    void put(std::span<const std::string> names) {
        for (const std::string& name : names) {
            put(name);
        }
    }
    std::span<const char> finish() {
        const auto length = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &length, sizeof length);
        return bytes_;
    }

  private:
    template <typename Unsigned>
    void put_little_endian(Unsigned value) {
        for (std::size_t i = 0; i < sizeof value; ++i) {
            bytes_.push_back(static_cast<char>(value >> (8 * i)));
        }
    }
    std::vector<char> bytes_;
};

struct HostAndPort {
    std::string host;
    std::string port = kTevPort;
};

HostAndPort split(const std::string& address) {
    HostAndPort parts{.host = address};
    const bool has_brackets = address.starts_with('[');
    const std::size_t end = has_brackets ? address.find(']') : std::string::npos;
    const std::size_t colon = has_brackets ? address.find(':', end) : address.rfind(':');
    if (has_brackets) {
        parts.host = end == std::string::npos ? "" : address.substr(1, end - 1);
    } else if (colon != std::string::npos) {
        parts.host = address.substr(0, colon);
    }
    if (colon != std::string::npos) {
        parts.port = address.substr(colon + 1);
    }
    const bool is_number = !parts.port.empty() && parts.port.size() <= 5 &&
                           std::ranges::all_of(parts.port, [](char c) { return c >= '0' && c <= '9'; });
    if (parts.host.empty() || !is_number || std::stoi(parts.port) > 65535) {
        throw Error(ErrorKind::invalid_argument,
                    "'" + address + "' is no address of tev; give HOST:PORT, as in localhost:" + kTevPort);
    }
    return parts;
}

/// Connects within kConnectMilliseconds, and leaves the socket one that never waits by itself. Returns an
/// error number, or 0.
int connect_in_time(int socket, const addrinfo& to) {
    fcntl(socket, F_SETFL, O_NONBLOCK);
    if (connect(socket, to.ai_addr, to.ai_addrlen) != 0) {
        if (errno != EINPROGRESS) {
            return errno;
        }
        pollfd waiting{.fd = socket, .events = POLLOUT, .revents = 0};
        if (poll(&waiting, 1, kConnectMilliseconds) != 1) {
            return ETIMEDOUT;
        }
        int error = 0;
        socklen_t size = sizeof error;
        getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
        if (error != 0) {
            return error;
        }
    }
    return 0;
}

/// Waits until a good part of what was sent is read, at most for kSendTime. The time limit of a socket would
/// begin anew with every few bytes that a full socket still takes.
bool waits_for_reader(int socket) {
    const auto end = std::chrono::steady_clock::now() + kSendTime;
    pollfd waiting{.fd = socket, .events = POLLOUT, .revents = 0};
    int ready = 0;
    do {
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        ready = poll(&waiting, 1, std::max(0, static_cast<int>(left.count())));
    } while (ready < 0 && errno == EINTR);
    return ready > 0;
}

[[noreturn]] void fail_to_connect(const std::string& address, const std::string& reason) {
    throw Error(ErrorKind::failure, "cannot reach tev at " + address + " (" + reason +
                                        "); start tev first, or correct the address");
}

int open_connection(const std::string& address) {
    const HostAndPort parts = split(address);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int error = getaddrinfo(parts.host.c_str(), parts.port.c_str(), &hints, &found); error != 0) {
        fail_to_connect(address, gai_strerror(error));
    }
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> places(found, freeaddrinfo);
    int error = EADDRNOTAVAIL;
    for (const addrinfo* place = found; place != nullptr; place = place->ai_next) {
        const int connection =
            socket(place->ai_family, place->ai_socktype | SOCK_CLOEXEC, place->ai_protocol);
        error = connection < 0 ? errno : connect_in_time(connection, *place);
        if (error == 0) {
            return connection;
        }
        if (connection >= 0) {
            close(connection);
        }
    }
    fail_to_connect(address, std::strerror(error));
}

}  // namespace

TevLink::TevLink(const std::string& address) : address_(address), socket_(open_connection(address)) {}

TevLink::~TevLink() {
    close(socket_);
}

void TevLink::create(const std::string& name, int width, int height, std::span<const std::string> channels) {
    TevPacket packet(kCreateImage);
    packet.put(name);
    packet.put(std::int32_t{width});
    packet.put(std::int32_t{height});
    packet.put(static_cast<std::int32_t>(channels.size()));
    packet.put(channels);
    send(packet.finish());
}

void TevLink::update(const std::string& name, int first, int width, std::span<const std::string> channels,
                     std::span<const float> values) {
    const std::size_t row_floats = static_cast<std::size_t>(width) * channels.size();
    const std::size_t rows_per_packet = std::max<std::size_t>(1, kFloatsPerPacket / row_floats);
    const std::size_t row_count = values.size() / row_floats;
    for (std::size_t row = 0; row < row_count; row += rows_per_packet) {
        const std::size_t count = std::min(rows_per_packet, row_count - row);
        TevPacket packet(kUpdateImage);
        packet.put(name);
        packet.put(static_cast<std::int32_t>(channels.size()));
        packet.put(channels);
        packet.put(std::int32_t{0});
        packet.put(static_cast<std::int32_t>(first + static_cast<int>(row)));
        packet.put(std::int32_t{width});
        packet.put(static_cast<std::int32_t>(count));
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            packet.put(static_cast<std::int64_t>(channel));  // offset
        }
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            packet.put(static_cast<std::int64_t>(channels.size()));  // stride
        }
        packet.put(values.subspan(row * row_floats, count * row_floats));
        send(packet.finish());
    }
}

void TevLink::send(std::span<const char> packet) {
    while (!packet.empty()) {
        const ssize_t sent = ::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL);
        if (sent > 0) {
            packet = packet.subspan(static_cast<std::size_t>(sent));
            continue;
        }
        const int error = errno;
        const bool is_full = error == EAGAIN;
        if (error == EINTR || (is_full && waits_for_reader(socket_))) {
            continue;
        }
        const std::string reason = is_full ? "it has not read for " + std::to_string(kSendTime.count()) + " s"
                                           : std::strerror(error);
        throw Error(ErrorKind::failure, "tev at " + address_ + " takes no more pictures (" + reason + ")");
    }
}

}  // namespace nearlight::core
