// SPDX-License-Identifier: Apache-2.0
// The window: GLFW for the window itself, OpenGL to show a texture, and Dear ImGui for what is drawn over it.
#pragma once

#include <imgui.h>

#include <string>

#include "viewer/display.h"

struct GLFWwindow;

namespace nearlight::viewer {

/// The only window. All functions but wake() are for the thread that made it.
class Window {
  public:
    /// Opens a window. Throws Error(ErrorKind::failure) if there is no display or no OpenGL.
    Window(const std::string& title, int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] bool is_closed() const;
    /// Waits for input or wake(), but not longer than so many seconds.
    void wait(double seconds);
    /// Ends the wait of the window's thread. For any thread, as long as the window lives.
    static void wake();

    /// Between these two, Dear ImGui takes what is to be drawn.
    void begin_drawing();
    void end_drawing();
    /// Ends drawing too, and returns what the window then shows.
    ScreenPixels end_drawing_with_copy();

    /// Replaces the picture, which texture() is then. If it is to be shown larger, a smooth picture has no
    /// visible pixels.
    void set_picture(const ScreenPixels& pixels, bool is_smooth);
    [[nodiscard]] ImTextureID texture() const;
    void set_clipboard(const std::string& text);

  private:
    void draw();

    GLFWwindow* window_ = nullptr;
    unsigned texture_ = 0;
};

}  // namespace nearlight::viewer
