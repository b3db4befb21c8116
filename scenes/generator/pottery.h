// SPDX-License-Identifier: Apache-2.0
// Vessels, which all stand on y = 0 about the y axis.
#pragma once

#include "scenes/generator/curves.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// A handle in the half plane z = 0, x > 0, through the points (distance from the axis, height).
Mesh make_handle(std::span<const Vec3> points, float radius);
/// A mug with the parts `glaze` and coffee.
Model make_mug(const std::string& glaze);
/// A cup and saucer with the parts `glaze` and tea.
Model make_cup_and_saucer(const std::string& glaze);
/// A teapot whose spout points to +x. Its parts are `glaze`, `trim` and spout_hole.
Model make_teapot(const std::string& glaze, const std::string& trim);
Model make_sugar_bowl(const std::string& glaze, const std::string& trim);
/// A tin with a lid and a coloured band. Its parts are `body` and `band`.
Model make_tea_caddy(const std::string& body, const std::string& band);

/// The kinds of pots in the showcase.
enum class Pot { round_vase, bottle, bowl, amphora, jug, goblet, jar, tall_vase, gourd, plate };
inline constexpr int kPotKinds = 10;
/// A pot about 0.2 m tall (bowl: wide). Its lower part and its rim or rings are the part `trim`, the rest is
/// `glaze`.
Model make_pot(Pot kind, const std::string& glaze, const std::string& trim);
/// A storage crock of the given height with a lid, two lugs and two painted rings.
Model make_crock(float height, const std::string& glaze, const std::string& trim, bool lid);

}  // namespace nearlight::core::scenes
