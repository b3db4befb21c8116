// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_scene.h"

#include <algorithm>
#include <utility>

#include "host/scene/crease_normals.h"
#include "host/scene/file_text.h"
#include "host/scene/material_model.h"
#include "host/scene/mesh.h"
#include "host/scene/model_scene.h"
#include "host/scene/note_sink.h"
#include "host/scene/places.h"
#include "host/scene/ply_loader.h"
#include "host/scene/texture_loader.h"
#include "host/scene/vertex_colors.h"

namespace nearlight::core {
namespace {

/// Makes the materials of a PLY file's surface, of which each has a texture or none.
class PlyMaterials {
  public:
    PlyMaterials(Scene& scene, const PlyModel& model, NoteSink& notes)
        : scene_(scene), model_(model), notes_(notes), loader_(scene, notes) {}

    /// Those of Mesh::groups. A group without a triangle has some material that nothing looks up.
    std::vector<uint> make() {
        note_what_has_no_place();
        std::vector<bool> is_used(model_.textures.size() + 1, false);
        is_used[0] = model_.mesh.groups.empty();
        for (const uint group : model_.mesh.groups) {
            is_used[group] = true;
        }
        expect(is_used);
        std::vector<uint> materials(is_used.size(), 0);
        for (std::size_t group = 0; group < is_used.size(); ++group) {
            if (is_used[group]) {
                materials[group] =
                    group == 0 ? add_plain_surface(scene_, has_colors()) : add_textured(group - 1);
            }
        }
        return materials;
    }

  private:
    [[nodiscard]] bool has_colors() const {
        return !model_.mesh.colors.empty() || !model_.mesh.face_colors.empty();
    }
    [[nodiscard]] std::string colors() const {
        return model_.mesh.colors.empty() ? "colours of faces" : "colours of vertices";
    }
    [[nodiscard]] ImageSource image_of(std::size_t texture) const {
        return {.file = find_moved_file(scene_.source, model_.textures[texture])};
    }

    void note_what_has_no_place() {
        if (model_.has_colors_of_both) {
            notes_.remark(scene_.source, 0,
                          "the file has colours of vertices and of faces; those of vertices are used");
        }
        if (model_.textures.empty()) {
            return;
        }
        const std::string name = "texture '" + model_.textures[0] + "'";
        if (model_.mesh.groups.empty()) {
            notes_.approximation(
                scene_.source, 0,
                "the " + name + " is left out, because the file has no texture coordinates; export them");
        } else if (model_.textures.size() > 1 && !model_.are_textures_numbered) {
            notes_.approximation(
                scene_.source, 0,
                "the file names " + std::to_string(model_.textures.size()) +
                    " textures, but its faces do not say which one they have; all have the " + name);
        }
    }

    void expect(const std::vector<bool>& is_used) {
        std::vector<ImageSource> images;
        for (std::size_t texture = 0; texture < model_.textures.size(); ++texture) {
            if (is_used[texture + 1]) {
                images.push_back(image_of(texture));
            }
        }
        loader_.expect(std::move(images));
    }

    /// The surface of a texture, or of the mesh's colours if the image cannot be read and there are some.
    uint add_textured(std::size_t texture) {
        const ImageSource image = image_of(texture);
        if (has_colors() && !loader_.can_read(image)) {
            notes_.approximation(scene_.source, 0,
                                 "the texture '" + image.file.string() + "' cannot be read; the " + colors() +
                                     " are used in its place");
            return add_plain_surface(scene_, true);
        }
        Material surface = diffuse_material({0.5f, 0.5f, 0.5f});
        if (const int index = loader_.load(image, {}, scene_.source, 0); index >= 0) {
            surface.reflectance = textured(add_texture(scene_, plain_texture(index)));
            if (has_colors()) {
                notes_.remark(
                    scene_.source, 0,
                    "the file has a texture and " + colors() + "; surfaces with the texture have no other");
            }
        }
        return add_two_sided(scene_, surface);
    }

    Scene& scene_;
    const PlyModel& model_;
    NoteSink& notes_;
    TextureLoader loader_;
};

}  // namespace

Scene load_ply_scene(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene = begin_model(file);
    NoteSink notes(scene.notes, options.strict);
    PlyModel model = read_ply_model(file);
    Mesh& mesh = model.mesh;
    check_mesh(mesh);
    decode_display_colors(mesh.colors);
    decode_display_colors(mesh.face_colors);
    if (mesh.normals.empty()) {
        add_crease_normals(mesh, places_of(mesh.positions),
                           std::vector<uint>(mesh.triangles.size(), kSmoothByAngle));
    }
    const std::vector<uint> materials = PlyMaterials(scene, model, notes).make();
    append_mesh(scene, mesh, {.to_world = {}, .materials = materials}, notes);
    finish_model(scene, options, notes);
    return scene;
}

}  // namespace nearlight::core
