// SPDX-License-Identifier: Apache-2.0
#include "viewer/window.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>

#include "nearlight/error.h"
#include "viewer/imgui_versions.h"

namespace nearlight::viewer {
namespace {

/// What GLFW says of its latest failure.
std::string reason() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text == nullptr ? "unknown reason" : text;
}

GLFWwindow* open_window(const std::string& title, int width, int height) {
    if (glfwInit() != GLFW_TRUE) {
        throw Error(ErrorKind::failure, "cannot open a window (" + reason() +
                                            "); set DISPLAY, or render to a file with `nearlight render`");
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* const window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window == nullptr) {
        const std::string why = reason();
        glfwTerminate();
        throw Error(ErrorKind::failure,
                    "cannot open a window with OpenGL 3.2 (" + why +
                        "); install a driver, or render to a file with `nearlight render`");
    }
    return window;
}

unsigned make_texture() {
    unsigned texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    return texture;
}

}  // namespace

Window::Window(const std::string& title, int width, int height) : window_(open_window(title, width, height)) {
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // no file in the folder where the program runs
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 150");
    texture_ = make_texture();
}

Window::~Window() {
    glDeleteTextures(1, &texture_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::is_closed() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::wait(double seconds) {
    if (seconds > 0.0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
}

void Window::wake() {
    glfwPostEmptyEvent();
}

void Window::begin_drawing() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::draw() {
    ImGui::Render();
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.08f, 0.08f, 0.09f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::end_drawing() {
    draw();
    glfwSwapBuffers(window_);
}

ScreenPixels Window::end_drawing_with_copy() {
    draw();
    ScreenPixels pixels;
    glfwGetFramebufferSize(window_, &pixels.width, &pixels.height);
    const auto row_bytes = static_cast<std::ptrdiff_t>(pixels.width) * 4;
    pixels.rgba.resize(static_cast<std::size_t>(row_bytes) * static_cast<std::size_t>(pixels.height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, pixels.width, pixels.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.rgba.data());
    glfwSwapBuffers(window_);
    // OpenGL has the bottom row first.
    for (int row = 0; row < pixels.height / 2; ++row) {
        const auto upper = pixels.rgba.begin() + row * row_bytes;
        std::swap_ranges(upper, upper + row_bytes, pixels.rgba.end() - (row + 1) * row_bytes);
    }
    return pixels;
}

void Window::set_picture(const ScreenPixels& pixels, bool is_smooth) {
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, is_smooth ? GL_LINEAR : GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, pixels.width, pixels.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 pixels.rgba.data());
}

ImTextureID Window::texture() const {
    return imgui_texture(texture_);
}

void Window::set_clipboard(const std::string& text) {
    glfwSetClipboardString(window_, text.c_str());
}

}  // namespace nearlight::viewer
