// SPDX-License-Identifier: Apache-2.0
// Values over time, as the samplers of glTF's animations have them [glTF 2.0, 3.11].
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/scene/gltf/gltf_file.h"

namespace nearlight::core::gltf {

enum class CurveShape { linear, step, cubic };

/// What is between the keys: numbers that are interpolated each by itself, or a rotation as x, y, z, w.
enum class CurveKind { numbers, rotation };

struct KeyCurve {
    CurveShape shape = CurveShape::linear;
    CurveKind kind = CurveKind::numbers;
    std::size_t width = 1;      ///< numbers of a value
    std::vector<float> times;   ///< seconds, ascending; at least one
    std::vector<float> values;  ///< `width` for each key; of cubic curves a tangent, a value and a tangent
};

/// The curve of a sampler. `components` are those of one element of its output accessor; a value may be made
/// of several elements. Calls fail() if it is broken; `owner` names the animation in the message.
KeyCurve read_curve(const GltfFile& file, const tinygltf::AnimationSampler& sampler, CurveKind kind,
                    std::size_t width, int components, const std::string& owner);

/// The value at a time; before the first key and after the last one it is that of the key.
std::vector<double> value_at(const KeyCurve& curve, double seconds);

}  // namespace nearlight::core::gltf
