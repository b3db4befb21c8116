// SPDX-License-Identifier: Apache-2.0
#include "host/stages/film.h"

#include <algorithm>

#include "host/base/random.h"
#include "tests/support/device_fixture.h"

namespace nearlight {
namespace {

constexpr uint kWidth = 13;
constexpr uint kHeight = 11;
constexpr uint kTiles = 4;
constexpr uint kSamples = 3;
constexpr uint kBranches = 2;

class FilmTest : public test::DeviceTest {};

struct Samples {
    std::vector<ReceiverPacket> receivers;
    std::vector<CameraVertex> vertices;
    std::vector<IrradiancePacket> direct;
    std::vector<IrradiancePacket> indirect;
};

/// Random numbers in every field; some camera rays meet nothing.
Samples random_samples() {
    Pcg32 random(1);
    const auto color = [&] {
        const float r = random.uniform();
        const float g = random.uniform();
        return Vec3{r, g, random.uniform()};
    };
    Samples samples;
    for (uint p = 0; p < kTiles * kSamples * kBranches; ++p) {
        ReceiverPacket receiver;
        std::generate_n(receiver.px, sizeof(ReceiverPacket) / sizeof(float),
                        [&] { return random.uniform() + 0.1f; });
        samples.receivers.push_back(receiver);
        for (std::vector<IrradiancePacket>* light : {&samples.direct, &samples.indirect}) {
            std::generate_n(light->emplace_back().r, sizeof(IrradiancePacket) / sizeof(float),
                            [&] { return random.uniform(); });
        }
        for (int lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            const float depth = random.next() % 4 == 0 ? 0.0f : 1.0f + random.uniform();
            samples.vertices.push_back({.throughput = color(),
                                        .depth = depth,
                                        .albedo = color(),
                                        .flags = random.next() % 2,
                                        .emitted = color(),
                                        .pad0 = 0});
        }
    }
    return samples;
}

/// Packet and lane of a sample of a pixel.
std::pair<std::size_t, std::size_t> place_of(uint x, uint y, uint sample, uint branch) {
    const uint tile = y / 8 * 2 + x / 8;
    return {(tile * kSamples + sample) * kBranches + branch, y % 8 * 8 + x % 8};
}

/// What the layers of a pixel must be, in the order of layer_channels().
std::vector<double> expected_layers(const Samples& samples, uint x, uint y) {
    std::vector<double> out(NEARLIGHT_LAYER_CHANNELS, 0.0);
    double normal[3] = {0, 0, 0};
    const auto channel = [](Vec3 v, int c) {
        return static_cast<double>(c == 0 ? v.x : (c == 1 ? v.y : v.z));
    };
    for (uint s = 0; s < kSamples * kBranches; ++s) {
        const auto [packet, lane] = place_of(x, y, s / kBranches, s % kBranches);
        const CameraVertex& vertex = samples.vertices[packet * NEARLIGHT_PACKET_SIZE + lane];
        const ReceiverPacket& receiver = samples.receivers[packet];
        for (std::size_t c = 0; c < 3; ++c) {
            const int axis = static_cast<int>(c);
            const std::size_t at = c * NEARLIGHT_PACKET_SIZE + lane;
            const double reflectance = channel(vertex.throughput, axis) * channel(vertex.albedo, axis);
            const double direct =
                channel(vertex.emitted, axis) + reflectance / kPi * (&samples.direct[packet].r[0])[at];
            const double indirect = reflectance / kPi * (&samples.indirect[packet].r[0])[at];
            out[3 + c] += direct / kSamples;
            out[6 + c] += indirect / kSamples;
            out[c] = out[3 + c] + out[6 + c];
            out[9 + c] += reflectance / kSamples;
            normal[c] += s % kBranches == 0 ? (&receiver.nx[0])[at] : 0.0f;
            if (s % kBranches == 0 && out[18] == 0.0 && vertex.depth > 0) {
                out[15 + c] = (&receiver.px[0])[at];
            }
        }
        if (s % kBranches == 0) {
            out[18] = out[18] == 0.0 ? vertex.depth : out[18];
            out[19] += static_cast<double>(vertex.flags & NEARLIGHT_VERTEX_CLOSE) / kSamples;
        }
    }
    const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (std::size_t c = 0; c < 3; ++c) {
        out[12 + c] = normal[c] / length;
    }
    return out;
}

/// Adds samples in the given batches and resolves.
std::vector<float> develop(Device& device, const Samples& samples, const std::vector<uint>& batches) {
    Film film(device);
    Buffer<float> sums(device, kWidth * kHeight * NEARLIGHT_FILM_CHANNELS);
    sums.fill_zero();
    uint first = 0;
    for (const uint count : batches) {
        Samples batch;
        for (std::size_t p = 0; p < samples.receivers.size(); ++p) {
            const std::size_t sample = p / kBranches % kSamples;
            if (sample >= first && sample < first + count) {
                batch.receivers.push_back(samples.receivers[p]);
                batch.direct.push_back(samples.direct[p]);
                batch.indirect.push_back(samples.indirect[p]);
                const auto from =
                    samples.vertices.begin() + static_cast<std::ptrdiff_t>(p * NEARLIGHT_PACKET_SIZE);
                batch.vertices.insert(batch.vertices.end(), from, from + NEARLIGHT_PACKET_SIZE);
            }
        }
        const Buffer<ReceiverPacket> receivers(device, batch.receivers);
        const Buffer<CameraVertex> vertices(device, batch.vertices);
        const Buffer<IrradiancePacket> direct(device, batch.direct);
        const Buffer<IrradiancePacket> indirect(device, batch.indirect);
        film.add(receivers, vertices, direct, indirect,
                 {.tile_row_count = 2,
                  .sample_count = count,
                  .samples_per_pixel = kSamples,
                  .branch_count = kBranches},
                 kWidth, kHeight, sums);
        device.finish();
        first += count;
    }
    test::GuardedBuffer<float> layers(device, kWidth * kHeight * NEARLIGHT_LAYER_CHANNELS);
    film.resolve(sums, kWidth * kHeight, kSamples, layers.buffer());
    return layers.download();
}

TEST_F(FilmTest, LayersAreSumsOverSamplesAndBranches) {
    ASSERT_EQ(layer_channels().size(), static_cast<std::size_t>(NEARLIGHT_LAYER_CHANNELS));
    const Samples samples = random_samples();
    on_each_device([&](Device& device) {
        const std::vector<float> layers = develop(device, samples, {kSamples});
        for (uint y = 0; y < kHeight; ++y) {
            for (uint x = 0; x < kWidth; ++x) {
                const std::vector<double> expected = expected_layers(samples, x, y);
                for (std::size_t c = 0; c < expected.size(); ++c) {
                    ASSERT_NEAR(layers[(y * kWidth + x) * NEARLIGHT_LAYER_CHANNELS + c], expected[c], 2e-6)
                        << layer_channels()[c] << " of pixel " << x << ", " << y;
                }
            }
        }
    });
}

TEST_F(FilmTest, BatchesOfSamplesGiveTheSameBits) {
    const Samples samples = random_samples();
    on_each_device([&](Device& device) {
        const std::vector<float> whole = develop(device, samples, {3});
        EXPECT_EQ(develop(device, samples, {1, 2}), whole);
        EXPECT_EQ(develop(device, samples, {1, 1, 1}), whole);
    });
}

}  // namespace
}  // namespace nearlight
