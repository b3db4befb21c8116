// SPDX-License-Identifier: Apache-2.0
// Loads single materials of Mitsuba files.
#pragma once

#include <gtest/gtest.h>

#include "host/image/image_io.h"
#include "host/scene/texture.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core::test {

class MitsubaMaterial : public testing::Test {
  protected:
    /// The material of a rectangle with this BSDF, which stands on the second line of the file.
    Material load(const std::string& bsdf) {
        scene_ = files_.load_xml(shape("rectangle", bsdf));
        return scene_.materials.at(scene_.triangles.at(0).material);
    }
    Material load(const std::string& type, const std::string& body) {
        return load("<bsdf type='" + type + "'>" + body + "</bsdf>");
    }
    [[nodiscard]] const Material& child(const Material& material, std::size_t index = 0) const {
        return scene_.materials.at(material.child[index]);
    }
    [[nodiscard]] Vec3 value(const Parameter& parameter, float u = 0.25f, float v = 0.5f) const {
        return parameter_value(scene_, parameter, u, v);
    }
    /// How many notes name the file and the line of the BSDF.
    [[nodiscard]] std::size_t notes_on_line_2(const std::string& part) const {
        std::size_t count = 0;
        for (const Note& note : scene_.notes) {
            count += mentions(to_string(note), "scene.xml:2: ") && mentions(note.text, part) ? 1 : 0;
        }
        return count;
    }
    /// Writes an image of two grey texels.
    void write_pair(const std::string& name, float left, float right) const {
        write_image(files_.path(name), {2, 1, {"R", "G", "B"}, {left, left, left, right, right, right}});
    }

    SceneFiles files_;
    Scene scene_;
};

inline std::string number(const std::string& name, const std::string& value) {
    return "<float name='" + name + "' value='" + value + "'/>";
}
inline std::string text(const std::string& name, const std::string& value) {
    return "<string name='" + name + "' value='" + value + "'/>";
}
inline std::string rgb(const std::string& name, const std::string& value) {
    return "<rgb name='" + name + "' value='" + value + "'/>";
}
inline std::string bitmap(const std::string& name, const std::string& file, const std::string& body = "") {
    return "<texture type='bitmap' name='" + name + "'>" + text("filename", file) + body + "</texture>";
}

}  // namespace nearlight::core::test
