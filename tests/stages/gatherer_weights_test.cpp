// SPDX-License-Identifier: Apache-2.0
// Gathers whose light transmission curves weigh at both ends, or maps at the receivers.
#include "host/stages/gatherer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/base/math.h"
#include "host/base/packed_direction.h"
#include "host/base/seen_normal.h"
#include "tests/stages/gatherer_variants.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

constexpr uint kCurves = 3;

/// Row 0 is all ones; the others differ and bend.
std::vector<float> bent_curves() {
    std::vector<float> curves;
    for (uint row = 0; row < kCurves; ++row) {
        for (int i = 0; i < NEARLIGHT_CURVE_SIZE; ++i) {
            const float c = static_cast<float>(i) / (NEARLIGHT_CURVE_SIZE - 1);
            curves.push_back(row == 0 ? 1.0f : (row == 1 ? 0.2f + 0.7f * c * c : 0.9f - 0.5f * std::sqrt(c)));
        }
    }
    return curves;
}

double curve_at(const std::vector<float>& curves, uint row, double cosine) {
    const double place = std::min(cosine, 1.0) * (NEARLIGHT_CURVE_SIZE - 1);
    const int entry = std::min(static_cast<int>(place), NEARLIGHT_CURVE_SIZE - 2);
    const float* of_entry = &curves[row * NEARLIGHT_CURVE_SIZE + static_cast<std::size_t>(entry)];
    return std::lerp(double{of_entry[0]}, double{of_entry[1]}, place - entry);
}

/// Gives VPLs and receivers rows of curves. A whole packet has none.
void choose_curves(GatherCase& data) {
    for (std::size_t i = 0; i < data.vpls.size(); ++i) {
        data.vpls[i].flags |= NEARLIGHT_VPL_CLOSE | static_cast<uint>(i / 2) % kCurves
                                                        << NEARLIGHT_VPL_CURVE_SHIFT;
    }
    for (std::size_t p = 1; p < data.receivers.size(); ++p) {
        for (uint lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            const uint surfaces_before = lane % 4;
            data.receivers[p].surface[lane] = (lane / 5 + static_cast<uint>(p)) % kCurves |
                                              surfaces_before << NEARLIGHT_RECEIVER_SURFACES_SHIFT;
        }
    }
}

/// A receiver's surface: its transmission curve, and the normal of its mesh, which is zero without a map.
struct ReceiverSurface {
    uint curve = 0;
    Vec3 mesh_normal{0, 0, 0};
};

ReceiverSurface surface_of(const ReceiverPacket& packet, std::size_t lane) {
    const uint mesh_normal = packet.mesh_normal[lane];
    return {packet.surface[lane] & NEARLIGHT_RECEIVER_CURVE_MASK,
            mesh_normal != 0 ? unpack_direction(mesh_normal) : Vec3{0, 0, 0}};
}

/// The sum of visible pairs, each times weight(VPL, receiver, its surface, direction of the segment).
template <typename Weight>
std::vector<IrradiancePacket> weighted_sums(const GatherCase& data, const std::vector<GatherPair>& pairs,
                                            const Weight& weight) {
    std::vector<IrradiancePacket> result(data.receivers.size());
    for (std::size_t i = 0; i < data.receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        const std::size_t p = i / NEARLIGHT_PACKET_SIZE;
        const std::size_t lane = i % NEARLIGHT_PACKET_SIZE;
        const ReceiverPoint receiver = receiver_at(data.receivers[p], lane);
        const ReceiverSurface surface = surface_of(data.receivers[p], lane);
        double sum[3] = {0, 0, 0};
        for (std::size_t v = 0; v < data.vpls.size(); ++v) {
            const Vpl& vpl = data.vpls[v];
            if (pairs[(p * data.vpls.size() + v) * NEARLIGHT_PACKET_SIZE + lane] != GatherPair::visible) {
                continue;
            }
            const Vec3 direction = normalize(receiver.position - vpl.position);
            const double term = pair_term(vpl, receiver, data.clamp_radius).value / double{kPi} *
                                weight(vpl, receiver, surface, direction);
            sum[0] += term * vpl.power.x;
            sum[1] += term * vpl.power.y;
            sum[2] += term * vpl.power.z;
        }
        result[p].r[lane] = static_cast<float>(sum[0]);
        result[p].g[lane] = static_cast<float>(sum[1]);
        result[p].b[lane] = static_cast<float>(sum[2]);
    }
    return result;
}

/// Has maps tilt the normals of two receivers of three, in all packets but the first.
void choose_maps(GatherCase& data) {
    for (std::size_t p = 1; p < data.receivers.size(); ++p) {
        for (uint lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            const Vec3 normal = receiver_at(data.receivers[p], lane).normal;
            if (lane % 3 != 0 && !is_zero(normal)) {
                const Vec3 aside = {0.3f * static_cast<float>(lane % 5), 0.7f, -0.2f};
                data.receivers[p].mesh_normal[lane] = pack_direction(normalize(normal + aside));
            }
        }
    }
}

