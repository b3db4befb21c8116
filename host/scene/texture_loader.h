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

    /// Index into Scene::images, or -1 with a note at file:line where the image cannot be read. `linear`: the
    /// file's numbers are reflectances rather than sRGB-encoded; files of floats always are.
    int load(const std::filesystem::path& image, bool linear, const std::filesystem::path& file, int line);

    /// The same of an image that has no file of its own; its index.
    int add(const Image& image, const std::string& name, bool linear);

  private:
    Scene& scene_;
    NoteSink& notes_;
    std::map<std::pair<std::filesystem::path, bool>, int> loaded_;
};

/// A texture's file may be broken; whatever else kept it from being read (a missing image module, memory)
/// would make a wrong picture of any scene, and is thrown on.
void throw_unless_file(const Error& error);
/// A bitmap texture without any placement of its own: s = u, t = v.
SceneTexture plain_texture(int image);
/// Linear mean colour.
Vec3 mean_color(const TextureImage& image);
/// Linear RGB radiance times `scale`, identity rotation. Throws Error(ErrorKind::file).
EnvironmentLight load_environment(const std::filesystem::path& image, float scale);

}  // namespace nearlight::core
