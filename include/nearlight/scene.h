// SPDX-License-Identifier: Apache-2.0
// A scene, read from a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
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

/// Where the sun stands.
struct SunPosition {
    double azimuth = 0.0;    ///< degrees from +Z towards +X
    double elevation = 0.0;  ///< degrees above the horizon, 0 to 90
};

/// How to load a scene. What says something about camera and light replaces what the file says, whatever its
/// format; +Y is up.
struct LoadOptions {
    /// Values for `$NAME` in a Mitsuba scene, by name. A name that the scene does not have is an error, and
    /// so is any name for a scene of another format.
    std::map<std::string, std::string> definitions{};
    /// If it is true, load() throws an Error instead of approximating something and noting that.
    bool strict = false;
    /// If it is true, light passes straight through smooth glass bodies, which is not what glass does: a
    /// picture for architects (`--glass clear`).
    bool clear_glass = false;
    /// The camera to take: its name in the file, or its number counted from 1; empty: the first one. Any
    /// other name or number is an error.
    std::string camera{};
    std::optional<Vec3> origin{};  ///< where the camera stands
    /// What the camera looks at; if only the origin is given, that is the middle of the scene.
    std::optional<Vec3> target{};
    /// What points upwards in the picture; empty: the axis of the world that does so as the camera stands.
    std::optional<Vec3> up{};
    /// Horizontal, degrees, above 0 and below 180. With it an orthographic camera becomes a perspective one.
    std::optional<double> fov_x_degrees{};
    /// An image file (latitude-longitude), `sky` (a clear sky), or a colour: R,G,B or one number as a
    /// radiance, or #rrggbb. Empty: the scene's own environment.
    std::string environment{};
    /// Degrees about +Y by which the environment turns, and a factor of its light, 0 or more. They count for
    /// its sun as well, but not for a `sun` that is added to another environment than `sky`.
    double environment_rotation = 0.0;
    double environment_scale = 1.0;
    std::optional<SunPosition> sun{};  ///< a sun, whose place the environment `sky` follows
    double light_scale = 1.0;          ///< of all light, 0 or more
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
    /// Reads a file by its extension: .xml (Mitsuba 0.5 to 3), .gltf and .glb (glTF 2.0), .obj or .ply; names
    /// of other files in it are relative to its folder. Throws Error: ErrorKind::file if a file is missing,
    /// is broken or has unknown content, or if `options.strict` forbids an approximation;
    /// ErrorKind::invalid_argument for a camera or a definition that is not there, or a number out of its
    /// range; ErrorKind::failure if the library's image module, which reads textures, is missing. A texture
    /// file that cannot be read is replaced by grey, with a note. Notes also go to the message sink
    /// (message.h).
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
    /// Whether the file leaves open how bright its pictures are to be: those of models look right with
    /// automatic_exposure() and ToneCurve::neutral.
    [[nodiscard]] bool has_open_exposure() const;
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
