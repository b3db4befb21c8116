// SPDX-License-Identifier: Apache-2.0
// Receivers and what arrives at them, in the packets of 64 that kernels work on.
#pragma once

#include <span>

#include "host/base/division.h"
#include "host/base/math.h"

namespace nearlight::core {

/// A point on a surface that is to be lit.
struct ReceiverPoint {
    Vec3 position;
    Vec3 normal;  ///< zero if the receiver is absent
};

/// The number of packets for `receiver_count` receivers.
constexpr std::size_t receiver_packet_count(std::size_t receiver_count) {
    return divide_rounding_up(receiver_count, NEARLIGHT_PACKET_SIZE);
}

inline ReceiverPoint receiver_at(const ReceiverPacket& packet, std::size_t lane) {
    return {{packet.px[lane], packet.py[lane], packet.pz[lane]},
            {packet.nx[lane], packet.ny[lane], packet.nz[lane]}};
}
/// The receiver in lane number `index`, counted over all packets.
inline ReceiverPoint receiver_at(std::span<const ReceiverPacket> packets, std::size_t index) {
    return receiver_at(packets[index / NEARLIGHT_PACKET_SIZE], index % NEARLIGHT_PACKET_SIZE);
}
/// How many receivers of the packet are not absent.
inline std::size_t present_count(const ReceiverPacket& packet) {
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        count += is_zero(receiver_at(packet, lane).normal) ? 0 : 1;
    }
    return count;
}
inline void set_receiver(ReceiverPacket& packet, std::size_t lane, const ReceiverPoint& receiver) {
    packet.px[lane] = receiver.position.x;
    packet.py[lane] = receiver.position.y;
    packet.pz[lane] = receiver.position.z;
    packet.nx[lane] = receiver.normal.x;
    packet.ny[lane] = receiver.normal.y;
    packet.nz[lane] = receiver.normal.z;
}

/// What arrives (R, G, B) at lane number `index`, counted over all packets; W/m² in irradiance packets.
template <typename Packet>
Vec3 arrived_at(std::span<const Packet> packets, std::size_t index) {
    const Packet& packet = packets[index / NEARLIGHT_PACKET_SIZE];
    const std::size_t lane = index % NEARLIGHT_PACKET_SIZE;
    return {packet.r[lane], packet.g[lane], packet.b[lane]};
}
inline Vec3 irradiance_at(std::span<const IrradiancePacket> packets, std::size_t index) {
    return arrived_at(packets, index);
}

}  // namespace nearlight::core
