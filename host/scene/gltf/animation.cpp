// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/animation.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "host/base/hash.h"
#include "host/scene/gltf/key_curve.h"
#include "host/scene/named_choice.h"
#include "host/scene/scene_names.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

/// A property of a node: its index, and the path.
using Target = std::pair<int, std::string>;

std::string animation_name(const GltfFile& file, std::size_t animation) {
    const std::string& name = file.model.animations[animation].name;
    return "animation " + (name.empty() ? std::to_string(animation + 1) : "'" + name + "'");
}

/// Nodes without a name are counted from 1, as in the names of objects.
std::string name_of_node(const GltfFile& file, int node) {
    const std::string& name = file.model.nodes[static_cast<std::size_t>(node)].name;
    return "node " + (name.empty() ? std::to_string(node + 1) : "'" + name + "'");
}

/// What an animation moves. Channels without a node are to be ignored, and so are properties that glTF's
/// later versions may add.
std::map<Target, const tinygltf::AnimationChannel*> targets_of(const GltfFile& file, std::size_t animation) {
    static const std::set<std::string> kPaths{"translation", "rotation", "scale", "weights"};
    std::map<Target, const tinygltf::AnimationChannel*> targets;
    for (const tinygltf::AnimationChannel& channel : file.model.animations[animation].channels) {
        if (channel.target_node >= 0 && kPaths.contains(channel.target_path)) {
            file.at(file.model.nodes, channel.target_node, "node", animation_name(file, animation));
            targets[{channel.target_node, channel.target_path}] = &channel;
        }
    }
    return targets;
}

/// The animations that are asked for by name or number.
std::vector<std::size_t> named_animations(const GltfFile& file, const std::vector<std::string>& wanted) {
    std::vector<std::vector<std::string>> names;
    for (const tinygltf::Animation& animation : file.model.animations) {
        names.push_back({animation.name});
    }
    std::vector<std::size_t> chosen;
    for (const std::string& name : wanted) {
        chosen.push_back(choose_named(file.path, "animation", names, name));
    }
    return chosen;
}

/// The animations to play. Some exporters make one for each object's motion; these belong together. Others
/// make one for each thing that a figure can do; only one of these can be shown, which is the first.
std::vector<std::size_t> played_animations(const GltfFile& file, const std::vector<std::string>& wanted,
                                           NoteSink& notes) {
    std::vector<std::size_t> candidates = named_animations(file, wanted);
    for (std::size_t i = 0; wanted.empty() && i < file.model.animations.size(); ++i) {
        candidates.push_back(i);
    }
    std::vector<std::size_t> played;
    std::map<Target, std::size_t> movers;  // the played animation that moves each target
    for (const std::size_t candidate : candidates) {
        const auto targets = targets_of(file, candidate);
        const auto shared =
            std::ranges::find_if(targets, [&](const auto& entry) { return movers.contains(entry.first); });
        if (shared == targets.end()) {
            for (const auto& [target, channel] : targets) {
                movers.emplace(target, candidate);
            }
            played.push_back(candidate);
        } else if (const std::size_t other = movers.at(shared->first); other != candidate) {
            const Target& target = shared->first;
            const std::string both = animation_name(file, candidate) + " and " + animation_name(file, other) +
                                     " both move the " + target.second + " of " +
                                     name_of_node(file, target.first);
            if (!wanted.empty()) {
                throw Error(ErrorKind::invalid_argument, file.path.string() + ": " + both + "; choose one",
                            "animation");
            }
            notes.remark(file.path, 0, both + "; only the latter is played");
        }
    }
    return played;
}

/// The number of morph targets of a node's mesh.
std::size_t morph_target_count(const GltfFile& file, const tinygltf::Node& node, const std::string& owner) {
    if (node.mesh < 0) {
        return 0;
    }
    const tinygltf::Mesh& mesh = file.at(file.model.meshes, node.mesh, "mesh", owner);
    return mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
}

