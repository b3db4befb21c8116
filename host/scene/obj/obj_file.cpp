// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/obj_file.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <istream>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "host/base/words.h"
#include "host/scene/crease_normals.h"
#include "host/scene/file_text.h"
#include "host/scene/obj/obj_extras.h"
#include "host/scene/obj/obj_text.h"
#include "host/scene/places.h"
#include "host/scene/polygon.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr uint kNoIndex = std::numeric_limits<uint>::max();

int line_of_face(std::string_view text, std::size_t face) {
    int found = 0;
    for_each_line(text, [&](int number, std::string_view line) {
        if (starts_with_word(line, "f") && face-- == 0) {
            found = number;
        }
        return found == 0;
    });
    return found;
}

/// Whether the file has elements that are no faces.
bool has_other_elements(std::string_view text) {
    bool found = false;
    for_each_line(text, [&](int, std::string_view line) {
        found = std::ranges::any_of(std::array{"p", "l", "curv", "curv2", "surf"},
                                    [&](const char* word) { return starts_with_word(line, word); });
        return !found;
    });
    return found;
}

/// Some of the faces of a file, counted from 0.
struct FaceRange {
    std::size_t begin = 0;
    std::size_t end = std::numeric_limits<std::size_t>::max();  ///< behind the last one
};

/// The faces of one mesh of the file, or all.
FaceRange faces_of_mesh(const ObjFile& obj, std::optional<int> mesh) {
    if (!mesh) {
        return {};
    }
    const std::vector<std::size_t> starts = mesh_starts(obj.text);
    const auto index = static_cast<std::size_t>(*mesh);
    if (index >= starts.size()) {
        throw Error(ErrorKind::file, obj.mesh.source.string() + ": has " + std::to_string(starts.size()) +
                                         " meshes, which begin at g and usemtl, and no mesh with the index " +
                                         std::to_string(*mesh));
    }
    FaceRange faces{.begin = starts[index]};
    if (index + 1 < starts.size()) {
        faces.end = starts[index + 1];
    }
    return faces;
}

// Takes tinyobjloader's callbacks and makes one vertex of each distinct (position, texture, normal) triple.
class ObjBuilder {
  public:
    /// Of other faces than the `wanted` ones nothing is kept.
    ObjBuilder(ObjFile& obj, ObjUse use, FaceRange wanted) : obj_(obj), use_(use), wanted_(wanted) {
        select_group();
        if (use == ObjUse::scene) {
            colors_ = vertex_colors(obj.text);
            smoothing_runs_ = smoothing_runs(obj.text);
        }
    }

    void add_face(const tinyobj::index_t* corners, int count) {
        if (!is_wanted()) {
            ++faces_;
            return;
        }
        if (faces_ == wanted_.begin) {
            select_group();  // the material may come from before these faces
        }
        if (count < 3) {
            ++obj_.short_faces;
            ++faces_;
            return;
        }
        if (next_object_) {
            add_object(*std::exchange(next_object_, std::nullopt));
        }
        face_.clear();
        for (const tinyobj::index_t& corner : std::span(corners, static_cast<std::size_t>(count))) {
            face_.push_back(vertex(corner));
        }
        if (use_ == ObjUse::scene && count > 3) {
            add_polygon();
        } else {
            for (std::size_t i = 2; i < face_.size(); ++i) {
                add_triangle(face_[0], face_[i - 1], face_[i]);
            }
        }
        ++faces_;
    }
    void use_material(const std::string& name) {
        material_ = name;
        if (is_wanted()) {
            select_group();
        }
    }
    /// Faces from now on belong to this object.
    void begin_object(std::string name) { next_object_ = std::move(name); }
    void finish() {
        if (!any_uv_) {
            obj_.mesh.uvs.clear();
        }
        if (!any_normal_) {
            obj_.mesh.normals.clear();
        }
        if (!any_normal_ && use_ == ObjUse::scene) {
            add_crease_normals(obj_.mesh, places_of(obj_.mesh.positions), smoothing_);
        }
    }

    std::vector<Vec3> positions, normals;
    std::vector<std::array<float, 2>> uvs;

  private:
    /// Whether the next face is one of those that are wanted.
    [[nodiscard]] bool is_wanted() const { return faces_ >= wanted_.begin && faces_ < wanted_.end; }

