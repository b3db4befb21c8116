// SPDX-License-Identifier: Apache-2.0
// Messages between the ranks of a job, which are processes of the same program.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/session/remote_devices.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// The leading rank says the first six, the helping ranks the next ones. Helpers pass `picture` on, and all
/// say `alive`.
enum class MessageKind : std::uint32_t {
    picture,       ///< a PictureTask and its VPLs; each helper passes it on to others
    order,         ///< make a band
    end_picture,   ///< forget a picture
    end_job,       ///< make no more bands, and say goodbye
    leave_job,     ///< leave together, since all have said goodbye
    break_up_job,  ///< leave without waiting for others, since one is lost
    hello,         ///< ready, or the reason why not; the body is the text of a Hello
    progress,      ///< how far an ordered band is
    band,          ///< a finished band; the body has its rows
    failed,        ///< a device makes no more bands; the body says why
    goodbye,       ///< the answer to end_job
    alive,         ///< said every second, between the leading rank and each other
};

/// The bytes of some plain values, as a part of a message.
template <typename Values>
std::span<const std::byte> part_of(const Values& values) {
    static_assert(std::is_trivially_copyable_v<std::ranges::range_value_t<Values>>);
    return std::as_bytes(std::span(std::ranges::data(values), std::ranges::size(values)));
}

/// Members without a meaning for a kind of message are 0.
struct MessageHead {
    MessageKind kind{};
    std::uint32_t device = 0;  ///< of the helper
    PictureNumber picture = 0;
    std::uint32_t band = 0;
    ErrorKind error{};
    double fraction = 0;
    std::uint64_t local_lights = 0;
};

class Message {
  public:
    Message() = default;
    explicit Message(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
    /// The body consists of `parts`, one after another.
    explicit Message(const MessageHead& head, std::initializer_list<std::span<const std::byte>> parts = {}) {
        std::size_t size = sizeof(head);
        for (const auto part : parts) {
            size += part.size();
        }
        bytes_.resize(size);
        std::memcpy(bytes_.data(), &head, sizeof(head));
        std::byte* to = bytes_.data() + sizeof(head);
        for (const auto part : parts) {
            to = std::ranges::copy(part, to).out;
        }
    }

    [[nodiscard]] bool is_whole() const { return bytes_.size() >= sizeof(MessageHead); }
    [[nodiscard]] MessageHead head() const { return values_at<MessageHead>(0, 1).front(); }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
    /// The value that the body begins with.
    template <typename T>
    [[nodiscard]] T first() const {
        return values_at<T>(sizeof(MessageHead), 1).front();
    }
    /// The values of the body that begin after `skipped` bytes.
    template <typename T>
    [[nodiscard]] std::vector<T> body(std::size_t skipped = 0) const {
        const std::size_t first = sizeof(MessageHead) + skipped;
        return values_at<T>(first, (bytes_.size() - first) / sizeof(T));
    }
    [[nodiscard]] std::string text() const {
        const std::vector<char> text = body<char>();
        return {text.begin(), text.end()};
    }

  private:
    template <typename T>
    [[nodiscard]] std::vector<T> values_at(std::size_t first, std::size_t count) const {
        std::vector<T> values(count);
        if (count > 0) {
            std::memcpy(static_cast<void*>(values.data()), bytes_.data() + first, count * sizeof(T));
        }
        return values;
    }

    std::vector<std::byte> bytes_;
};

}  // namespace nearlight::core
