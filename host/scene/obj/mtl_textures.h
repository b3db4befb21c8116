// SPDX-License-Identifier: Apache-2.0
// The textures that entries of material libraries name.
#pragma once

#include <tiny_obj_loader.h>

#include <string>
#include <utility>
#include <vector>

#include "host/scene/note_sink.h"
#include "host/scene/obj/mtl_file.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core {

/// A texture of an entry: the file's name, its options, and the word before them.
struct TextureSource {
    const std::string& name;
    const tinyobj::texture_option_t& options;
    const char* keyword;
};

class MtlTextures {
  public:
    MtlTextures(Scene& scene, NoteSink& notes) : scene_(scene), notes_(notes), images_(scene, notes) {}

    /// Images that textures will probably show.
    void expect(std::vector<ImageSource> images) { images_.expect(std::move(images)); }

    /// The index of the texture, which the entry that begins at `begin` names. −1 if it names none, or if the
    /// image cannot be read, which a note tells.
    int load(const MaterialLibrary& library, TextLine begin, const TextureSource& texture, TexelRule rule);

  private:
    Scene& scene_;
    NoteSink& notes_;
    TextureLoader images_;
};

}  // namespace nearlight::core
