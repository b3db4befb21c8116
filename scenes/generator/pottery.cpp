// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/pottery.h"

#include "scenes/generator/shapes.h"

namespace nearlight::core::scenes {
namespace {

constexpr int kSegments = 72;

Mesh turn_vessel(std::initializer_list<Vec3> outside, float thickness) {
    return lathe(vessel(Curve(outside), thickness, 6), kSegments);
}

/// The surface of a liquid: a flat disc whose rim is inside the vessel's wall.
Mesh make_liquid(float radius, float height) {
    return moved(cylinder(radius, 0.004f, 0.0015f, kSegments), {0, height - 0.004f, 0});
}

Mesh make_spout(std::initializer_list<Vec3> points, float root, float tip) {
    return tube(spline(Curve(points), 12), {{root, 0.75f * root, 0.6f * (root + tip), tip, tip}, 1.0f, 32});
}

/// Adds a vessel as two parts, one below the height and one above.
void add_dipped(Model& model, const Mesh& mesh, float height, const std::string& below,
                const std::string& above) {
    const auto [low, high] = split(mesh, [&](Vec3 p) { return p.y < height; });
    model.add(below, low);
    model.add(above, high);
}

Mesh make_ring(float radius, float height, float thickness) {
    return moved(torus(radius, thickness, kSegments, 12), {0, height, 0});
}

Mesh make_knobbed_lid(float radius, float dome, float knob) {
    const Profile corners{at(0, -0.3f * dome),
                          at(0.8f * radius, -0.3f * dome),
                          at(0.82f * radius, 0.02f * radius),
                          at(radius, 0.02f * radius),
                          at(radius, 0.1f * radius),
                          at(0.8f * radius, 0.55f * dome),
                          at(0.4f * radius, 0.93f * dome),
                          at(0.5f * knob, dome),
                          at(0.45f * knob, dome + 0.6f * knob),
                          at(knob, dome + 1.2f * knob),
                          at(0.9f * knob, dome + 1.9f * knob),
                          at(0.4f * knob, dome + 2.2f * knob),
                          at(0, dome + 2.2f * knob)};
    return lathe(rounded(corners, 0.12f * radius), kSegments);
}

}  // namespace

Mesh make_handle(std::span<const Vec3> points, float radius) {
    return tube(spline(points, 12),
                {{1.25f * radius, radius, 0.9f * radius, radius, 1.2f * radius}, 1.0f, 24});
}

Model make_mug(const std::string& glaze) {
    Model mug(glaze, turn_vessel({at(0.034f, 0), at(0.0395f, 0.006f), at(0.041f, 0.03f), at(0.041f, 0.06f),
                                  at(0.0415f, 0.095f)},
                                 0.004f));
    mug.add(glaze, make_handle(Curve{at(0.043f, 0.076f), at(0.062f, 0.08f), at(0.074f, 0.052f),
                                     at(0.063f, 0.027f), at(0.043f, 0.024f)},
                               0.0055f));
    mug.add("coffee", make_liquid(0.0385f, 0.08f));
    return mug;
}

Model make_cup_and_saucer(const std::string& glaze) {
    Model cup(glaze, turn_vessel({at(0.028f, 0), at(0.05f, 0.005f), at(0.068f, 0.013f), at(0.078f, 0.019f)},
                                 0.004f));
    Model bowl(glaze, turn_vessel({at(0.02f, 0), at(0.022f, 0.006f), at(0.034f, 0.018f), at(0.042f, 0.04f),
                                   at(0.046f, 0.058f)},
                                  0.003f));
    bowl.add(glaze, make_handle(Curve{at(0.0435f, 0.047f), at(0.06f, 0.052f), at(0.067f, 0.036f),
                                      at(0.056f, 0.022f), at(0.038f, 0.02f)},
                                0.0036f));
    bowl.add("tea", make_liquid(0.0425f, 0.048f));
    cup.place(bowl, {0, 0.0062f, 0});
    return cup;
}

Model make_teapot(const std::string& glaze, const std::string& trim) {
    Model pot(glaze, turn_vessel({at(0.05f, 0), at(0.056f, 0.006f), at(0.085f, 0.035f), at(0.098f, 0.075f),
                                  at(0.086f, 0.115f), at(0.056f, 0.138f), at(0.047f, 0.141f)},
                                 0.005f));
    pot.add(glaze, moved(make_knobbed_lid(0.05f, 0.022f, 0.011f), {0, 0.1415f, 0}));
    pot.add(trim, make_ring(0.0575f, 0.138f, 0.0028f));
    pot.add(trim, make_ring(0.0985f, 0.073f, 0.0022f));
    pot.add(glaze, make_spout({at(0.08f, 0.045f), at(0.118f, 0.058f), at(0.14f, 0.1f), at(0.17f, 0.138f),
                               at(0.178f, 0.142f)},
                              0.026f, 0.0105f));
    const Mat4 mouth = translation(0.1845, 0.1445, 0) * rotation(0, 0, 1, -65);
    pot.add(trim, transformed(torus(0.0098f, 0.003f, 48, 12), mouth));
    pot.add("spout_hole", transformed(scaled(ellipsoid({0.0085f, 0.0035f, 0.0085f}, 32), {1, 1, 1}),
                                      mouth * translation(0, 0.0018, 0)));
    Mesh handle = make_handle(Curve{at(0.079f, 0.118f), at(0.115f, 0.135f), at(0.148f, 0.11f),
                                    at(0.14f, 0.065f), at(0.09f, 0.045f)},
                              0.0085f);
    pot.add(glaze, turned(std::move(handle), {0, 1, 0}, 180));
    return pot;
}

Model make_sugar_bowl(const std::string& glaze, const std::string& trim) {
    Model bowl(glaze, turn_vessel({at(0.03f, 0), at(0.036f, 0.006f), at(0.055f, 0.03f), at(0.053f, 0.055f),
                                   at(0.043f, 0.068f)},
                                  0.004f));
    bowl.add(glaze, moved(make_knobbed_lid(0.044f, 0.018f, 0.009f), {0, 0.0685f, 0}));
    bowl.add(trim, make_ring(0.0552f, 0.04f, 0.002f));
    const Mesh lug = make_handle(
        Curve{at(0.053f, 0.052f), at(0.068f, 0.056f), at(0.073f, 0.042f), at(0.055f, 0.032f)}, 0.0042f);
    bowl.add(glaze, lug);
    bowl.add(glaze, turned(lug, {0, 1, 0}, 180));
    return bowl;
}

Model make_tea_caddy(const std::string& body, const std::string& band) {
    Model caddy(body, cylinder(0.042f, 0.1f, 0.003f, kSegments));
    caddy.add(body, moved(cylinder(0.0435f, 0.032f, 0.005f, kSegments), {0, 0.096f, 0}));
    caddy.add(band, moved(cylinder(0.0427f, 0.05f, 0.0008f, kSegments), {0, 0.024f, 0}));
    caddy.add(band, make_ring(0.0436f, 0.1f, 0.0012f));
    caddy.add(band, moved(ellipsoid({0.009f, 0.007f, 0.009f}, 32), {0, 0.132f, 0}));
    return caddy;
}

namespace {

Model make_round_vase(const std::string& glaze, const std::string& trim) {
    Model pot;
    add_dipped(pot,
               turn_vessel({at(0.045f, 0), at(0.055f, 0.008f), at(0.09f, 0.06f), at(0.085f, 0.12f),
                            at(0.04f, 0.165f), at(0.036f, 0.19f), at(0.052f, 0.21f)},
                           0.006f),
               0.05f, trim, glaze);
    pot.add(trim, make_ring(0.04f, 0.166f, 0.004f));
    return pot;
}

Model make_bottle(const std::string& glaze, const std::string& trim) {
    Model pot(glaze, turn_vessel({at(0.04f, 0), at(0.05f, 0.006f), at(0.066f, 0.04f), at(0.06f, 0.085f),
                                  at(0.026f, 0.13f), at(0.018f, 0.18f), at(0.018f, 0.24f), at(0.028f, 0.26f)},
                                 0.005f));
    pot.add(trim, make_ring(0.0645f, 0.05f, 0.003f));
    pot.add(trim, make_ring(0.0183f, 0.2f, 0.0028f));
    return pot;
}

Model make_bowl(const std::string& glaze, const std::string& trim) {
    Model pot(glaze, turn_vessel({at(0.045f, 0), at(0.046f, 0.012f), at(0.075f, 0.03f), at(0.105f, 0.07f),
                                  at(0.118f, 0.105f)},
                                 0.006f));
    pot.add(trim, make_ring(0.1125f, 0.088f, 0.0035f));
    return pot;
}

Model make_amphora(const std::string& glaze, const std::string& trim) {
    Model pot;
    add_dipped(pot,
               turn_vessel({at(0.036f, 0), at(0.036f, 0.012f), at(0.062f, 0.07f), at(0.08f, 0.14f),
                            at(0.062f, 0.19f), at(0.032f, 0.215f), at(0.03f, 0.25f), at(0.044f, 0.268f)},
                           0.006f),
               0.15f, glaze, trim);
    const Mesh handle = make_handle(
        Curve{at(0.034f, 0.25f), at(0.07f, 0.258f), at(0.092f, 0.22f), at(0.074f, 0.168f)}, 0.0065f);
    pot.add(trim, handle);
    pot.add(trim, turned(handle, {0, 1, 0}, 180));
    return pot;
}

Model make_jug(const std::string& glaze, const std::string& trim) {
    Model pot;
    add_dipped(pot,
               turn_vessel({at(0.05f, 0), at(0.058f, 0.008f), at(0.078f, 0.05f), at(0.076f, 0.11f),
                            at(0.052f, 0.16f), at(0.05f, 0.19f), at(0.06f, 0.212f)},
                           0.006f),
               0.035f, trim, glaze);
    pot.add(glaze, make_handle(Curve{at(0.054f, 0.195f), at(0.095f, 0.2f), at(0.118f, 0.15f),
                                     at(0.105f, 0.09f), at(0.077f, 0.07f)},
                               0.0085f));
    // The pulled lip opposite the handle.
    pot.add(glaze, turned(tube(spline(Curve{at(0.045f, 0.178f), at(0.06f, 0.2f), at(0.078f, 0.216f)}, 8),
                               {{0.02f, 0.018f, 0.008f}, 0.6f, 24}),
                          {0, 1, 0}, 180));
    return pot;
}

Model make_goblet(const std::string& glaze, const std::string& trim) {
    Model pot(glaze, moved(turn_vessel({at(0.018f, 0), at(0.04f, 0.014f), at(0.056f, 0.05f), at(0.06f, 0.1f)},
                                       0.005f),
                           {0, 0.075f, 0}));
    const Profile stem{at(0, 0),          at(0.045f, 0),    at(0.046f, 0.006f),
                       at(0.016f, 0.02f), at(0.01f, 0.04f), at(0.018f, 0.05f),
                       at(0.01f, 0.06f),  at(0.02f, 0.08f), at(0, 0.08f)};
    pot.add(trim, lathe(rounded(stem, 0.006f), kSegments));
    return pot;
}

Model make_jar(const std::string& glaze, const std::string& trim) {
    Model pot;
    add_dipped(pot,
               turn_vessel({at(0.055f, 0), at(0.065f, 0.01f), at(0.078f, 0.05f), at(0.08f, 0.1f),
                            at(0.068f, 0.14f), at(0.058f, 0.15f)},
                           0.006f),
               0.09f, glaze, trim);
    pot.add(glaze, moved(make_knobbed_lid(0.06f, 0.03f, 0.014f), {0, 0.1505f, 0}));
    return pot;
}

Model make_tall_vase(const std::string& glaze, const std::string& trim) {
    Model pot(glaze, turn_vessel({at(0.035f, 0), at(0.04f, 0.008f), at(0.044f, 0.06f), at(0.058f, 0.15f),
                                  at(0.062f, 0.2f), at(0.04f, 0.245f), at(0.048f, 0.28f)},
                                 0.005f));
    for (const float y : {0.195f, 0.205f, 0.215f}) {
        pot.add(trim, make_ring(0.0605f - (y - 0.195f) * 0.15f, y, 0.0028f));
    }
    return pot;
}

Model make_gourd(const std::string& glaze, const std::string& trim) {
    Model pot;
    add_dipped(pot,
               turn_vessel(
                   {at(0.042f, 0), at(0.052f, 0.008f), at(0.08f, 0.05f), at(0.072f, 0.1f), at(0.036f, 0.135f),
                    at(0.05f, 0.17f), at(0.04f, 0.205f), at(0.018f, 0.225f), at(0.022f, 0.25f)},
                   0.005f),
               0.132f, glaze, trim);
    pot.add(glaze, make_ring(0.0372f, 0.134f, 0.004f));
    return pot;
}

/// A plate that stands on its rim and leans against the wall behind it (−z).
Model make_leaning_plate(const std::string& glaze, const std::string& trim) {
    Model plate(glaze,
                turn_vessel({at(0.06f, 0), at(0.065f, 0.006f), at(0.1f, 0.016f), at(0.12f, 0.026f)}, 0.005f));
    plate.add(trim, make_ring(0.1185f, 0.0285f, 0.0032f));
    plate.add(trim, moved(cylinder(0.05f, 0.003f, 0.001f, kSegments), {0, 0.0065f, 0}));
    Model leaning;
    leaning.add(plate, translation(0, 0.1195, -0.03) * rotation(1, 0, 0, 76));
    for (const float x : {-0.04f, 0.04f}) {
        leaning.add(trim, tube(Curve{{x, 0.006f, -0.05f}, {x, 0.006f, 0.03f}, {x, 0.03f, 0.038f}},
                               {{0.006f}, 1.0f, 12}));
    }
    return leaning;
}

}  // namespace

Model make_pot(Pot kind, const std::string& glaze, const std::string& trim) {
    switch (kind) {
        case Pot::round_vase:
            return make_round_vase(glaze, trim);
        case Pot::bottle:
            return make_bottle(glaze, trim);
        case Pot::bowl:
            return make_bowl(glaze, trim);
        case Pot::amphora:
            return make_amphora(glaze, trim);
        case Pot::jug:
            return make_jug(glaze, trim);
        case Pot::goblet:
            return make_goblet(glaze, trim);
        case Pot::jar:
            return make_jar(glaze, trim);
        case Pot::tall_vase:
            return make_tall_vase(glaze, trim);
        case Pot::gourd:
            return make_gourd(glaze, trim);
        case Pot::plate:
            return make_leaning_plate(glaze, trim);
    }
    return {};
}

Model make_crock(float height, const std::string& glaze, const std::string& trim, bool lid) {
    Model crock;
    add_dipped(crock,
               turn_vessel({at(0.29f, 0), at(0.31f, 0.02f), at(0.4f, 0.3f), at(0.42f, 0.6f), at(0.36f, 0.86f),
                            at(0.31f, 0.93f), at(0.34f, 1.0f)},
                           0.03f),
               0.2f, trim, glaze);
    crock.add(trim, make_ring(0.412f, 0.69f, 0.012f));
    crock.add(trim, make_ring(0.4f, 0.74f, 0.012f));
    const Mesh lug = make_handle(Curve{{0.375f, 0.82f, -0.1f},
                                       {0.44f, 0.84f, -0.07f},
                                       {0.47f, 0.84f, 0.0f},
                                       {0.44f, 0.84f, 0.07f},
                                       {0.375f, 0.82f, 0.1f}},
                                 0.028f);
    crock.add(glaze, lug);
    crock.add(glaze, turned(lug, {0, 1, 0}, 180));
    if (lid) {
        crock.add(trim, moved(make_knobbed_lid(0.35f, 0.1f, 0.05f), {0, 0.998f, 0}));
    }
    Model sized;
    sized.add(crock, scaling(height, height, height));
    return sized;
}

}  // namespace nearlight::core::scenes
