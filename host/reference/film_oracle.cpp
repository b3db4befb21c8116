// SPDX-License-Identifier: Apache-2.0
#include "host/reference/film_oracle.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host/base/packed_direction.h"
#include "host/base/random.h"
#include "host/base/receivers.h"

namespace nearlight::core {
namespace {

/// The packet and the lane of the sample whose position and depth a pixel shows: the first on its own square
/// that met something, otherwise the first that did; empty if none did.
std::optional<std::pair<std::size_t, std::size_t>> shown_sample(const FilmSamples& samples,
                                                                const FilmLayout& layout, uint x, uint y) {
    for (const uint required : {NEARLIGHT_VERTEX_OWN_PIXEL, 0u}) {
        for (uint s = 0; s < layout.samples; ++s) {
            const auto place = place_of(layout, x, y, s, 0);
            const CameraVertex& vertex = samples.vertices[place.first * NEARLIGHT_PACKET_SIZE + place.second];
            if (vertex.depth > 0.0f && (vertex.flags & required) == required) {
                return place;
            }
        }
    }
    return std::nullopt;
}

double channel(Vec3 v, std::size_t c) {
    return c == 0 ? v.x : (c == 1 ? v.y : v.z);
}

/// The normal that a sample shows, also of a receiver that is absent only because its light was traced.
Vec3 shown_normal(const ReceiverPacket& receiver, std::size_t lane) {
    const Vec3 normal = receiver_at(receiver, lane).normal;
    const uint packed = receiver.mesh_normal[lane];
    return is_zero(normal) && packed != 0 ? unpack_direction(packed) : normal;
}

/// Makes about a third of a packet's receivers absent, of which some show a normal.
void leave_out_some(ReceiverPacket& receiver, Pcg32& random) {
    std::ranges::fill(receiver.mesh_normal, 0u);
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        const uint choice = random.next() % 6;
        const float x = random.uniform() + 0.1f;
        const float y = random.uniform() + 0.1f;
        const uint packed = pack_direction(normalize(Vec3{x, y, random.uniform() + 0.1f}));
        if (choice < 2) {
            receiver.nx[lane] = receiver.ny[lane] = receiver.nz[lane] = 0.0f;
        }
        receiver.mesh_normal[lane] = choice % 2 == 0 ? packed : 0;
    }
}

/// The variance of the mean of `samples`, whose first half (without the middle one) and second half add up to
/// the given numbers.
double variance_of(double first, double second, uint samples) {
    const double in_first = samples / 2;
    const double in_second = samples - in_first;
    const double mean = (first + second) / samples;
    const double squares = in_first * std::pow(first / in_first - mean, 2.0) +
                           in_second * std::pow(second / in_second - mean, 2.0);
    return double{NEARLIGHT_HALVES_TO_WHOLE} * squares / samples;
}

}  // namespace

std::pair<std::size_t, std::size_t> place_of(const FilmLayout& layout, uint x, uint y, uint sample,
                                             uint branch) {
    constexpr uint kTile = NEARLIGHT_TILE_SIZE;
    const std::size_t tile = y / kTile * layout.tile_columns() + x / kTile;
    return {(tile * layout.samples + sample) * layout.branches + branch, y % kTile * kTile + x % kTile};
}

FilmSamples random_film_samples(const FilmLayout& layout) {
    Pcg32 random(1);
    Pcg32 normals(2);
    const auto color = [&] {
        const float r = random.uniform();
        const float g = random.uniform();
        return Vec3{r, g, random.uniform()};
    };
    FilmSamples samples;
    const std::size_t tiles = layout.tile_columns() * layout.tile_rows();
    for (std::size_t p = 0; p < tiles * layout.samples * layout.branches; ++p) {
        ReceiverPacket receiver;
        std::generate_n(receiver.px, offsetof(ReceiverPacket, surface) / sizeof(float),
                        [&] { return random.uniform() + 0.1f; });
        std::ranges::fill(receiver.surface, 0u);
        leave_out_some(receiver, normals);
        samples.receivers.push_back(receiver);
        for (std::vector<IrradiancePacket>* light : {&samples.direct, &samples.gathered, &samples.indirect}) {
            std::generate_n(light->emplace_back().r, sizeof(IrradiancePacket) / sizeof(float),
                            [&] { return random.uniform(); });
        }
        for (int lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            const float depth = random.next() % 4 == 0 ? 0.0f : 1.0f + random.uniform();
            samples.vertices.push_back({.throughput = color(),
                                        .depth = depth,
                                        .albedo = color(),
                                        .flags = random.next() % 4,
                                        .camera_light = color(),
                                        .filter_weight = 2.0f * random.uniform() - 0.5f,
                                        .traced_direct = color(),
                                        .film_x = random.uniform() - 0.5f,
                                        .traced_indirect = color(),
                                        .film_y = random.uniform() - 0.5f});
        }
    }
    return samples;
}

