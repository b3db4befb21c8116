// SPDX-License-Identifier: Apache-2.0
// What differs between versions of Dear ImGui.
#pragma once

#include <imgui.h>

#include <cstdint>

namespace nearlight::viewer {

/// The key of a capital letter, for ImGui::IsKeyDown(). Before 1.87 that takes GLFW's numbers, which are the
/// letters themselves.
#if IMGUI_VERSION_NUM >= 18700
inline ImGuiKey imgui_key(char letter) {
    return static_cast<ImGuiKey>(ImGuiKey_A + (letter - 'A'));
}
#else
inline int imgui_key(char letter) {
    return letter;
}
#endif

/// A texture of OpenGL. Before 1.91.4 a texture's name is a pointer, and a number since then.
inline ImTextureID imgui_texture(unsigned texture) {
#if IMGUI_VERSION_NUM >= 19140
    return static_cast<ImTextureID>(texture);
#else
    return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
#endif
}

}  // namespace nearlight::viewer
