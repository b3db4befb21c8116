// SPDX-License-Identifier: Apache-2.0
// Vessels; all stand on y = 0, about the y axis.
#pragma once

#include "scenes/generator/curves.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// A handle in the half plane z = 0, x > 0 through the points (distance from axis, height).
Mesh make_handle(std::span<const Vec3> points, float radius);
/// Parts `glaze` and coffee.
Model make_mug(const std::string& glaze);
/// Parts `glaze` and tea.
Model make_cup_and_saucer(const std::string& glaze);
/// The spout points to +x. Parts `glaze`, `trim` and spout_hole.
Model make_teapot(const std::string& glaze, const std::string& trim);
Model make_sugar_bowl(const std::string& glaze, const std::string& trim);
/// A tin with a lid and a coloured band. Parts `body`, `band`.
Model make_tea_caddy(const std::string& body, const std::string& band);

/// What the potters of the showcase make.
enum class Pot { round_vase, bottle, bowl, amphora, jug, goblet, jar, tall_vase, gourd, plate };
inline constexpr int kPotKinds = 10;
/// About 0.2 m tall (bowl: wide), its lower part and its rim or rings of another part.
Model make_pot(Pot kind, const std::string& glaze, const std::string& trim);
/// A storage crock of the given height with a lid, two lugs and two painted rings.
Model make_crock(float height, const std::string& glaze, const std::string& trim, bool lid);

}  // namespace nearlight::core::scenes