FilmSamples batch_of_samples(const FilmSamples& samples, const FilmLayout& layout, uint first, uint count) {
    FilmSamples batch;
    for (std::size_t p = 0; p < samples.receivers.size(); ++p) {
        const std::size_t sample = p / layout.branches % layout.samples;
        if (sample >= first && sample < first + count) {
            batch.receivers.push_back(samples.receivers[p]);
            batch.direct.push_back(samples.direct[p]);
            batch.gathered.push_back(samples.gathered[p]);
            batch.indirect.push_back(samples.indirect[p]);
            const auto from =
                samples.vertices.begin() + static_cast<std::ptrdiff_t>(p * NEARLIGHT_PACKET_SIZE);
            batch.vertices.insert(batch.vertices.end(), from, from + NEARLIGHT_PACKET_SIZE);
        }
    }
    return batch;
}

BranchLight branch_light(const FilmSamples& samples, std::size_t packet, std::size_t lane) {
    const CameraVertex& vertex = samples.vertices[packet * NEARLIGHT_PACKET_SIZE + lane];
    BranchLight light;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = c * NEARLIGHT_PACKET_SIZE + lane;
        const double response = channel(vertex.throughput, c) * channel(vertex.albedo, c) / kPi;
        light.direct[c] = channel(vertex.camera_light, c) + channel(vertex.traced_direct, c) +
                          response * (&samples.direct[packet].r[0])[at];
        light.indirect[c] =
            channel(vertex.traced_indirect, c) + response * (double{(&samples.gathered[packet].r[0])[at]} +
                                                             double{(&samples.indirect[packet].r[0])[at]});
    }
    return light;
}

std::vector<double> expected_layers(const FilmSamples& samples, const FilmLayout& layout, uint x, uint y) {
    std::vector<double> out(NEARLIGHT_LAYER_CHANNELS, 0.0);
    double halves[2][3] = {};
    double normal[3] = {0, 0, 0};
    for (uint s = 0; s < layout.samples * layout.branches; ++s) {
        const auto [packet, lane] = place_of(layout, x, y, s / layout.branches, s % layout.branches);
        const CameraVertex& vertex = samples.vertices[packet * NEARLIGHT_PACKET_SIZE + lane];
        const ReceiverPacket& receiver = samples.receivers[packet];
        const BranchLight light = branch_light(samples, packet, lane);
        for (std::size_t c = 0; c < 3; ++c) {
            const double direct = double{vertex.filter_weight} * light.direct[c];
            const double indirect = double{vertex.filter_weight} * light.indirect[c];
            out[NEARLIGHT_LAYER_DIRECT + c] += direct / layout.samples;
            out[NEARLIGHT_LAYER_INDIRECT + c] += indirect / layout.samples;
            out[NEARLIGHT_LAYER_BEAUTY + c] =
                out[NEARLIGHT_LAYER_DIRECT + c] + out[NEARLIGHT_LAYER_INDIRECT + c];
            const bool is_in_second = s / layout.branches >= layout.samples / 2;
            halves[is_in_second ? 1 : 0][c] += direct + indirect;
            out[NEARLIGHT_LAYER_ALBEDO + c] +=
                channel(vertex.throughput, c) * channel(vertex.albedo, c) / layout.samples;
            normal[c] += s % layout.branches == 0 ? channel(shown_normal(receiver, lane), c) : 0.0;
        }
        if (s % layout.branches == 0) {
            out[NEARLIGHT_LAYER_CLOSE_RANGE] +=
                static_cast<double>(vertex.flags & NEARLIGHT_VERTEX_CLOSE) / layout.samples;
            out[NEARLIGHT_LAYER_ALPHA] += (vertex.depth > 0.0f ? 1.0 : 0.0) / layout.samples;
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
        out[NEARLIGHT_LAYER_VARIANCE + c] = variance_of(halves[0][c], halves[1][c], layout.samples);
    }
    const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (std::size_t c = 0; c < 3; ++c) {
        out[NEARLIGHT_LAYER_NORMAL + c] = length > 0.0 ? normal[c] / length : 0.0;
    }
    if (const auto shown = shown_sample(samples, layout, x, y)) {
        const auto [packet, lane] = *shown;
        out[NEARLIGHT_LAYER_DEPTH] = samples.vertices[packet * NEARLIGHT_PACKET_SIZE + lane].depth;
        for (std::size_t c = 0; c < 3; ++c) {
            out[NEARLIGHT_LAYER_POSITION + c] =
                (&samples.receivers[packet].px[0])[c * NEARLIGHT_PACKET_SIZE + lane];
        }
    }
    return out;
}

}  // namespace nearlight::core
