// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/lion.h"

#include "scenes/generator/carving.h"
#include "scenes/generator/noise.h"

namespace nearlight::core::scenes {
namespace {

constexpr Vec3 kHead{0.0f, 0.71f, 0.15f};

void carve_body(Carving& lion) {
    lion.add(solid_cone({0, 0.2f, -0.2f}, {0, 0.46f, 0.04f}, 0.19f, 0.17f), 0.05f);
    lion.add(solid_ellipsoid({0, 0.42f, 0.1f}, {0.18f, 0.2f, 0.15f}), 0.08f);
    lion.add_pair(
        [](float x) {
            return solid_ellipsoid({x * 0.17f, 0.17f, -0.16f}, {0.11f, 0.165f, 0.2f});
        },
        0.04f);
    // Neck.
    lion.add(solid_cone({0, 0.5f, 0.06f}, kHead, 0.16f, 0.15f), 0.06f);
}

/// Carves a row of toes with claws at the front of a paw.
void carve_toes(Carving& lion, Vec3 paw, float width) {
    for (int toe = 0; toe < 4; ++toe) {
        const float place = (static_cast<float>(toe) - 1.5f) / 1.5f;
        const Vec3 knuckle = paw + Vec3{place * width, 0.006f, 0.075f - 0.018f * place * place};
        lion.add(solid_ellipsoid(knuckle, {0.024f, 0.036f, 0.036f}), 0.008f);
        lion.add(
            solid_cone(knuckle + Vec3{0, -0.008f, 0.026f}, knuckle + Vec3{0, -0.03f, 0.048f}, 0.011f, 0.004f),
            0.004f);
    }
}

void carve_legs(Carving& lion) {
    for (const float x : {-1.0f, 1.0f}) {
        lion.add(solid_cone({x * 0.125f, 0.42f, 0.12f}, {x * 0.135f, 0.22f, 0.2f}, 0.085f, 0.066f), 0.05f);
        lion.add(solid_cone({x * 0.135f, 0.22f, 0.2f}, {x * 0.14f, 0.06f, 0.22f}, 0.064f, 0.058f), 0.03f);
        const Vec3 paw{x * 0.142f, 0.042f, 0.255f};
        lion.add(solid_ellipsoid(paw, {0.074f, 0.048f, 0.1f}), 0.025f);
        carve_toes(lion, paw, 0.05f);
        const Vec3 hind{x * 0.25f, 0.04f, 0.0f};
        lion.add(solid_ellipsoid(hind, {0.062f, 0.045f, 0.11f}), 0.02f);
        carve_toes(lion, hind, 0.042f);
        // There is a flame of hair at the elbow and one on the haunch.
        for (int lock = 0; lock < 3; ++lock) {
            const float s = static_cast<float>(lock);
            lion.add(solid_curl({x * (0.255f - 0.005f * s), 0.27f - 0.06f * s, -0.2f + 0.055f * s},
                                {x, 0.1f, 0.1f}, 0.042f - 0.004f * s, 1.4f),
                     0.01f);
        }
    }
}

void carve_mouth(Carving& lion) {
    lion.add(solid_box({0, 0.665f, 0.3f}, {0.105f, 0.055f, 0.1f}, 0.045f), 0.045f);
    // Cheeks, lower jaw, chin beard.
    lion.add_pair(
        [](float x) {
            return solid_ellipsoid({x * 0.06f, 0.665f, 0.37f}, {0.055f, 0.042f, 0.045f});
        },
        0.02f);
    lion.add(solid_box({0, 0.545f, 0.27f}, {0.085f, 0.03f, 0.095f}, 0.028f), 0.03f);
    lion.cut(solid_box({0, 0.602f, 0.34f}, {0.082f, 0.036f, 0.12f}, 0.025f), 0.012f);
    lion.add(solid_cone({0, 0.578f, 0.25f}, {0, 0.585f, 0.345f}, 0.035f, 0.026f), 0.008f);
    for (int tooth = 0; tooth < 6; ++tooth) {
        const float place = (static_cast<float>(tooth) - 2.5f) / 2.5f;
        const bool fang = tooth == 0 || tooth == 5;
        const float z = 0.392f - 0.03f * place * place, reach = fang ? 0.05f : 0.026f;
        lion.add(solid_cone({place * 0.068f, 0.64f, z}, {place * 0.066f, 0.64f - reach, z + 0.002f},
                            fang ? 0.015f : 0.013f, fang ? 0.006f : 0.01f),
                 0.003f);
        lion.add(solid_cone({place * 0.062f, 0.56f, z - 0.04f},
                            {place * 0.06f, 0.56f + 0.75f * reach, z - 0.038f}, 0.012f, 0.007f),
                 0.003f);
    }
    for (int lock = 0; lock < 5; ++lock) {
        const float place = (static_cast<float>(lock) - 2.0f) / 2.0f;
        lion.add(
            solid_curl({place * 0.085f, 0.505f + 0.02f * std::abs(place), 0.35f - 0.05f * std::abs(place)},
                       {0.6f * place, -0.4f, 1}, 0.038f, 1.4f),
            0.006f);
    }
}

/// Carves a bulging eye with a drilled pupil between two lids.
void carve_eye(Carving& lion, float x) {
    const Vec3 eye{x * 0.088f, 0.768f, 0.293f};
    lion.cut(solid_ellipsoid(eye + Vec3{0, 0, 0.02f}, {0.05f, 0.038f, 0.03f}), 0.012f);
    lion.add(solid_ellipsoid(eye, {0.037f, 0.035f, 0.036f}), 0.003f);
    lion.cut(solid_ellipsoid(eye + Vec3{-0.002f * x, -0.002f, 0.037f}, {0.013f, 0.013f, 0.012f}), 0.003f);
    for (const float lid : {-1.0f, 1.0f}) {
        const Vec3 middle = eye + Vec3{0, lid * 0.033f, 0.024f};
        for (const float side : {-1.0f, 1.0f}) {
            const Vec3 corner = eye + Vec3{side * 0.045f, lid * 0.006f, side * x > 0 ? -0.004f : 0.022f};
            lion.add(solid_cone(middle, corner, lid > 0 ? 0.013f : 0.009f, 0.007f), 0.006f);
        }
    }
}

void carve_face(Carving& lion) {
    lion.add(solid_ellipsoid(kHead, {0.18f, 0.165f, 0.17f}), 0.05f);
    carve_mouth(lion);
    // A broad, short nose.
    lion.add(solid_cone({0, 0.775f, 0.29f}, {0, 0.74f, 0.365f}, 0.03f, 0.04f), 0.02f);
    lion.add_pair(
        [](float x) {
            return solid_ellipsoid({x * 0.042f, 0.724f, 0.375f}, {0.034f, 0.027f, 0.03f});
        },
        0.01f);
    for (const float x : {-1.0f, 1.0f}) {
        lion.cut(solid_ellipsoid({x * 0.042f, 0.716f, 0.408f}, {0.015f, 0.011f, 0.016f}), 0.006f);
        carve_eye(lion, x);
        // Heavy brows of bosses that end in a curl.
        for (int boss = 0; boss < 4; ++boss) {
            const float s = static_cast<float>(boss);
            lion.add(solid_curl({x * (0.028f + 0.041f * s), 0.826f + 0.012f * s - 0.009f * s * s,
                                 0.318f - 0.02f * s},
                                {x * 0.2f * s, 0.25f, 1}, 0.03f, 1.5f),
                     0.005f);
        }
        lion.add(solid_curl({x * 0.125f, 0.66f, 0.31f}, {x, 0, 0.6f}, 0.034f, 1.5f), 0.008f);
        lion.add(solid_cone({x * 0.16f, 0.81f, 0.14f}, {x * 0.24f, 0.855f, 0.13f}, 0.055f, 0.026f), 0.02f);
        lion.cut(solid_ellipsoid({x * 0.212f, 0.838f, 0.18f}, {0.03f, 0.023f, 0.026f}), 0.01f);
    }
}

/// Carves rows of curls over the back and the sides of the head and down the neck.
void carve_mane(Carving& lion) {
    constexpr int kRows = 6;
    for (int row = 0; row < kRows; ++row) {
        const float tilt = -0.35f + 2.25f * static_cast<float>(row) / (kRows - 1);  // from the brow backwards
        const int count = 11 - (row >= 4 ? 1 : 0);
        for (int i = 0; i < count; ++i) {
            const float around = kPi * (static_cast<float>(i) + (row % 2 == 1 ? 0.0f : 0.5f)) /
                                 static_cast<float>(count - (row % 2 == 1 ? 1 : 0));
            const Vec3 arch{std::cos(around) * 1.12f, std::sin(around), 0.0f};
            // The arch of each row over the head leans further back than that of the row before.
            const float back = std::sin(tilt), up = std::cos(tilt);
            const Vec3 out = normalize({arch.x, arch.y * up - 0.28f * back * (1.0f - arch.y),
                                        -back * (0.25f + 0.75f * arch.y) + 0.18f * up});
            const Vec3 place =
                kHead + Vec3{0, -0.02f, -0.05f} + Vec3{out.x * 0.205f, out.y * 0.19f, out.z * 0.18f};
            lion.add(solid_curl(place, out, 0.047f, 1.7f), 0.006f);
        }
    }
    for (int row = 0; row < 4; ++row) {
        const float down = static_cast<float>(row), spread = 1.35f - 0.12f * down;
        constexpr int kCount = 13;
        for (int i = 0; i < kCount; ++i) {
            const float place =
                (static_cast<float>(i) + 0.5f * static_cast<float>(row % 2)) / (kCount - 0.5f);
            const float around = 0.5f * kPi + spread * kPi * (place - 0.5f);
            const Vec3 out = normalize({std::cos(around), -0.1f, -std::sin(around)});
            const Vec3 center{0, 0.575f - 0.062f * down, 0.035f - 0.045f * down};
            lion.add(solid_curl(center + Vec3{out.x * 0.2f, 0, out.z * 0.2f}, out, 0.046f, 1.7f), 0.006f);
        }
    }
}

/// Carves a collar with tassels and a bell at the chest.
void carve_collar(Carving& lion) {
    for (int i = 0; i <= 16; ++i) {
        const float around = kPi * (static_cast<float>(i) / 16.0f);
        const Vec3 bead{0.185f * std::cos(around), 0.47f - 0.07f * std::sin(around),
                        0.11f + 0.165f * std::sin(around)};
        lion.add(solid_ellipsoid(bead, {0.02f, 0.02f, 0.02f}), 0.006f);
    }
    lion.add(solid_ellipsoid({0, 0.35f, 0.28f}, {0.042f, 0.044f, 0.04f}), 0.006f);
    lion.cut(solid_box({0, 0.33f, 0.32f}, {0.035f, 0.004f, 0.02f}, 0.002f), 0.004f);
    lion.add_pair(
        [](float x) {
            return solid_cone({x * 0.085f, 0.38f, 0.245f}, {x * 0.095f, 0.31f, 0.25f}, 0.014f, 0.026f);
        },
        0.008f);
}

void carve_tail(Carving& lion) {
    const Vec3 joints[] = {{0, 0.12f, -0.38f}, {0, 0.26f, -0.43f}, {0, 0.38f, -0.4f}};
    for (int i = 0; i < 2; ++i) {
        lion.add(solid_cone(joints[i], joints[i + 1], 0.05f - 0.005f * static_cast<float>(i), 0.045f), 0.03f);
    }
    for (int lock = 0; lock < 5; ++lock) {
        const float s = static_cast<float>(lock) - 2.0f;
        lion.add(solid_curl({0.05f * s, 0.44f - 0.022f * s * s, -0.39f}, {0.3f * s, 0.3f, -1}, 0.055f, 1.7f),
                 0.01f);
    }
}

float chisel_marks(Vec3 p) {
    const float strokes = value_noise({p.x * 90.0f, p.y * 30.0f, p.z * 90.0f});
    return 0.0016f * strokes + 0.0026f * fractal_noise(p * 24.0f, 3) + 0.0009f * value_noise(p * 260.0f);
}

}  // namespace

Mesh make_guardian_lion(float cell) {
    Carving lion;
    carve_body(lion);
    carve_legs(lion);
    carve_tail(lion);
    carve_collar(lion);
    carve_face(lion);
    carve_mane(lion);
    // The lion's base is flat and reaches a little into the plinth.
    lion.cut([](Vec3 p) { return p.y + 0.004f; }, 0.004f);
    lion.set_roughness(chisel_marks, 0.006f);
    return lion.mesh({{-0.38f, -0.03f, -0.52f}, {0.38f, 1.02f, 0.5f}}, cell);
}

}  // namespace nearlight::core::scenes
