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
#include "nearlight/settings.h"
#include "nearlight/vec3.h"

namespace nearlight {

/// An axis-aligned box in metres of world space.
struct Box {
    Vec3 min;
    Vec3 max;
};

/// How to load a scene.
struct LoadOptions {
    /// Values for `$NAME` in a Mitsuba scene, by name; for glTF, `camera` names the camera to take. Names
    /// that the scene does not use are ignored.
    std::map<std::string, std::string> definitions{};
    /// If it is true, load() throws an Error instead of approximating something and noting that.
    bool strict = false;
    /// If it is true, light passes straight through smooth glass bodies, which is not what glass does: a
    /// picture for architects (`--glass clear`).
    bool clear_glass = false;
};

/// A note about a scene that was loaded: what was approximated, or what is odd about the file.
struct SceneNote {
    std::filesystem::path file;
    int line = 0;  ///< counted from 1; 0 if the line is not known
    std::string text;
};

/// A scene, which does not change. Copies are cheap and share the data, which lives until the last copy and
/// the last Session of the scene are gone. All functions may be called from several threads at once. A Scene
/// that was moved from can only be assigned to and destroyed.
class NEARLIGHT_API Scene {
  public:
    /// Reads a file by its extension: .xml (Mitsuba 0.5 to 3), .gltf and .glb (glTF 2.0) or .obj; names of
    /// other files in it are relative to its folder. Throws Error: ErrorKind::file if a file is missing, is
    /// broken or has unknown content, or if `options.strict` forbids an approximation; ErrorKind::failure if
    /// the library's image module, which reads textures, is missing. A texture file that cannot be read is
    /// replaced by grey, with a note. Notes also go to the message sink (message.h).
    static Scene load(const std::filesystem::path& file, const LoadOptions& options = {});

    /// The name of the scene's folder, or of its file.
    [[nodiscard]] const std::string& name() const;
    /// The file that load() was given.
    [[nodiscard]] const std::filesystem::path& source() const;
    /// The number of triangles. Shapes of other kinds are turned into triangles when the scene is loaded.
    [[nodiscard]] std::size_t triangle_count() const;
    /// The box around the vertices of all triangles. If there are no triangles, min is above max.
    [[nodiscard]] Box bounds() const;
    /// The size of the camera's picture in pixels.
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    /// Where the camera stands; its target is 1 m in front of it. There is no field of view if the camera is
    /// orthographic.
    [[nodiscard]] CameraPose camera() const;
    /// A hash of everything that shapes the picture: equal scenes have equal hashes, on any machine. Each
    /// call computes it again, in time proportional to the size of the scene.
    [[nodiscard]] std::uint64_t hash() const;
    /// The notes of load(), in order and without repeats.
    [[nodiscard]] std::vector<SceneNote> notes() const;

  private:
    friend class Session;
    struct State;
    explicit Scene(std::shared_ptr<const State> state);
    std::shared_ptr<const State> state_;
};

}  // namespace nearlight
