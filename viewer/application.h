// SPDX-License-Identifier: Apache-2.0
// Joins the window, the renderer and what the user has set.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viewer/controls.h"
#include "viewer/panels.h"
#include "viewer/renderer.h"
#include "viewer/state.h"
#include "viewer/tev_sender.h"
#include "viewer/viewer.h"
#include "viewer/vpl_dots.h"
#include "viewer/window.h"

namespace nearlight::viewer {

class Application {
  public:
    /// Begins to load the scene. Keeps references to both arguments.
    Application(const ViewerTask& task, Window& window);

    /// How long the window may wait for input, in seconds.
    [[nodiscard]] double patience() const;
    /// Draws one frame of the window, after the input since the frame before. Rethrows what kept the scene
    /// from being rendered.
    void draw();
    /// Whether the picture has the samples after which the task ends.
    [[nodiscard]] bool has_ended() const { return has_ended_; }

  private:
    /// Where the picture lies in the window, in pixels.
    struct Place {
        float x = 0.0f;
        float y = 0.0f;
        float width = 1.0f;
        float height = 1.0f;
    };

    void take_scene();
    void choose_look(const Scene& scene);
    void take_frame();
    void take_input();
    void turn_about_the_middle();
    void watch_tev();
    void draw_picture();
    void draw_dots(const Place& place);
    void draw_inspection(const Inspection& inspection, const Place& place) const;
    void apply(const Changes& changes);
    void save();
    void inspect_at(float x, float y);
    void refresh_picture();
    void end_if_wanted();
    [[nodiscard]] Place place_of_picture() const;
    [[nodiscard]] Input input_in(const Place& place) const;
    [[nodiscard]] RenderSettings settings() const;
    [[nodiscard]] WriteOptions look() const;
    [[nodiscard]] std::string command() const;

    const ViewerTask& task_;
    Window& window_;
    std::unique_ptr<TevSender> tev_;  ///< null: nothing is sent
    ViewerState state_;
    bool has_scene_ = false;
    bool is_walking_ = false;
    bool has_ended_ = false;
    bool has_asked_ = false;  ///< for the inspection that the task wants
    int drawings_left_ = 2;   ///< until the screenshot, so that panels have found their sizes
    std::shared_ptr<const Frame> frame_;
    std::optional<std::vector<VplDot>> dots_;  ///< of the frame; empty until they are shown
    Renderer renderer_;                        ///< declared last, because it calls the window until it ends
};

/// The size of the window's picture while the scene's is unknown.
inline constexpr int kDefaultWidth = 640;
inline constexpr int kDefaultHeight = 480;

}  // namespace nearlight::viewer