    /// Triangles from now on belong to the group of the current material.
    void select_group() {
        const auto [known, is_new] = groups_.try_emplace(material_, static_cast<uint>(obj_.materials.size()));
        group_ = known->second;
        if (is_new) {
            obj_.materials.push_back(material_);
        }
    }
    void add_triangle(uint a, uint b, uint c) {
        obj_.mesh.triangles.push_back({a, b, c});
        obj_.mesh.groups.push_back(group_);
        if (use_ == ObjUse::scene) {
            smoothing_.push_back(smoothing_group());
        }
    }
    void add_polygon() {
        polygon_.clear();
        for (const uint vertex : face_) {
            polygon_.push_back(obj_.mesh.positions[vertex]);
        }
        if (polygon_.size() > kMaxEarCorners && !is_convex(polygon_)) {
            ++obj_.crooked_faces;
        }
        for (const auto& [a, b, c] : triangulate(polygon_)) {
            add_triangle(face_[a], face_[b], face_[c]);
        }
    }
    /// The group of the current face: none before the first `s` line of a file that has such lines.
    uint smoothing_group() {
        while (next_run_ < smoothing_runs_.size() && smoothing_runs_[next_run_].first_face <= faces_) {
            ++next_run_;
        }
        return smoothing_runs_.empty() ? kSmoothByAngle
               : next_run_ == 0        ? kFlat
                                       : smoothing_runs_[next_run_ - 1].group;
    }

    /// Adds an object that has faces. Names come back in files that switch between objects.
    void add_object(const std::string& name) {
        Mesh& mesh = obj_.mesh;
        const auto [known, is_new] =
            object_numbers_.try_emplace(name, static_cast<uint>(mesh.object_names.size()));
        if (is_new) {
            mesh.object_names.push_back(name);
        }
        mesh.objects.push_back({static_cast<uint>(mesh.triangles.size()), known->second});
    }

    struct Corner {
        uint position, uv, normal;
        bool operator==(const Corner&) const = default;
    };
    struct CornerHash {
        std::size_t operator()(const Corner& corner) const {
            // The finaliser of SplitMix64, of numbers that seldom coincide.
            std::uint64_t bits =
                corner.position + (std::uint64_t{corner.uv} << 21) + (std::uint64_t{corner.normal} << 42);
            bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
            bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
            return static_cast<std::size_t>(bits ^ (bits >> 31));
        }
    };

    /// The place of an element among the first `count`, or kNoIndex. OBJ counts from 1, or back from the last
    /// element.
    static uint place_of(int index, std::size_t count) {
        const auto signed_count = static_cast<long long>(count);
        const long long at = index > 0 ? index - 1LL : signed_count + index;
        return index == 0 || at < 0 || at >= signed_count ? kNoIndex : static_cast<uint>(at);
    }

    uint position_of(int index) const {
        const uint place = place_of(index, positions.size());
        if (place == kNoIndex) {
            throw Error(
                ErrorKind::file,
                obj_.mesh.source.string() + ":" + std::to_string(line_of_face(obj_.text, faces_)) +
                    (index == 0
                         ? ": face refers to vertex 0 or to something that is no whole number; "
                           "vertices count from 1"
                         : ": face refers to vertex " + std::to_string(index) + ", but there are only " +
                               std::to_string(positions.size()) + " so far"));
        }
        return place;
    }

    /// The place of a normal or texture coordinate, which a corner can do without. The index 0 means that it
    /// has none.
    uint attribute_of(int index, std::size_t count) {
        const uint place = place_of(index, count);
        if (place == kNoIndex && index != 0 && obj_.first_lost_attribute == 0) {
            obj_.first_lost_attribute = line_of_face(obj_.text, faces_);
        }
        return place;
    }

    uint vertex(const tinyobj::index_t& index) {
        const uint p = position_of(index.vertex_index);
        const uint t = attribute_of(index.texcoord_index, uvs.size());
        const uint n = attribute_of(index.normal_index, normals.size());
        const auto made = static_cast<uint>(obj_.mesh.positions.size());
        const auto [known, is_new] = corners_.try_emplace({p, t, n}, made);
        if (!is_new) {
            return known->second;
        }
        obj_.mesh.positions.push_back(positions[p]);
        obj_.mesh.uvs.push_back(t == kNoIndex ? std::array<float, 2>{0, 0} : uvs[t]);
        obj_.mesh.normals.push_back(n == kNoIndex ? Vec3{0, 0, 0} : normals[n]);
        if (!colors_.empty()) {
            obj_.mesh.colors.push_back(p < colors_.size() ? colors_[p] : kNoColor);
        }
        any_uv_ = any_uv_ || t != kNoIndex;
        any_normal_ = any_normal_ || n != kNoIndex;
        return made;
    }

