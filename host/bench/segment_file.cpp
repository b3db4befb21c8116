// SPDX-License-Identifier: Apache-2.0
#include "host/bench/segment_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "host/base/files.h"
#include "host/base/receivers.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and copied as it is");

constexpr std::string_view kMagic = "NLSEGM01";

struct Header {
    std::uint32_t vertex_count, triangle_count, vpl_count, packet_count;
    std::uint64_t ray_count;
    float clamp_radius, t_min, t_max;
    std::uint32_t zero;
};
static_assert(sizeof(Header) == 40);

/// The places of a packet's receivers, which are all that a gather of plain surfaces reads of them.
struct StoredPacket {
    float places[6][NEARLIGHT_PACKET_SIZE];  // px, py, pz, nx, ny, nz
};
static_assert(sizeof(StoredPacket) == offsetof(ReceiverPacket, surface));

struct StoredVpl {
    Vec3 position, normal, power;
};
static_assert(sizeof(StoredVpl) == 36);

struct StoredTriangle {
    std::uint32_t v0, v1, v2;
};

template <typename T>
void append(std::string& bytes, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Reads values one after the other from the file's bytes, which must be long enough.
class Reader {
  public:
    explicit Reader(std::string_view bytes) : rest_(bytes) {}
    template <typename T>
    T take() {
        T value;
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_.remove_prefix(sizeof value);
        return value;
    }

  private:
    std::string_view rest_;
};

/// Words of rays, one for each pair of a packet and a VPL.
std::uint64_t word_count(const Header& header) {
    return std::uint64_t{header.packet_count} * header.vpl_count;
}

/// The size of the whole file. Two counts multiplied may need more bytes than 64 bits count, so a file that
/// cannot hold that many words has to be refused before.
std::uint64_t bytes_of_file(const Header& header) {
    return kMagic.size() + sizeof(Header) + std::uint64_t{header.vertex_count} * sizeof(Vec3) +
           std::uint64_t{header.triangle_count} * sizeof(StoredTriangle) +
           std::uint64_t{header.vpl_count} * sizeof(StoredVpl) +
           std::uint64_t{header.packet_count} * sizeof(StoredPacket) +
           word_count(header) * sizeof(std::uint64_t);
}

bool is_finite(const ReceiverPacket& packet) {
    const float* const values = packet.px;
    return std::all_of(values, values + sizeof packet / sizeof(float),
                       [](float x) { return std::isfinite(x); });
}

std::uint64_t present_lanes(const ReceiverPacket& packet) {
    std::uint64_t lanes = 0;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        lanes |= std::uint64_t{is_zero(receiver_at(packet, lane).normal) ? 0u : 1u} << lane;
    }
    return lanes;
}

/// The first contradiction in the contents; empty if there is none.
std::string complaint(const GatherSegments& segments, std::uint64_t ray_count) {
    const auto finite = [](Vec3 v) { return nearlight::core::is_finite(v); };
    const std::size_t vertices = segments.geometry.vertices.size();
    for (const Vertex& vertex : segments.geometry.vertices) {
        if (!finite(vertex.position)) {
            return "a vertex is not finite";
        }
    }
    for (const Triangle& triangle : segments.geometry.triangles) {
        if (std::max({triangle.v0, triangle.v1, triangle.v2}) >= vertices) {
            return "a triangle names a vertex that is not there";
        }
    }
    for (const Vpl& vpl : segments.vpls) {
        if (!finite(vpl.position) || !finite(vpl.normal) || !finite(vpl.power)) {
            return "a VPL is not finite";
        }
    }
    for (std::size_t packet = 0; packet < segments.receivers.size(); ++packet) {
        if (!is_finite(segments.receivers[packet])) {
            return "a receiver is not finite";
        }
        const std::uint64_t absent = ~present_lanes(segments.receivers[packet]);
        const auto words = std::span(segments.rays).subspan(segments.word(packet, 0), segments.vpls.size());
        if (std::any_of(words.begin(), words.end(),
                        [&](std::uint64_t word) { return (word & absent) != 0; })) {
            return "a ray leads to a receiver that is not there";
        }
    }
    if (count_bits(segments.rays) != ray_count) {
        return "it has " + std::to_string(count_bits(segments.rays)) + " rays, but announces " +
               std::to_string(ray_count);
    }
    return {};
}

