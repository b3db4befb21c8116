// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/mtl_textures.h"

#include <string_view>

#include "host/scene/file_text.h"

namespace nearlight::core {
namespace {

SceneTexture placed_texture(int image, const tinyobj::texture_option_t& options) {
    SceneTexture texture = plain_texture(image);
    texture.parameters.u_scale = options.scale[0];
    texture.parameters.v_scale = options.scale[1];
    texture.parameters.u_offset = options.origin_offset[0];
    texture.parameters.v_offset = options.origin_offset[1];
    if (options.clamp) {
        texture.parameters.wrap_s = texture.parameters.wrap_t = NEARLIGHT_WRAP_CLAMP;
    }
    return texture;
}

}  // namespace

int MtlTextures::load(const MaterialLibrary& library, TextLine begin, const TextureSource& texture,
                      TexelRule rule) {
    if (texture.name.empty()) {
        return -1;
    }
    const tinyobj::texture_option_t& options = texture.options;
    if (const std::size_t channel = std::string_view("rgb").find(options.imfchan);
        rule.is_number && channel != std::string_view::npos) {
        rule.channel = static_cast<int>(channel);
        rule.prefers_alpha = false;
    }
    const int found = find_in_block(library.text, begin, "newmtl", texture.keyword, texture.name);
    const int line = found > 0 ? found : begin.number;
    // Only colours of reflected light become grey; elsewhere what stands beside the texture counts alone.
    const std::string_view keyword = texture.keyword;
    const bool becomes_grey =
        keyword == "map_Kd" ||
        (keyword == "map_Ks" && find_in_block(library.text, begin, "newmtl", "Ks", "") == 0);
    const int image = images_.load({.file = find_moved_file(library.file, texture.name)}, rule, library.file,
                                   line, becomes_grey ? kReplacedByGrey : kLeftOut);
    if (image < 0) {
        return -1;
    }
    if (options.contrast != 1.0f || options.brightness != 0.0f || options.turbulence[0] != 0.0f ||
        options.turbulence[1] != 0.0f) {
        notes_.approximation(library.file, line, "-mm and -t of textures are left out");
    }
    return add_texture(scene_, placed_texture(image, options));
}

}  // namespace nearlight::core
