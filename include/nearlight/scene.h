// SPDX-License-Identifier: Apache-2.0
// A scene, read from a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "nearlight/export.h"
#include "nearlight/vec3.h"

namespace nearlight {

/// An axis-aligned box in metres of world space.
struct Box {
    Vec3 min;
    Vec3 max;
};

/// How to read a scene.
struct LoadOptions {
    /// Values for `$NAME` in a Mitsuba scene, by name; for glTF, `camera` names the camera to take. Names
    /// that the scene does not use are ignored.
    std::map<std::string, std::string> definitions{};
    /// If true, load() throws an Error where it would otherwise approximate something and note it.
    bool strict = false;
};

/// Something about a scene that its reader should know: what was approximated, or what is odd.
struct SceneNote {
    std::filesystem::path file;
    int line = 0;  ///< the first line is 1; 0 where the line is not known
    std::string text;
};

/// A scene that does not change. Copies are cheap and share the data, which lives as long as the last of
/// them, a Session of the scene included. All functions may be called from several threads at once. A Scene
/// that was moved from can only be assigned to and destroyed.
class NEARLIGHT_API Scene {
  public:
    /// Reads a file by its extension: .xml (Mitsuba 0.5 to 3), .gltf and .glb (glTF 2.0) or .obj; the files
    /// that it names are found beside it. Throws Error: ErrorKind::file where a file is missing, broken or
    /// holds something unknown, or where `options.strict` forbids an approximation; ErrorKind::failure where
    /// the library's image module, which reads textures, is missing. A texture file that cannot be read is
    /// replaced by grey, with a note. Notes also go to the message sink (message.h).
    static Scene load(const std::filesystem::path& file, const LoadOptions& options = {});

    /// The name of the scene's folder, or of its file.
    [[nodiscard]] const std::string& name() const;
    /// The file that load() was given.
    [[nodiscard]] const std::filesystem::path& source() const;
    /// How many triangles there are after shapes of all kinds were turned into triangles.
    [[nodiscard]] std::size_t triangle_count() const;
    /// The box around the vertices of all triangles. If there are none, min is above max.
    [[nodiscard]] Box bounds() const;
    /// The size of the camera's picture in pixels.
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    /// A hash of everything that shapes the picture: equal scenes have equal hashes, on any machine. It is
    /// computed anew in each call, in time proportional to the size of the scene.
    [[nodiscard]] std::uint64_t hash() const;
    /// What load() noted, in order, each thing once.
    [[nodiscard]] std::vector<SceneNote> notes() const;

  private:
    friend class Session;
    struct State;
    explicit Scene(std::shared_ptr<const State> state);
    std::shared_ptr<const State> state_;
};

}  // namespace nearlight
