// SPDX-License-Identifier: Apache-2.0
// Small scene files for tests, in a folder that is removed with them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "host/scene/scene_loader.h"
#include "nearlight/error.h"

namespace nearlight::core::test {

class SceneFiles {
  public:
    SceneFiles() {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("nearlight-" + std::string(info->name()) + "-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~SceneFiles() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    SceneFiles(const SceneFiles&) = delete;
    SceneFiles& operator=(const SceneFiles&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        const std::filesystem::path file = folder_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }
    /// `body` begins on the second line of scene.xml.
    Scene load_xml(const std::string& body, const LoadOptions& options = {}) const {
        return load_scene(write("scene.xml", "<scene version='3.0.0'>\n" + body + "\n</scene>\n"), options);
    }
    [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  private:
    std::filesystem::path folder_;
};

/// Runs `load`, which must throw Error(ErrorKind::file), and returns the message.
template <typename Load>
std::string file_error(Load load) {
    try {
        load();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::file);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

inline bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline bool has_note(const Scene& scene, const std::string& part) {
    for (const Note& note : scene.notes) {
        if (mentions(to_string(note), part)) {
            return true;
        }
    }
    return false;
}

inline void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

}  // namespace nearlight::core::test
