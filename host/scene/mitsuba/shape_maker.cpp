// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/shape_maker.h"

#include <algorithm>
#include <span>

#include "host/scene/material_model.h"
#include "host/scene/mitsuba/round_lamp.h"
#include "host/scene/mitsuba/shape_mesh.h"
#include "host/scene/mitsuba/values.h"
#include "host/scene/obj/obj_materials.h"
#include "host/scene/scene_names.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

void flip_v(Mesh& mesh) {
    for (auto& uv : mesh.uvs) {
        uv[1] = 1.0f - uv[1];
    }
}

// Places the cylinder between the points p0 and p1.
Mat4 cylinder_placement(const Object& shape) {
    const Triple p0 = shape.triple("p0", {0, 0, 0});
    const Triple p1 = shape.triple("p1", {0, 0, 1});
    const double radius = shape.number("radius", 1.0);
    const Vec3 axis{static_cast<float>(p1[0] - p0[0]), static_cast<float>(p1[1] - p0[1]),
                    static_cast<float>(p1[2] - p0[2])};
    if (is_zero(axis)) {
        fail(shape.where, "the cylinder's p0 and p1 are the same");
    }
    const auto [x, y] = orthonormal_basis(normalize(axis));
    Mat4 placement = translation(p0[0], p0[1], p0[2]);
    for (int row = 0; row < 3; ++row) {
        const auto component = [row](Vec3 v) {
            return static_cast<double>(row == 0 ? v.x : row == 1 ? v.y : v.z);
        };
        placement(row, 0) = component(x) * radius;
        placement(row, 1) = component(y) * radius;
        placement(row, 2) = component(axis);
    }
    return placement;
}

Mat4 local_placement(const Object& shape) {
    return shape.type == "sphere"     ? sphere_placement(shape)
           : shape.type == "cylinder" ? cylinder_placement(shape)
                                      : Mat4{};
}

bool is_mesh_file(const Object& shape) {
    return shape.type == "obj" || shape.type == "ply" || shape.type == "serialized";
}

// In Mitsuba a sphere is inside out if its own transform mirrors it. Normals that follow from the corners of
// a mesh are made before an instance is placed, so that an instance that mirrors leaves them on their side.
bool turns_inside_out(const Object& shape, bool has_own_normals, const Mat4& own, const Mat4& by_instance) {
    return (shape.type == "sphere" && linear_determinant(own) < 0.0) ||
           (is_mesh_file(shape) && !has_own_normals && linear_determinant(by_instance) < 0.0);
}

/// Whether anything of these materials is looked up by texture coordinates.
bool have_placed_textures(const Scene& scene, std::span<const uint> materials) {
    return std::ranges::any_of(
        materials, [&](uint index) { return has_placed_textures(scene, scene.materials[index]); });
}

}  // namespace

void ShapeMaker::add_all(const std::vector<const Object*>& shapes) {
    spheres_ = SphereDetail(shapes);
    if (spheres_.is_reduced()) {
        notes_.remark(scene_.source, 0,
                      "spheres have fewer than " + std::to_string(sphere_triangle_count(kFinestStacks)) +
                          " facets each, because there are so many");
    }
    reader_ = MeshReader(shapes);
    for (const Object* shape : shapes) {
        add(*shape, 0);
    }
}

void ShapeMaker::add(const Object& shape, uint depth) {
    if (shape.type == "shapegroup") {
        return;
    }
    if (shape.type == "instance") {
        add_instance(shape);
        return;
    }
    if (shape.type == "merge") {
        if (depth == kMaxMergeDepth) {
            fail(shape.where, "merges lie too deep in one another, or one contains itself");
        }
        for (const Object* part : shape.nested("shape")) {
            add(*part, depth + 1);
        }
        shape.report_unused(notes_);
        return;
    }
    add_placed(shape, load(shape), own_placement(shape), Mat4{});
}

void ShapeMaker::add_instance(const Object& instance) {
    const std::vector<const Object*> groups = instance.nested("shape");
    if (groups.size() != 1 || groups[0]->type != "shapegroup") {
        fail(instance.where, "'instance' needs a reference to a shapegroup");
    }
    const Mat4 to_world = instance.transform("to_world");
    const std::string name = name_of(instance, ++shape_count_);
    for (const Object* shape : groups[0]->nested("shape")) {
        if (shape->type == "shapegroup" || shape->type == "instance") {
            fail(shape->where, "a shapegroup may contain only plain shapes");
        }
        auto found = group_meshes_.find(shape);
        if (found == group_meshes_.end()) {
            found = group_meshes_.emplace(shape, load(*shape)).first;
        }
        add_placed(*shape, found->second, own_placement(*shape), to_world, name + "/");
    }
    instance.report_unused(notes_);
}

