// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/obj_images.h"

#include "host/scene/file_text.h"

namespace nearlight::core {

std::vector<ImageSource> images_of(const std::vector<std::string>& names,
                                   const std::vector<const MaterialLibrary*>& owners) {
    std::vector<ImageSource> images;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (owners[i] == nullptr) {
            continue;
        }
        const tinyobj::material_t& entry = owners[i]->entry(names[i]);
        for (const std::string* texture :
             {&entry.diffuse_texname, &entry.bump_texname, &entry.normal_texname, &entry.alpha_texname}) {
            if (!texture->empty()) {
                images.push_back({.file = find_moved_file(owners[i]->file, *texture)});
            }
        }
    }
    return images;
}

}  // namespace nearlight::core
