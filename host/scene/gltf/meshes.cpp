// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/meshes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/scene/gltf/front_normals.h"
#include "host/scene/gltf/lights_and_cameras.h"
#include "host/scene/gltf/mesh_pose.h"
#include "host/scene/scene_names.h"
#include "host/scene/seen_side.h"
#include "host/scene/shining_backs.h"

namespace nearlight::core::gltf {
namespace {

/// The maximum number of instances that one mesh may have.
constexpr std::size_t kMaxInstances = std::size_t{1} << 20u;

std::vector<Vec3> to_vectors(const std::vector<float>& numbers) {
    std::vector<Vec3> vectors(numbers.size() / 3);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        vectors[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    }
    return vectors;
}

std::string name_of_uvs(int set) {
    return "TEXCOORD_" + std::to_string(set);
}

/// Reads texture coordinates. v is 0 at the top of an image in glTF, and at its bottom in a Mesh.
std::vector<std::array<float, 2>> read_uvs(const PrimitiveData& data, int set) {
    if (set < 0 || !data.has(name_of_uvs(set))) {
        return {};
    }
    const std::vector<float> numbers = data.read(name_of_uvs(set), 2);
    std::vector<std::array<float, 2>> uvs(numbers.size() / 2);
    for (std::size_t i = 0; i < uvs.size(); ++i) {
        uvs[i] = {numbers[2 * i], 1.0f - numbers[2 * i + 1]};
    }
    return uvs;
}

std::vector<std::array<uint, 3>> triangles_of(int mode, const std::vector<uint>& corners) {
    std::vector<std::array<uint, 3>> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
        }
        return triangles;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
        } else {  // every other triangle of a strip runs the other way round
            triangles.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
        }
    }
    return triangles;
}