/// Places the mesh of a shape, apart from an instance of it. An instance may stretch a sphere, but its own
/// transform does not.
Mat4 ShapeMaker::own_placement(const Object& shape) {
    const Mat4 placement = shape.transform("to_world") * local_placement(shape);
    if (shape.type != "sphere" || linear_determinant(placement) == 0.0 || is_round_sphere(placement)) {
        return placement;
    }
    note(notes_, shape.where, "the to_world of a sphere stretches it; it stays a sphere, as in Mitsuba");
    return rounded_sphere(placement);
}

std::string ShapeMaker::name_of(const Object& shape, std::size_t number) const {
    const Property* file = shape.find("filename");
    const bool has_file = file != nullptr && std::holds_alternative<std::string>(file->value);
    return name_or_number(
        shape.id,
        has_file ? std::filesystem::path(std::get<std::string>(file->value)).stem().string() : shape.type,
        number);
}

uint ShapeMaker::medium_boundary() {
    if (!medium_boundary_) {
        scene_.materials.push_back(plain_material(NEARLIGHT_BSDF_NULL));
        medium_boundary_ = static_cast<uint>(scene_.materials.size() - 1);
    }
    return *medium_boundary_;
}

uint ShapeMaker::material_of(const Object& shape, const Parameter& emitted) {
    const std::vector<const Object*> bsdfs = shape.nested("bsdf");
    if (bsdfs.size() > 1) {
        const std::string what = "a shape has one BSDF, but this one has " + std::to_string(bsdfs.size());
        if (!shape.is_old) {
            fail(shape.where, what);
        }
        note(notes_, shape.where, what + "; the last one counts, as in Mitsuba 0.5 and 0.6");
    }
    // In Mitsuba 0.5 and 0.6, a medium alone has no surface.
    if (bsdfs.empty() && shape.is_old && !shape.nested("medium").empty() && is_zero(emitted.value)) {
        return medium_boundary();
    }
    return materials_.index(bsdfs.empty() ? nullptr : bsdfs.back(), emitted);
}

std::vector<uint> ShapeMaker::materials_by_name(const Object& shape, const ObjFile& file) {
    const std::vector<const Child*> bsdfs = shape.children_of("bsdf");
    const bool uses_libraries = shape.boolean("load_materials", true) && !file.libraries.empty() &&
                                shape.nested("emitter").empty() && shape.nested("medium").empty();
    const bool has_one_for_all =
        std::ranges::any_of(bsdfs, [](const Child* bsdf) { return bsdf->name.empty(); });
    if (has_one_for_all || (bsdfs.empty() && !uses_libraries)) {
        return {};
    }
    const Parameter emitted = emission(shape);
    std::vector<uint> materials(file.materials.size());
    if (uses_libraries) {
        materials = add_obj_materials(scene_, file, notes_);
    } else {
        std::ranges::fill(materials, materials_.index(nullptr, emitted));
    }
    for (const Child* bsdf : bsdfs) {
        const auto is_its = [&](const std::string& name) { return snake_case(name) == bsdf->name; };
        const auto found = std::ranges::find_if(file.materials, is_its);
        if (found == file.materials.end()) {
            note(notes_, bsdf->where,
                 (shape.has("shape_index") ? "this mesh of the OBJ file" : "the OBJ file") +
                     std::string(" has no material '") + bsdf->name + "'");
        } else {
            materials[static_cast<std::size_t>(found - file.materials.begin())] =
                materials_.index(bsdf->object, emitted);
        }
    }
    return materials;
}

