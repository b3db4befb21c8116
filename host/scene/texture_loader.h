// SPDX-License-Identifier: Apache-2.0
// Reads image files into the scene: textures and environments.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "host/scene/image_reader.h"
#include "host/scene/note_sink.h"
#include "host/scene/scene.h"
#include "host/scene/texel_reader.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// What becomes of textures whose images cannot be read.
inline constexpr std::string_view kReplacedByGrey = "replaced by mid-grey";
inline constexpr std::string_view kLeftOut = "left out";

/// Reads each file once for each rule, however many materials use it. Images of 8 bits a channel stay what
/// they are, others become half floats. Numbers that are not finite count as 0, and negative colours too;
/// halves end at ±65504. A note says so once for each file.
class TextureLoader {
  public:
    TextureLoader(Scene& scene, NoteSink& notes) : scene_(scene), notes_(notes) {}

    /// Images that will probably be loaded, in about this order (ImageReader::expect).
    void expect(std::vector<ImageSource> images) { reader_.expect(std::move(images)); }

    /// Whether the image can be read; one that can is not read again if it is loaded next. Throws Error that
    /// is not of the kind file.
    bool can_read(const ImageSource& image);

    /// The index into Scene::images, or −1 with a note at file:line if the image cannot be read, which says
    /// that the texture `becomes` that.
    int load(const ImageSource& image, const TexelRule& rule, const std::filesystem::path& file, int line,
             std::string_view becomes = kReplacedByGrey);

    /// Adds an image that has no file of its own, and returns its index.
    int add(const Image& image, const std::string& name, const TexelRule& rule,
            const std::filesystem::path& file, int line);

  private:
    using Key = std::tuple<std::filesystem::path, const std::byte*, TexelRule>;

    Scene& scene_;
    NoteSink& notes_;
    ImageReader reader_;
    std::map<Key, int> loaded_;
};

/// Notes at file:line that a texture `becomes` something because `error` kept its image from being read.
/// Throws the error on unless it is that of a broken file: any other cause (a missing image module, memory)
/// would make a wrong picture of every scene.
void note_unreadable_texture(const Error& error, const std::filesystem::path& file, int line, NoteSink& notes,
                             std::string_view becomes = kReplacedByGrey);
/// A bitmap texture of an image in Scene::images, without a placement of its own: s = u, t = v.
SceneTexture plain_texture(int image);
/// A texture of the vertices' own colours.
SceneTexture vertex_color_texture();
/// Adds a texture to the scene and returns its index.
int add_texture(Scene& scene, const SceneTexture& texture);
/// Reads RGB radiance and multiplies it by `scale`; there is no rotation. The radiance is the number of the
/// file to the power of `gamma`; 0: sRGB-encoded in files of integers, else linear. Pixels that are negative
/// or not finite are black in that channel, and `bad_pixels` counts them. Throws Error(ErrorKind::file).
EnvironmentLight load_environment(const std::filesystem::path& image, float scale, float gamma,
                                  std::size_t& bad_pixels);

}  // namespace nearlight::core