KeyCurve curve_of(const GltfFile& file, std::size_t animation, const tinygltf::AnimationChannel& channel) {
    const std::string owner = animation_name(file, animation);
    const auto& node = file.model.nodes[static_cast<std::size_t>(channel.target_node)];
    const tinygltf::AnimationSampler& sampler =
        file.at(file.model.animations[animation].samplers, channel.sampler, "sampler", owner);
    if (channel.target_path == "weights") {
        const std::size_t count = morph_target_count(file, node, owner);
        if (count == 0) {
            file.fail(owner + " has weights for " + name_of_node(file, channel.target_node) +
                      ", which has no morph targets");
        }
        return read_curve(file, sampler, CurveKind::numbers, count, 1, owner);
    }
    if (!node.matrix.empty()) {
        file.fail(owner + " moves " + name_of_node(file, channel.target_node) +
                  ", which has a matrix; it must have a translation, rotation and scale instead");
    }
    return channel.target_path == "rotation" ? read_curve(file, sampler, CurveKind::rotation, 4, 4, owner)
                                             : read_curve(file, sampler, CurveKind::numbers, 3, 3, owner);
}

std::vector<double>& property_of(tinygltf::Node& node, const std::string& path) {
    return path == "translation" ? node.translation
           : path == "rotation"  ? node.rotation
           : path == "scale"     ? node.scale
                                 : node.weights;
}

/// Both spans and what lies between them.
TimeSpan united(const std::optional<TimeSpan>& span, const KeyCurve& curve) {
    const TimeSpan keys{double{curve.times.front()}, double{curve.times.back()}};
    return span ? TimeSpan{std::min(span->begin, keys.begin), std::max(span->end, keys.end)} : keys;
}

}  // namespace

TimeSpan pose_nodes(GltfFile& file, const SceneMoment& moment, NoteSink& notes) {
    if (file.model.animations.empty()) {
        throw Error(ErrorKind::invalid_argument, file.path.string() + ": has no animations", "frames");
    }
    if (std::ranges::find(file.model.extensionsUsed, "KHR_animation_pointer") !=
        file.model.extensionsUsed.end()) {
        notes.approximation(file.path, 0,
                            "of animations by KHR_animation_pointer, such as of materials, nothing moves");
    }
    std::optional<TimeSpan> span;
    for (const std::size_t animation : played_animations(file, moment.animations, notes)) {
        for (const auto& [target, channel] : targets_of(file, animation)) {
            const KeyCurve curve = curve_of(file, animation, *channel);
            span = united(span, curve);
            property_of(file.model.nodes[static_cast<std::size_t>(target.first)], target.second) =
                value_at(curve, moment.seconds);
        }
    }
    if (!span) {
        file.fail("its animations move nothing");
    }
    return *span;
}

std::vector<SceneAnimation> list_animations(const GltfFile& file) {
    std::vector<SceneAnimation> animations;
    for (std::size_t i = 0; i < file.model.animations.size(); ++i) {
        SceneAnimation& animation = animations.emplace_back();
        animation.name = file.model.animations[i].name;
        try {
            for (const auto& [target, channel] : targets_of(file, i)) {
                const std::string& node = file.model.nodes[static_cast<std::size_t>(target.first)].name;
                animation.motions.push_back(
                    {name_or_number(node, "node", static_cast<std::size_t>(target.first) + 1),
                     target.second});
                animation.span = united(animation.span, curve_of(file, i, *channel));
            }
        } catch (const Error& error) {
            animation.fault = error.what();
        }
    }
    return animations;
}

std::uint64_t pose_hash(const GltfFile& file, const std::vector<PlacedNode>& nodes) {
    Hasher hasher;
    std::vector<Mat4> world;
    for (const PlacedNode& placed : nodes) {
        const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.index)];
        if (node.mesh < 0 && !node.extensions.contains("KHR_lights_punctual")) {
            continue;
        }
        hasher.add(placed.index);
        hasher.add(placed.to_world.m);
        hasher.add_array(node.weights);
        if (node.skin >= 0) {
            world = world.empty() ? world_transforms(file) : std::move(world);
            for (const int joint : file.at(file.model.skins, node.skin, "skin", "a node").joints) {
                file.at(file.model.nodes, joint, "node", "a skin");
                hasher.add(world[static_cast<std::size_t>(joint)].m);
            }
        }
    }
    return hasher.hash64();
}

}  // namespace nearlight::core::gltf