void ShapeMaker::add_placed(const Object& shape, const LoadedMesh& loaded, const Mat4& own,
                            const Mat4& by_instance, const std::string& instance) {
    if (!shape.nested("subsurface").empty()) {
        fail(shape.where, "subsurface scattering is not supported");
    }
    for (const Object* medium : shape.nested("medium")) {
        note(notes_, medium->where, kMediaAreLeftOut);
    }
    const Parameter emitted = emission(shape);
    const Mesh& mesh = loaded.mesh;
    const std::vector<uint> materials =
        loaded.materials.empty() ? std::vector{material_of(shape, emitted)} : loaded.materials;
    const Mat4 to_world = by_instance * own;
    // The faces of the other shapes are flat or round whatever the file says. Mitsuba 3 does not look at what
    // files of meshes say of theirs.
    const bool face_normals =
        is_mesh_file(shape) ? shape.boolean("face_normals", shape.is_old && mesh.face_normals) : false;
    const bool has_own_normals = !mesh.normals.empty() && !face_normals;
    const bool flips =
        shape.boolean("flip_normals", false) != turns_inside_out(shape, has_own_normals, own, by_instance);
    const std::size_t first_triangle = scene_.triangles.size();
    begin_object(scene_, instance + name_of(shape, instance.empty() ? ++shape_count_ : shape_count_));
    append_mesh(
        scene_, mesh,
        {.to_world = to_world,
         .materials = materials,
         .face_normals = face_normals,
         .flip_normals = flips,
         .corner_uvs = mesh.uvs.empty() && is_mesh_file(shape) && have_placed_textures(scene_, materials)},
        notes_);
    const bool is_even = emitted.texture < 0 && !is_zero(emitted.value);
    const bool is_whole = scene_.triangles.size() - first_triangle == mesh.triangles.size();
    if (is_even && is_whole && !flips) {
        if (const std::optional<RoundLamp> lamp = round_lamp(scene_, shape.type, to_world, first_triangle)) {
            scene_.round_lamps.push_back(*lamp);
        }
    }
    shape.ignore({"collapse", "load_materials"});
    if (shape.type == "cube" || shape.type == "rectangle") {
        shape.ignore({"face_normals"});
    }
    shape.report_unused(notes_);
}

ShapeMaker::LoadedMesh ShapeMaker::load(const Object& shape) {
    const std::string& type = shape.type;
    if (is_mesh_file(shape)) {
        return load_file(shape);
    }
    if (type == "rectangle") {
        return {rectangle_mesh(), {}};
    }
    if (type == "cube") {
        return {cube_mesh(), {}};
    }
    if (type == "sphere") {
        return {sphere_mesh(spheres_.stacks(shape)), {}};
    }
    if (type == "disk") {
        return {disk_mesh(), {}};
    }
    if (type == "cylinder") {
        return {cylinder_mesh(), {}};
    }
    fail_unknown_type(
        shape, "obj, ply, serialized, rectangle, cube, sphere, disk, cylinder, shapegroup, instance, merge");
}

MeshFile ShapeMaker::read_file(const Object& shape) {
    std::future<MeshFile> file = reader_.read(shape);
    try {
        return file.get();
    } catch (const Error& error) {
        throw Error(error.kind(), to_string(Note{*shape.where.file, shape.where.line, error.what()}),
                    error.setting());
    }
}

// A file's v counts from the bottom of the texture in OBJ and from the top in the others, unless the scene
// says otherwise.
ShapeMaker::LoadedMesh ShapeMaker::load_file(const Object& shape) {
    MeshFile file = read_file(shape);
    note_what_is_left_out(file, notes_);
    LoadedMesh loaded;
    if (shape.is_old && shape.type == "obj") {
        loaded.materials = materials_by_name(shape, file);
    }
    loaded.mesh = std::move(file.mesh);
    if (loaded.materials.empty()) {
        loaded.mesh.groups.clear();
    }
    loaded.mesh.objects.clear();
    loaded.mesh.object_names.clear();
    if (!shape.boolean("flip_tex_coords", shape.type == "obj")) {
        flip_v(loaded.mesh);
    }
    return loaded;
}

Parameter ShapeMaker::emission(const Object& shape) {
    const std::vector<const Object*> emitters = shape.nested("emitter");
    if (emitters.empty()) {
        return parameter_of(0.0f);
    }
    if (emitters.size() > 1) {
        fail(emitters[1]->where, "a shape has only one emitter");
    }
    const Object& emitter = *emitters.front();
    if (emitter.type != "area") {
        fail_unknown_type(emitter, "area (within a shape)");
    }
    emitter.is_on_shape = true;
    emitter.ignore({"sampling_weight"});
    const Parameter radiance = textures_.emission(emitter, "radiance", {1, 1, 1});
    if (radiance.value.x < 0.0f || radiance.value.y < 0.0f || radiance.value.z < 0.0f) {
        fail(emitter.where, "'radiance' should not be negative");
    }
    emitter.report_unused(notes_);
    return radiance;
}

}  // namespace nearlight::core::mitsuba