    ObjFile& obj_;
    ObjUse use_;
    FaceRange wanted_;
    std::string material_;      // what the last `usemtl` says
    std::vector<Vec3> colors_;  // of positions
    std::vector<SmoothingRun> smoothing_runs_;
    std::size_t next_run_ = 0;
    std::vector<uint> smoothing_;  // of triangles: groups
    std::vector<uint> face_;       // the vertices of the current face
    std::vector<Vec3> polygon_;    // and where they are
    std::unordered_map<std::string, uint> object_numbers_;
    std::optional<std::string> next_object_;                // that faces have yet to begin
    std::unordered_map<Corner, uint, CornerHash> corners_;  // their vertices
    std::unordered_map<std::string, uint> groups_;
    std::size_t faces_ = 0;
    uint group_ = 0;
    bool any_uv_ = false, any_normal_ = false;
};

tinyobj::callback_t make_callbacks() {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* user, float x, float y, float z, float) {
        static_cast<ObjBuilder*>(user)->positions.push_back({x, y, z});
    };
    callbacks.normal_cb = [](void* user, float x, float y, float z) {
        static_cast<ObjBuilder*>(user)->normals.push_back({x, y, z});
    };
    callbacks.texcoord_cb = [](void* user, float x, float y, float) {
        static_cast<ObjBuilder*>(user)->uvs.push_back({x, y});
    };
    callbacks.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
        static_cast<ObjBuilder*>(user)->add_face(corners, count);
    };
    callbacks.usemtl_cb = [](void* user, const char* name, int) {
        static_cast<ObjBuilder*>(user)->use_material(trimmed(name));
    };
    callbacks.object_cb = [](void* user, const char* name) {
        static_cast<ObjBuilder*>(user)->begin_object(trimmed(name));
    };
    callbacks.group_cb = [](void* user, const char** names, int count) {
        const std::span<const char*> all(names, static_cast<std::size_t>(count));
        static_cast<ObjBuilder*>(user)->begin_object(joined(all, " ", &trimmed));
    };
    return callbacks;
}

}  // namespace

ObjFile read_obj(const std::filesystem::path& file, ObjUse use, std::optional<int> mesh) {
    ObjFile obj;
    obj.mesh.source = file;
    obj.text = read_file_text(file);
    if (obj.text.starts_with("\xff\xfe") || obj.text.starts_with("\xfe\xff")) {
        throw Error(ErrorKind::file, file.string() + ": is UTF-16 text; save it as UTF-8");
    }
    tidy_lines(obj.text);
    for (const auto& [name, line] : lines_by_value(obj.text, "mtllib")) {
        obj.libraries.emplace(line.number, name);
    }
    obj.odd_numbers = odd_numbers(obj.text);
    obj.has_other_elements = use == ObjUse::scene && has_other_elements(obj.text);
    ObjBuilder builder(obj, use, faces_of_mesh(obj, mesh));
    TextBuffer buffer(obj.text);
    std::istream stream(&buffer);
    std::string warning;
    std::string error;
    if (!tinyobj::LoadObjWithCallback(stream, make_callbacks(), &builder, nullptr, &warning, &error)) {
        throw Error(ErrorKind::file, file.string() + ": not a valid OBJ file: " + trimmed(error));
    }
    builder.finish();
    if (obj.mesh.triangles.empty()) {
        throw Error(ErrorKind::file, file.string() + ": has no triangles");
    }
    return obj;
}

void note_what_is_left_out(const ObjFile& obj, NoteSink& notes) {
    if (obj.short_faces > 0) {
        notes.approximation(
            obj.mesh.source, 0,
            std::to_string(obj.short_faces) + " faces with fewer than three corners are left out");
    }
    if (obj.odd_numbers.lines > 0) {
        notes.approximation(obj.mesh.source, obj.odd_numbers.first_line,
                            "`v`, `vn` or `vt` without the decimal numbers that it needs, in " +
                                std::to_string(obj.odd_numbers.lines) +
                                " lines of the file; what cannot be read counts as 0");
    }
    if (obj.first_lost_attribute > 0) {
        notes.approximation(
            obj.mesh.source, obj.first_lost_attribute,
            "face refers to a normal or texture coordinate that is not there; corners do without");
    }
    if (obj.has_other_elements) {
        notes.approximation(obj.mesh.source, 0, "points, lines and free-form surfaces are left out");
    }
}

}  // namespace nearlight::core
