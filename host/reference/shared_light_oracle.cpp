// SPDX-License-Identifier: Apache-2.0
#include "host/reference/shared_light_oracle.h"

#include <cmath>
#include <limits>
#include <optional>

#include "host/base/packed_direction.h"
#include "host/base/random.h"
#include "host/base/receiver_bundles.h"
#include "host/base/receivers.h"
#include "host/reference/bsdf/surface_bsdf.h"

namespace nearlight::core {
namespace {

bool is_absent(const ReceiverPoint& point) {
    return point.normal == Vec3{0, 0, 0};
}

/// Whether a receiver of the case shares lights: paths are short, so none behind a surface does.
bool shares(const SharedLightCase& data, std::size_t receiver) {
    const ReceiverPacket& packet = data.receivers[receiver / NEARLIGHT_PACKET_SIZE];
    const std::size_t lane = receiver % NEARLIGHT_PACKET_SIZE;
    const uint surfaces =
        packet.surface[lane] >> NEARLIGHT_RECEIVER_SURFACES_SHIFT & NEARLIGHT_RECEIVER_SURFACES_MASK;
    return !is_absent(receiver_at(packet, lane)) && packet.mesh_normal[lane] == 0 && surfaces == 0;
}

uint curve_of(const SharedLightCase& data, std::size_t receiver) {
    return data.receivers[receiver / NEARLIGHT_PACKET_SIZE].surface[receiver % NEARLIGHT_PACKET_SIZE] &
           NEARLIGHT_RECEIVER_CURVE_MASK;
}

/// A light and a receiver that is near enough and faces it.
struct Pair {
    double geometry, part, cos_light, cos_receiver;
};

std::optional<Pair> connect(const SharedLightCase& data, const SharedLight& light, const ReceiverPoint& x) {
    const Vec3 d = x.position - light.position;
    const double squared = dot(d, d);
    const double limit = double{data.clamp_radius} * data.clamp_radius;
    const double distance = std::sqrt(squared);
    const double cos_light = dot(light.normal, d) / distance;
    const double cos_receiver = -dot(x.normal, d) / distance;
    if (!(squared > 0 && squared < limit && cos_light > 0 && cos_receiver > 0)) {
        return std::nullopt;
    }
    return Pair{cos_light * cos_receiver / squared, 1 - squared / limit, cos_light, cos_receiver};
}

/// Every eighth receiver does not share, each for a reason of its own, and every third has a curve.
void vary(std::vector<ReceiverPacket>& receivers) {
    for (std::size_t i = 0; i < receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        ReceiverPacket& packet = receivers[i / NEARLIGHT_PACKET_SIZE];
        const std::size_t lane = i % NEARLIGHT_PACKET_SIZE;
        packet.surface[lane] = i % 3 == 0 ? 1u : 0u;
        if (i % 24 == 1) {
            packet.surface[lane] |= 1u << NEARLIGHT_RECEIVER_SURFACES_SHIFT;
        } else if (i % 24 == 9) {
            packet.mesh_normal[lane] = pack_direction(receiver_at(packet, lane).normal);
        } else if (i % 24 == 17) {
            set_receiver(packet, lane, {});
        }
    }
}

SharedLight light_at(const ReceiverPoint& place, std::size_t number, Pcg32& random) {
    return {.position = place.position,
            .weight = 1,
            .normal = place.normal,
            .curve = static_cast<ushort>(number % 5 == 0 ? 1 : 0),
            .veils = 0,
            .radiance = {random.uniform(), random.uniform(), 1 + random.uniform()},
            .shading = pack_direction(place.normal)};
}

/// Gives every `stride`-th receiver a light at `place(first, end, random)`, where the receivers of its bundle
/// are [first, end). The strides are so large that a whole bundle uses each light with certainty.
template <typename Place>
void place_lights(SharedLightCase& data, std::size_t stride, const std::function<bool(Vec3, Vec3)>& is_clear,
                  const Place& place) {
    const std::size_t count = data.receivers.size() * NEARLIGHT_PACKET_SIZE;
    data.found.resize(count, SharedLight{});
    Pcg32 random(7, 1);
    for (std::size_t i = 0; i < count; i += stride) {
        const std::size_t first = i / kBundleReceivers * kBundleReceivers;
        const std::size_t end = std::min(count, first + kBundleReceivers);
        const ReceiverPoint at = place(first, end, random);
        if (is_absent(at)) {
            continue;
        }
        const SharedLight light = light_at(at, i / stride, random);
        bool clear = true;
        for (std::size_t k = first; k < end && clear; ++k) {
            const ReceiverPoint x = receiver_at(data.receivers, k);
            clear = !connect(data, light, x) || is_clear(light.position, x.position);
        }
        if (clear) {
            data.found[i] = light;
        }
    }
}

/// A receiver that a light lights, and the density of all rays of the bundle there.
struct Connection {
    std::size_t light, receiver;
    Pair pair;
    double density;
};

/// Calls visit(connection) for each light and each receiver that it lights. paths(light, receiver) is what
/// the receiver's rays to the light count in its density, and nothing where the two do not share the light.
template <typename Paths, typename Visitor>
void for_each_connection(const SharedLightCase& data, const std::function<bool(Vec3, Vec3)>& is_visible,
                         const Paths& paths, const Visitor& visit) {
    const std::size_t count = data.receivers.size() * NEARLIGHT_PACKET_SIZE;
    for (std::size_t i = 0; i < count; ++i) {
        const SharedLight& light = data.found[i];
        const std::size_t first = i / kBundleReceivers * kBundleReceivers;
        const std::size_t end = std::min(count, first + kBundleReceivers);
        std::vector<std::pair<std::size_t, Pair>> seeing;
        double density = 0;
        for (std::size_t k = first; k < end && light.weight > 0; ++k) {
            const ReceiverPoint x = receiver_at(data.receivers, k);
            const std::optional<Pair> pair = shares(data, k) ? connect(data, light, x) : std::nullopt;
            const std::optional<double> of_paths =
                pair && is_visible(light.position, x.position) ? paths(i, k) : std::nullopt;
            if (of_paths) {
                seeing.emplace_back(k, *pair);
                density += *of_paths * data.rays_per_receiver * pair->geometry / static_cast<double>(kPi);
            }
        }
        for (const auto& [k, pair] : seeing) {
            visit(Connection{i, k, pair, density});
        }
    }
}

/// The part of a shared light that the curves of its surface and of the receiver's let through.
double curves_part(const SharedLightCase& data, const Connection& c,
                   const std::function<double(double)>& transmission) {
    return (data.found[c.light].curve == 1 ? transmission(c.pair.cos_light) : 1.0) *
           (curve_of(data, c.receiver) == 1 ? transmission(c.pair.cos_receiver) : 1.0);
}

std::optional<double> every_path(std::size_t /*light*/, std::size_t /*receiver*/) {
    return 1.0;
}

/// What the surface of a reflection does to the light that arrives there, for one receiver.
struct Gloss {
    Vec3d value;  ///< S times the cosine
    double pdf;   ///< of S's own samples
    double width;
};

Gloss gloss_towards(const SharedReflectionCase& data, const Scene& scene, std::size_t light, Vec3 x) {
    const SharedReflection& at = data.reflections[light];
    const Vec3d wo = normalize(as_double(x) - as_double(data.lights.found[light].position));
    const Surface surface = surface_at(scene, {1.0f, at.u, at.v, at.triangle}, as_float(-wo));
    const SurfaceBsdf bsdf(scene, surface, wo, static_cast<double>(at.model));
    const Vec3d wi = as_double(at.arriving);
    const BsdfParameters& parameters = bsdf.parameters();
    return {bsdf.eval(wi).specular, bsdf.specular_pdf(wi), std::min(parameters.alpha_x, parameters.alpha_y)};
}

SharedLightCase without_lights(std::vector<ReceiverPacket> receivers, float clamp_radius) {
    vary(receivers);
    return {.receivers = std::move(receivers), .found = {}, .clamp_radius = clamp_radius};
}

}  // namespace

SharedLightCase make_shared_lights(std::vector<ReceiverPacket> receivers, float clamp_radius,
                                   const std::function<bool(Vec3, Vec3)>& is_clear) {
    SharedLightCase data = without_lights(std::move(receivers), clamp_radius);
    place_lights(data, 4, is_clear, [&](std::size_t first, std::size_t end, Pcg32& random) {
        return receiver_at(data.receivers, first + random.next() % (end - first));
    });
    return data;
}

SharedLightCase make_shared_sky(std::vector<ReceiverPacket> receivers, Vec3 center, float radius,
                                const std::function<bool(Vec3, Vec3)>& is_clear) {
    SharedLightCase data = without_lights(std::move(receivers), std::numeric_limits<float>::infinity());
    place_lights(data, 8, is_clear, [&](std::size_t, std::size_t, Pcg32& random) {
        const Vec3 outwards =
            normalize(Vec3{random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f});
        return ReceiverPoint{center + outwards * radius, -outwards};
    });
    for (SharedLight& light : data.found) {
        light.radiance = light.weight > 0 ? Vec3{1, 1, 1} : Vec3{0, 0, 0};
        light.curve = 0;
    }
    return data;
}

std::vector<Vec3> shared_irradiance(const SharedLightCase& data,
                                    const std::function<bool(Vec3, Vec3)>& is_visible,
                                    const std::function<double(double)>& transmission) {
    std::vector<Vec3> result(data.receivers.size() * NEARLIGHT_PACKET_SIZE, Vec3{0, 0, 0});
    for_each_connection(data, is_visible, every_path, [&](const Connection& c) {
        const SharedLight& light = data.found[c.light];
        const double weight = c.pair.part * c.pair.geometry / c.density * curves_part(data, c, transmission);
        result[c.receiver] += light.radiance * static_cast<float>(weight);
    });
    return result;
}

SharedLightCase make_veiled_lights(std::vector<ReceiverPacket> receivers, const VeilsOracle& veils,
                                   const std::function<bool(Vec3, Vec3)>& is_clear) {
    SharedLightCase data = without_lights(std::move(receivers), std::numeric_limits<float>::infinity());
    place_lights(data, 8, is_clear, [&](std::size_t, std::size_t, Pcg32& random) {
        const std::size_t count = data.receivers.size() * NEARLIGHT_PACKET_SIZE;
        return receiver_at(data.receivers, random.next() % count);
    });
    for (std::size_t i = 0; i < data.found.size(); ++i) {
        SharedLight& light = data.found[i];
        light.veils =
            static_cast<ushort>(veils(light.position, receiver_at(data.receivers, i).position).count);
    }
    return data;
}

std::vector<Vec3> veiled_irradiance(const SharedLightCase& data,
                                    const std::function<bool(Vec3, Vec3)>& is_visible,
                                    const VeilsOracle& veils,
                                    const std::function<double(double)>& transmission) {
    std::vector<Vec3> result(data.receivers.size() * NEARLIGHT_PACKET_SIZE, Vec3{0, 0, 0});
    const auto between = [&](std::size_t light, std::size_t receiver) {
        return veils(data.found[light].position, receiver_at(data.receivers, receiver).position);
    };
    const auto behind_as_many = [&](std::size_t light, std::size_t receiver) {
        return between(light, receiver).count == data.found[light].veils ? std::optional(1.0) : std::nullopt;
    };
    for_each_connection(data, is_visible, behind_as_many, [&](const Connection& c) {
        const double weight = between(c.light, c.receiver).part * c.pair.geometry / c.density *
                              curves_part(data, c, transmission);
        result[c.receiver] += data.found[c.light].radiance * static_cast<float>(weight);
    });
    return result;
}

std::vector<Vec3> shared_sky_irradiance(const SharedLightCase& data, Vec3 radiance, uint light_samples,
                                        const std::function<bool(Vec3, Vec3)>& is_visible,
                                        const std::function<double(double)>& transmission) {
    std::vector<Vec3> result(data.receivers.size() * NEARLIGHT_PACKET_SIZE, Vec3{0, 0, 0});
    for_each_connection(data, is_visible, every_path, [&](const Connection& c) {
        const double own = data.rays_per_receiver * c.pair.cos_receiver / static_cast<double>(kPi);
        const double of_bundle = NEARLIGHT_SKY_RAYS * own;
        const double of_samples = light_samples / (4 * static_cast<double>(kPi));
        const double weight = of_bundle / (of_bundle + own + of_samples) * c.pair.geometry / c.density *
                              curves_part(data, c, transmission);
        result[c.receiver] += radiance * static_cast<float>(weight);
    });
    return result;
}

SharedReflectionCase make_shared_reflections(std::vector<ReceiverPacket> receivers, const Scene& scene,
                                             const std::function<bool(Vec3, Vec3)>& is_clear) {
    SharedReflectionCase data{.lights = {.receivers = std::move(receivers),
                                         .found = {},
                                         .clamp_radius = std::numeric_limits<float>::infinity()},
                              .reflections = {},
                              .spacing = {}};
    vary(data.lights.receivers);
    const float extent = max_component(bounds(scene).size());
    std::vector<SharedReflection> places;
    place_lights(data.lights, 16, is_clear, [&](std::size_t, std::size_t, Pcg32& random) {
        SharedReflection at{.triangle = random.next() % static_cast<uint>(scene.triangles.size()),
                            .u = 0.1f + 0.4f * random.uniform(),
                            .v = 0.1f + 0.4f * random.uniform(),
                            .model = random.uniform(),
                            .arriving = {},
                            .light_pdf = 2 * random.uniform() - 0.5f};
        const Triangle& triangle = scene.triangles[at.triangle];
        const Vec3 corner = scene.vertices[triangle.v0].position;
        const Vec3 edge1 = scene.vertices[triangle.v1].position - corner;
        const Vec3 edge2 = scene.vertices[triangle.v2].position - corner;
        const Vec3 normal = normalize(cross(edge1, edge2));
        const Vec3 aside{random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f};
        at.arriving = normalize(normal + aside);
        places.push_back(at);
        return ReceiverPoint{corner + edge1 * at.u + edge2 * at.v + normal * (1e-4f * extent), normal};
    });
    data.reflections.resize(data.lights.found.size(), SharedReflection{});
    for (std::size_t i = 0; i < places.size(); ++i) {
        data.reflections[16 * i] = places[i];
    }
    for (std::size_t i = 0; i < data.lights.found.size(); ++i) {
        data.lights.found[i].curve = 0;
        data.spacing.push_back(0.1f * extent * static_cast<float>(i % 7));
    }
    return data;
}

std::vector<Vec3> reflected_irradiance(const SharedReflectionCase& data, const Scene& scene,
                                       const std::function<bool(Vec3, Vec3)>& is_visible,
                                       const std::function<double(double)>& transmission) {
    std::vector<Vec3> result(data.lights.receivers.size() * NEARLIGHT_PACKET_SIZE, Vec3{0, 0, 0});
    const auto gloss = [&](std::size_t light, std::size_t receiver) {
        return gloss_towards(data, scene, light, receiver_at(data.lights.receivers, receiver).position);
    };
    const auto paths = [&](std::size_t light, std::size_t receiver) -> std::optional<double> {
        const Gloss g = gloss(light, receiver);
        const float distance =
            length(receiver_at(data.lights.receivers, receiver).position - data.lights.found[light].position);
        if (!(g.width * distance > NEARLIGHT_GLOSS_REACH * data.spacing[receiver])) {
            return std::nullopt;
        }
        const double of_lights = data.reflections[light].light_pdf;
        return of_lights < 0 ? -of_lights : of_lights + g.pdf;
    };
    for_each_connection(data.lights, is_visible, paths, [&](const Connection& c) {
        const double weight = c.pair.geometry / c.density * curves_part(data.lights, c, transmission);
        result[c.receiver] +=
            as_float(gloss(c.light, c.receiver).value * weight) * data.lights.found[c.light].radiance;
    });
    return result;
}

}  // namespace nearlight::core