/// What the bumps leave of light, by Estevez et al.: in terms of the angles of the map and of the light to
/// the normal of the mesh.
double map_part(Vec3 normal, Vec3 mesh_normal, Vec3 to_light) {
    const double cosine = dot(mesh_normal, to_light);
    if (is_zero(mesh_normal) || cosine <= 0) {
        return is_zero(mesh_normal) ? 1.0 : 0.0;
    }
    const double tan_map = std::tan(std::acos(std::min(1.0, double{dot(normal, mesh_normal)})));
    const double tan_light = std::tan(std::acos(std::min(1.0, cosine)));
    const double alpha2 = std::clamp(0.125 * tan_map * tan_map, 0.0, 1.0);
    return 2 / (1 + std::sqrt(1 + alpha2 * tan_light * tan_light));
}

class GathererWeightsTest : public DeviceTest {
  public:
    /// Calls check(gatherer, a gather's input and sums, what the plain gather sums up) for each variant.
    template <typename Check>
    static void on_each_variant(Device& device, const GatherCase& data, const Check& check) {
        for (const Variant& variant : variants()) {
            SCOPED_TRACE(variant.name);
            Gatherer gatherer(device, variant.config);
            Uploaded uploaded(device, data);
            check(gatherer, uploaded, uploaded.gather(gatherer));
        }
    }
};

TEST_F(GathererWeightsTest, CurvesWeighBothEnds) {
    GatherCase data = room_of_boxes(40, 130, 6, 8);
    choose_curves(data);
    const std::vector<float> curves = bent_curves();
    const auto weight = [&](const Vpl& vpl, const ReceiverPoint& receiver, const ReceiverSurface& surface,
                            Vec3 direction) {
        return curve_at(curves, vpl.flags >> NEARLIGHT_VPL_CURVE_SHIFT, dot(seen_normal(vpl), direction)) *
               curve_at(curves, surface.curve, -dot(receiver.normal, direction));
    };
    on_each_device([&](Device& device) {
        const Buffer<float> rows(device, curves);
        on_each_variant(device, data, [&](Gatherer& gatherer, Uploaded& uploaded, const auto& plain) {
            GatherInput<Vpl> input = uploaded.input();
            input.curves = &rows;
            const std::vector<GatherPair> pairs = gatherer.gather_recorded(input, uploaded.sums());
            const std::vector<IrradiancePacket> recorded = uploaded.sums().light.download();
            expect_close(recorded, weighted_sums(data, pairs, weight));
            ASSERT_TRUE(gatherer.gather(input, uploaded.sums()));
            expect_close(uploaded.sums().light.download(), recorded);
            EXPECT_FALSE(same_bits(plain, recorded));
        });
    });
}

TEST_F(GathererWeightsTest, MapsShadowReceivers) {
    GatherCase data = room_of_boxes(40, 130, 6, 10);
    choose_maps(data);
    const auto weight = [](const Vpl&, const ReceiverPoint& receiver, const ReceiverSurface& surface,
                           Vec3 direction) {
        return map_part(receiver.normal, surface.mesh_normal, -direction);
    };
    on_each_device([&](Device& device) {
        on_each_variant(device, data, [&](Gatherer& gatherer, Uploaded& uploaded, const auto& plain) {
            GatherInput<Vpl> input = uploaded.input();
            input.has_maps = true;
            const std::vector<GatherPair> pairs = gatherer.gather_recorded(input, uploaded.sums());
            const std::vector<IrradiancePacket> recorded = uploaded.sums().light.download();
            expect_close(recorded, weighted_sums(data, pairs, weight));
            EXPECT_FALSE(same_bits(plain, recorded));
            EXPECT_TRUE(same_bits({plain.front()}, {recorded.front()})) << "a packet without maps";
        });
    });
}

/// Rows without a curve are the plain gather, bit for bit.
TEST_F(GathererWeightsTest, RowZeroDoesNotChangeABit) {
    const GatherCase data = room_of_boxes(40, 130, 3, 9);
    on_each_device([&](Device& device) {
        const Buffer<float> rows(device, bent_curves());
        on_each_variant(device, data, [&](Gatherer& gatherer, Uploaded& uploaded, const auto& plain) {
            GatherInput<Vpl> input = uploaded.input();
            input.curves = &rows;
            ASSERT_TRUE(gatherer.gather(input, uploaded.sums()));
            EXPECT_TRUE(same_bits(uploaded.sums().light.download(), plain));
        });
    });
}

}  // namespace
}  // namespace nearlight::core::test