bool makes_triangles(int mode) {
    return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

/// Whether (u, v) runs clockwise over the triangle, as seen from its front.
bool is_mirrored(const Mesh& mesh, const std::array<uint, 3>& t) {
    const auto& a = mesh.uvs[t[0]];
    const auto& b = mesh.uvs[t[1]];
    const auto& c = mesh.uvs[t[2]];
    return (b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether TANGENT, which is not read, differs from the directions of u and v of many triangles. It has four
/// numbers a vertex; the last is the side on which v grows.
bool has_other_tangents(const Mesh& mesh, std::span<const float> tangents) {
    constexpr float kMinCosine = 0.5f;
    constexpr std::size_t kMaxShare = 20;  // one triangle in so many may differ, as at seams and poles
    std::size_t others = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const float side = is_mirrored(mesh, {a, b, c}) ? -1.0f : 1.0f;
        const float v1 = mesh.uvs[b][1] - mesh.uvs[a][1];
        const float v2 = mesh.uvs[c][1] - mesh.uvs[a][1];
        const Vec3 along_u = normalize(side * ((mesh.positions[b] - mesh.positions[a]) * v2 -
                                               (mesh.positions[c] - mesh.positions[a]) * v1));
        const Vec3 tangent{tangents[4 * a], tangents[4 * a + 1], tangents[4 * a + 2]};
        const bool differs = dot(along_u, tangent) < kMinCosine || side * tangents[4 * a + 3] < 0.0f;
        others += !is_zero(along_u) && differs ? 1 : 0;
    }
    return others * kMaxShare > mesh.triangles.size();
}

/// Sorts the triangles by whether (u, v) runs clockwise, which turns normal maps over.
void group_by_side(Mesh& mesh) {
    for (const std::array<uint, 3>& triangle : mesh.triangles) {
        mesh.groups.push_back(is_mirrored(mesh, triangle) ? 1 : 0);
    }
}

/// How much longer lengths become, as the geometric mean over the axes. It is rounded, so that placements
/// which differ by rounding errors alone share a material, and it stays a number where the transform has
/// overflowed.
float rounded_scale(const Mat4& to_world) {
    constexpr double kMax = 1e30;
    constexpr int kBits = 16;
    int exponent = 0;
    const double scale = std::min(kMax, std::cbrt(std::abs(linear_determinant(to_world))));
    const double fraction = std::frexp(scale, &exponent);
    return static_cast<float>(std::ldexp(std::round(std::ldexp(fraction, kBits)), exponent - kBits));
}

}  // namespace

/// Reads the mesh in its pose at rest. What is in it may be looked up without further checks.
Mesh MeshMaker::read_mesh(const tinygltf::Node& node, const tinygltf::Primitive& primitive,
                          const PrimitiveData& data) {
    Mesh mesh;
    mesh.source = file_.path;
    mesh.positions = to_vectors(data.read("POSITION", 3));
    if (data.has("NORMAL")) {
        mesh.normals = to_vectors(data.read("NORMAL", 3));
    }
    const TextureSets sets = materials_.texture_sets(primitive.material);
    mesh.uvs = read_uvs(data, std::max(sets.first, 0));
    mesh.second_uvs = read_uvs(data, sets.second);
    for (const int set : {sets.first, sets.second}) {
        if (set >= 0 && !data.has(name_of_uvs(set))) {
            notes_.approximation(file_.path, 0,
                                 "a texture asks for " + name_of_uvs(set) +
                                     ", which its mesh does not have; a corner of it is used everywhere");
        }
    }
    read_colors(data, primitive.material, mesh);
    mesh.triangles = triangles_of(data.mode(), data.corners(mesh.positions.size()));
    check_mesh(mesh);
    apply_morph_targets(file_, node, file_.model.meshes[static_cast<std::size_t>(node.mesh)], primitive, mesh,
                        notes_);
    // Joints that mirror a mesh keep its front in front, so its side is told before they move it.
    const std::vector<bool> against_normals = triangles_against_normals(mesh);
    move_joints(node, data, mesh);
    if (!std::ranges::all_of(mesh.positions, [](Vec3 position) { return is_finite(position); })) {
        file_.fail("the mesh of node '" + node.name + "' has a position that is not finite");
    }
    if (materials_.has_normal_map(primitive.material) && !mesh.uvs.empty()) {
        // Tangents of a mesh in a pose would have to be posed as well.
        if (node.skin < 0 && primitive.targets.empty()) {
            note_other_tangents(data, mesh);
        }
        group_by_side(mesh);
    }
    turn_normals(mesh, against_normals);
    return mesh;
}

void MeshMaker::note_other_tangents(const PrimitiveData& data, const Mesh& mesh) {
    if (!data.has("TANGENT")) {
        return;
    }
    const std::vector<float> tangents = data.read("TANGENT", 4);
    if (tangents.size() == 4 * mesh.positions.size() && has_other_tangents(mesh, tangents)) {
        notes_.approximation(
            file_.path, 0, "TANGENT differs from the texture coordinates, which normal maps follow instead");
    }
}

/// Reads COLOR_0. Its alpha counts where the material is transparent, and stands where second texture
/// coordinates would.
void MeshMaker::read_colors(const PrimitiveData& data, int material, Mesh& mesh) {
    const AttributeData colors = data.read("COLOR_0");
    const auto stride = static_cast<std::size_t>(colors.components);
    std::vector<std::array<float, 2>> alphas;
    bool has_alphas = false;
    for (std::size_t i = 0; stride >= 3 && i + stride <= colors.numbers.size(); i += stride) {
        mesh.colors.push_back({colors.numbers[i], colors.numbers[i + 1], colors.numbers[i + 2]});
        alphas.push_back({stride == 4 ? colors.numbers[i + 3] : 1.0f, 0.0f});
        has_alphas = has_alphas || alphas.back()[0] < 1.0f;
    }
    if (!has_alphas || !materials_.is_transparent(material)) {
        return;
    }
    if (materials_.texture_sets(material).second >= 0) {
        notes_.approximation(
            file_.path, 0, "the alpha of vertex colours is left out beside two sets of texture coordinates");
        return;
    }
    for (std::size_t i = 0; i < alphas.size() && materials_.shines_by_alpha(material); ++i) {
        mesh.colors[i] = mesh.colors[i] * alphas[i][0];
    }
    mesh.second_uvs = alphas;
}

void MeshMaker::move_joints(const tinygltf::Node& node, const PrimitiveData& data, Mesh& mesh) {
    if (node.skin < 0) {
        return;
    }
    if (!world_) {
        world_ = world_transforms(file_);
    }
    const tinygltf::Skin& skin = file_.at(file_.model.skins, node.skin, "skin", "a node");
    apply_skin(file_, data, joint_transforms(file_, skin, *world_), mesh);
}

/// Makes the materials of the mesh's groups where it stands: two if texture coordinates run clockwise here
/// and there. A placement that mirrors turns them round, and one that enlarges a body makes it darker.
std::vector<uint> MeshMaker::choose_materials(int material, const Mesh& mesh, bool has_tangents,
                                              const Mat4& to_world) {
    const bool mirrors = linear_determinant(to_world) < 0;
    const bool has_alphas = !mesh.second_uvs.empty() && materials_.texture_sets(material).second < 0;
    MaterialUse use{.index = material,
                    .has_colors = !mesh.colors.empty(),
                    .has_alphas = has_alphas,
                    .is_mirrored = mirrors && !mesh.groups.empty(),
                    .has_tangents = has_tangents && materials_.has_placed_normal_map(material),
                    .scale = materials_.absorbs_inside(material) ? rounded_scale(to_world) : 1.0f};
    std::vector<uint> chosen{materials_.material(use)};
    if (std::ranges::find(mesh.groups, 1u) != mesh.groups.end()) {
        use.is_mirrored = !use.is_mirrored;
        chosen.push_back(materials_.material(use));
    }
    return chosen;
}

/// Where the node's mesh stands: once for each of its instances.
std::vector<Mat4> MeshMaker::placements_of(const PlacedNode& placed, const tinygltf::Node& node) {
    constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
    const auto found = node.extensions.find(kInstancing);
    if (found == node.extensions.end() || !found->second.Has("attributes")) {
        return {placed.to_world};
    }
    const tinygltf::ExtensionMap attributes{{kInstancing, found->second.Get("attributes")}};
    const auto read = [&](const char* name, int components) {
        const int accessor = index_of(attributes, kInstancing, name, -1);
        return accessor < 0 ? std::vector<float>{} : read_numbers(file_, accessor, components);
    };
    const std::vector<float> translations = read("TRANSLATION", 3);
    const std::vector<float> rotations = read("ROTATION", 4);
    const std::vector<float> scales = read("SCALE", 3);
    const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
    if (count > kMaxInstances) {
        file_.fail("node '" + node.name + "' has " + std::to_string(count) + " instances; the maximum is " +
                   std::to_string(kMaxInstances));
    }
    std::vector<Mat4> placements;
    for (std::size_t i = 0; i < count; ++i) {
        tinygltf::Node instance;
        const auto take = [&](const std::vector<float>& numbers, std::size_t n, std::vector<double>& target) {
            if ((i + 1) * n <= numbers.size()) {
                target.assign(numbers.begin() + static_cast<std::ptrdiff_t>(i * n),
                              numbers.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
            }
        };
        take(translations, 3, instance.translation);
        take(rotations, 4, instance.rotation);
        take(scales, 3, instance.scale);
        placements.push_back(placed.to_world * transform_of(file_, instance));
    }
    return placements;
}

void MeshMaker::add_primitive(const tinygltf::Node& node, const tinygltf::Primitive& primitive,
                              const std::vector<Mat4>& placements) {
    const PrimitiveData data(file_, primitive);
    if (!makes_triangles(data.mode())) {
        notes_.approximation(file_.path, 0, "points and lines are left out");
        return;
    }
    if (!data.has("POSITION")) {
        return;
    }
    Mesh mesh = read_mesh(node, primitive, data);
    const Mat4 world;  // where joints stand
    const std::span<const Mat4> placed = node.skin >= 0 ? std::span(&world, 1) : std::span(placements);
    if (!mesh.triangles.empty() && placed.size() > kMaxSceneTriangles / mesh.triangles.size()) {
        file_.fail("node '" + node.name + "' has " + std::to_string(placed.size()) + " instances of " +
                   std::to_string(mesh.triangles.size()) + " triangles, which are too many");
    }
    const bool has_tangents = data.has("TANGENT");
    const bool emits_back = materials_.emits_back(primitive.material);
    const bool is_body = emits_back && is_closed(mesh);
    for (const Mat4& to_world : placed) {
        // Where a file gives no normals, its surfaces have flat facets [glTF 2.0, 3.7.2.1], and where a
        // transform mirrors, their front is the other side.
        const bool is_flat = mesh.normals.empty();
        const std::vector<uint> materials =
            choose_materials(primitive.material, mesh, has_tangents, to_world);
        append_mesh(scene_, mesh,
                    {.to_world = to_world,
                     .materials = materials,
                     .face_normals = is_flat,
                     .flip_normals = is_flat && linear_determinant(to_world) < 0},
                    notes_);
        if (emits_back && !is_body) {
            add_shining_back(scene_, mesh, to_world, materials_.shining_backs(materials), notes_);
        }
    }
    if (is_body) {
        bodies_.push_back({.mesh = std::move(mesh),
                           .placements = {placed.begin(), placed.end()},
                           .material = primitive.material,
                           .has_tangents = has_tangents,
                           .name = scene_.object_names.back()});
    }
}

void MeshMaker::add_seen_backs(Vec3 eye) {
    for (const ShiningBody& body : bodies_) {
        for (const Mat4& to_world : body.placements) {
            if (shows_back(body.mesh, to_world, eye)) {
                begin_object(scene_, body.name);
                add_shining_back(scene_, body.mesh, to_world,
                                 materials_.shining_backs(
                                     choose_materials(body.material, body.mesh, body.has_tangents, to_world)),
                                 notes_);
            }
        }
    }
}

void MeshMaker::add(const PlacedNode& placed) {
    const tinygltf::Node& node = file_.model.nodes[static_cast<std::size_t>(placed.index)];
    if (node.mesh < 0) {
        return;
    }
    const tinygltf::Mesh& mesh = file_.at(file_.model.meshes, node.mesh, "mesh", "node '" + node.name + "'");
    const std::vector<Mat4> placements = placements_of(placed, node);
    const std::string& name = node.name.empty() ? mesh.name : node.name;
    begin_object(scene_, name_or_number(name, "node", static_cast<std::size_t>(placed.index) + 1));
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        add_primitive(node, primitive, placements);
    }
}

}  // namespace nearlight::core::gltf