bool is_sound(const Header& header) {
    return header.zero == 0 && header.t_min == NEARLIGHT_SEGMENT_T_MIN &&
           header.t_max == NEARLIGHT_SEGMENT_T_MAX && std::isfinite(header.clamp_radius) &&
           header.clamp_radius >= 0.0f;
}

GatherSegments read_arrays(const Header& header, Reader& reader) {
    GatherSegments segments;
    segments.clamp_radius = header.clamp_radius;
    segments.geometry.materials.emplace_back();
    for (std::uint32_t i = 0; i < header.vertex_count; ++i) {
        segments.geometry.vertices.emplace_back().position = reader.take<Vec3>();
    }
    for (std::uint32_t i = 0; i < header.triangle_count; ++i) {
        const auto triangle = reader.take<StoredTriangle>();
        segments.geometry.triangles.push_back({triangle.v0, triangle.v1, triangle.v2, 0});
    }
    for (std::uint32_t i = 0; i < header.vpl_count; ++i) {
        const auto vpl = reader.take<StoredVpl>();
        segments.vpls.push_back({vpl.position, 0, vpl.normal, 0, vpl.power, 0});
    }
    for (std::uint32_t i = 0; i < header.packet_count; ++i) {
        const auto packet = reader.take<StoredPacket>();
        std::memcpy(&segments.receivers.emplace_back(), &packet, sizeof packet);
    }
    for (std::uint64_t i = 0; i < word_count(header); ++i) {
        segments.rays.push_back(reader.take<std::uint64_t>());
    }
    return segments;
}

}  // namespace

void write_segments(const std::filesystem::path& file, const GatherSegments& segments) {
    std::string bytes(kMagic);
    append(bytes, Header{static_cast<std::uint32_t>(segments.geometry.vertices.size()),
                         static_cast<std::uint32_t>(segments.geometry.triangles.size()),
                         static_cast<std::uint32_t>(segments.vpls.size()),
                         static_cast<std::uint32_t>(segments.receivers.size()), count_bits(segments.rays),
                         segments.clamp_radius, NEARLIGHT_SEGMENT_T_MIN, NEARLIGHT_SEGMENT_T_MAX, 0});
    for (const Vertex& vertex : segments.geometry.vertices) {
        append(bytes, vertex.position);
    }
    for (const Triangle& triangle : segments.geometry.triangles) {
        append(bytes, StoredTriangle{triangle.v0, triangle.v1, triangle.v2});
    }
    for (const Vpl& vpl : segments.vpls) {
        append(bytes, StoredVpl{vpl.position, vpl.normal, vpl.power});
    }
    for (const ReceiverPacket& packet : segments.receivers) {
        StoredPacket places;
        std::memcpy(&places, &packet, sizeof places);
        append(bytes, places);
    }
    for (const std::uint64_t word : segments.rays) {
        append(bytes, word);
    }
    write_text(file, bytes);
}

GatherSegments read_segments(const std::filesystem::path& file) {
    const std::string bytes = read_bytes(file);
    const auto fail = [&](const std::string& what) {
        return Error(ErrorKind::file,
                     "'" + file.string() + "' is not a set of segments that this version reads: " + what +
                         "; write it anew",
                     "segments");
    };
    if (!std::string_view(bytes).starts_with(kMagic)) {
        throw fail("it does not begin with " + std::string(kMagic));
    }
    if (bytes.size() < kMagic.size() + sizeof(Header)) {
        throw fail("it ends within the header");
    }
    Reader reader(std::string_view(bytes).substr(kMagic.size()));
    const auto header = reader.take<Header>();
    if (word_count(header) > bytes.size() / sizeof(std::uint64_t)) {
        throw fail("it has " + std::to_string(bytes.size()) + " bytes, its header asks for " +
                   std::to_string(word_count(header)) + " words of rays");
    }
    if (bytes.size() != bytes_of_file(header)) {
        throw fail("it has " + std::to_string(bytes.size()) + " bytes, its header asks for " +
                   std::to_string(bytes_of_file(header)));
    }
    if (!is_sound(header)) {
        throw fail("its header has other limits of a segment, or no clamp radius");
    }
    GatherSegments segments = read_arrays(header, reader);
    segments.geometry.name = file.stem().string();
    if (const std::string wrong = complaint(segments, header.ray_count); !wrong.empty()) {
        throw fail(wrong);
    }
    return segments;
}

}  // namespace nearlight::core
