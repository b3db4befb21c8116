// SPDX-License-Identifier: Apache-2.0
// Reads image files into the scene: textures and environments.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "host/image/image.h"
#include "host/scene/note_sink.h"
#include "host/scene/scene.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// Reads each file once, however many materials use it.
class TextureLoader {
  public:
    TextureLoader(Scene& scene, NoteSink& notes) : scene_(scene), notes_(notes) {}

    /// The index into Scene::images, or −1 with a note at file:line if the image cannot be read. `linear`
    /// says that the file's numbers are reflectances rather than sRGB-encoded; those of float files always
    /// are.
    int load(const std::filesystem::path& image, bool linear, const std::filesystem::path& file, int line);

    /// Adds an image that has no file of its own, and returns its index. `linear` means what it does in
    /// load().
    int add(const Image& image, const std::string& name, bool linear);

  private:
    Scene& scene_;
    NoteSink& notes_;
    std::map<std::pair<std::filesystem::path, bool>, int> loaded_;
};

/// Throws the error on unless it is that of a broken file, which a note reports. Any other cause (a missing
/// image module, memory) would make a wrong picture of every scene.
void throw_unless_file(const Error& error);
/// A bitmap texture of an image in Scene::images, without a placement of its own: s = u, t = v.
SceneTexture plain_texture(int image);
/// The mean of an image's linear colours.
Vec3 mean_color(const TextureImage& image);
/// Reads linear RGB radiance and multiplies it by `scale`; there is no rotation. Throws
/// Error(ErrorKind::file).
EnvironmentLight load_environment(const std::filesystem::path& image, float scale);

}  // namespace nearlight::core
