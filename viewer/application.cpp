// SPDX-License-Identifier: Apache-2.0
#include "viewer/application.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "nearlight/error.h"
#include "viewer/command_text.h"
#include "viewer/screenshot.h"
#include "viewer/vectors.h"

namespace nearlight::viewer {
namespace {

/// While nothing moves the window looks at signals this often, in seconds.
constexpr double kRestingPatience = 0.25;
constexpr double kWalkingPatience = 0.01;
/// A press and release within so many pixels is a click, not a drag.
constexpr float kClickDistance = 3.0f;

constexpr ImU32 kCloseColor = IM_COL32(255, 150, 30, 230);
constexpr ImU32 kDistantColor = IM_COL32(70, 160, 255, 230);
constexpr ImU32 kHiddenAlpha = 0x50FFFFFF;

int direction(int letter_plus, int letter_minus) {
    return (ImGui::IsKeyDown(letter_plus) ? 1 : 0) - (ImGui::IsKeyDown(letter_minus) ? 1 : 0);
}

/// The number after "X," in "X,Y".
std::pair<int, int> pixel_of(const std::string& text) {
    std::pair<int, int> pixel{-1, -1};
    char end = 0;
    if (std::sscanf(text.c_str(), "%d,%d%c", &pixel.first, &pixel.second, &end) != 2) {
        throw Error(ErrorKind::invalid_argument, "'" + text + "' is no pixel; give X,Y");
    }
    return pixel;
}

}  // namespace

Application::Application(const ViewerTask& task, Window& window)
    : task_(task),
      window_(window),
      tev_(task.tev.empty() ? std::nullopt : std::optional<TevLink>(task.tev)),
      renderer_(
          Devices::choose(task.device, task.device_options),
          [&task] { return Scene::load(task.scene, task.load); }, task.settings, [] { Window::wake(); }) {
    state_.settings = task.settings;
    state_.display.layer = task.layer;
    state_.shows_vpls = task.shows_vpls;
}

double Application::patience() const {
    return is_walking_ ? kWalkingPatience : kRestingPatience;
}

RenderSettings Application::settings() const {
    RenderSettings settings = state_.settings;
    // Until it is moved, the camera is the scene's to the bit, which may be tilted.
    if (!shows_same(state_.camera, state_.first_camera)) {
        settings.view.camera = pose_of(state_.camera);
        if (state_.camera.fov_degrees == state_.first_camera.fov_degrees) {
            settings.view.camera->fov_x_degrees.reset();
        }
    }
    return settings;
}

std::string Application::command() const {
    RenderSettings shown = settings();
    std::vector<std::string> arguments = task_.scene_arguments;
    if (!shown.view.camera) {
        arguments.insert(arguments.end(), task_.camera_arguments.begin(), task_.camera_arguments.end());
    } else if (task_.load.field_of_view) {
        shown.view.camera->fov_x_degrees = state_.camera.fov_degrees;
    }
    return command_text(arguments, shown, look(), state_.save_name.data());
}

WriteOptions Application::look() const {
    return {.exposure = state_.display.exposure, .tone_curve = state_.display.curve};
}

/// Scenes that say how bright their light is are shown as they are, others by their first whole picture.
void Application::choose_look(const Scene& scene) {
    const bool is_open = scene.has_open_exposure();
    state_.display.curve = task_.curve.value_or(is_open ? ToneCurve::neutral : ToneCurve::linear);
    state_.display.exposure = task_.exposure.value_or(0.0f);
    state_.has_automatic_exposure = task_.has_automatic_exposure || (is_open && !task_.exposure);
}

void Application::take_scene() {
    const std::optional<Scene> scene = has_scene_ ? std::nullopt : renderer_.scene();
    if (!scene) {
        return;
    }
    has_scene_ = true;
    const Box bounds = scene->bounds();
    state_.camera = free_camera(scene->camera(), bounds);
    state_.first_camera = state_.camera;
    choose_look(*scene);
    state_.walking_speed = walking_speed(bounds);
    state_.settings.view.width = task_.settings.view.width.value_or(scene->width());
    state_.settings.view.height = task_.settings.view.height.value_or(scene->height());
}

void Application::take_frame() {
    std::shared_ptr<const Frame> frame = renderer_.frame();
    if (!frame || frame == frame_) {
        return;
    }
    frame_ = std::move(frame);
    if (state_.has_automatic_exposure) {
        state_.display.exposure = automatic_exposure(frame_->image);
        state_.has_automatic_exposure = frame_->divisor > 1;
    }
    refresh_picture();
    if (!frame_->is_quick || frame_->divisor == 1) {
        dots_ = vpl_dots(*frame_);
    }
    send_to_tev();
}

/// Sends whole pictures, because small ones would replace them by pictures of another size.
void Application::send_to_tev() {
    if (!tev_ || frame_->divisor > 1) {
        return;
    }
    try {
        tev_->show(task_.scene.filename().string(), frame_->image);
    } catch (const Error& error) {
        state_.message = error.what();
        tev_.reset();
    }
}

void Application::refresh_picture() {
    if (frame_) {
        window_.set_picture(to_screen(frame_->image, state_.display), frame_->divisor > 1);
    }
}

Application::Place Application::place_of_picture() const {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float room = std::max(size.x - kPanelWidth, 1.0f);
    const auto width = static_cast<float>(state_.settings.view.width.value_or(kDefaultWidth));
    const auto height = static_cast<float>(state_.settings.view.height.value_or(kDefaultHeight));
    const float scale = std::min(room / width, size.y / height);
    return {.x = kPanelWidth + 0.5f * (room - scale * width),
            .y = 0.5f * (size.y - scale * height),
            .width = scale * width,
            .height = scale * height};
}

Input Application::input_in(const Place& place) const {
    const ImGuiIO& io = ImGui::GetIO();
    Input input{.seconds = io.DeltaTime};
    if (!io.WantCaptureMouse) {
        const bool pans = ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
                          (ImGui::IsMouseDown(ImGuiMouseButton_Left) && io.KeyShift);
        const bool is_drag = ImGui::IsMouseDragging(ImGuiMouseButton_Left, kClickDistance);
        input.drag = pans                                         ? Input::Drag::pan
                     : ImGui::IsMouseDown(ImGuiMouseButton_Right) ? Input::Drag::look
                     : is_drag                                    ? Input::Drag::orbit
                                                                  : Input::Drag::none;
        if (input.drag != Input::Drag::none) {
            input.drag_x = io.MouseDelta.x / place.width;
            input.drag_y = io.MouseDelta.y / place.width;
        }
        input.wheel = io.MouseWheel;
    }
    if (!io.WantTextInput) {
        input.right = direction('D', 'A');
        input.upwards = direction('E', 'Q');
        input.ahead = direction('W', 'S');
        input.hurries = io.KeyShift;
    }
    return input;
}

/// When a drag begins, the pivot goes to the surface in the middle of the picture.
void Application::turn_about_the_middle() {
    if (!frame_ || !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        return;
    }
    const float depth = depth_in_the_middle(frame_->image);
    if (depth > 0.0f && std::isfinite(depth)) {
        state_.camera = with_pivot(state_.camera, depth);
    }
}

void Application::take_input() {
    if (!has_scene_) {
        return;
    }
    const Place place = place_of_picture();
    const Input input = input_in(place);
    is_walking_ = is_walking(input);
    turn_about_the_middle();
    const FreeCamera camera = moved(state_.camera, input, state_.walking_speed);
    if (!shows_same(camera, state_.camera)) {
        state_.camera = camera;
        renderer_.show(settings(), Change::camera);
    }
    const ImGuiIO& io = ImGui::GetIO();
    const bool is_click = ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !io.WantCaptureMouse &&
                          io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClickDistance * kClickDistance;
    if (is_click) {
        inspect_at((io.MousePos.x - place.x) / place.width, (io.MousePos.y - place.y) / place.height);
    }
}

void Application::inspect_at(float x, float y) {
    if (frame_ && x >= 0.0f && x < 1.0f && y >= 0.0f && y < 1.0f) {
        renderer_.inspect(frame_, static_cast<int>(x * static_cast<float>(frame_->image.width)),
                          static_cast<int>(y * static_cast<float>(frame_->image.height)));
    }
}

void Application::draw_dots(const Place& place) const {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const VplDot& dot : dots_) {
        if (dot.is_hidden && !state_.shows_hidden_vpls) {
            continue;
        }
        const ImVec2 at{place.x + dot.x * place.width, place.y + dot.y * place.height};
        const ImU32 color =
            (dot.is_close ? kCloseColor : kDistantColor) & (dot.is_hidden ? kHiddenAlpha : ~0u);
        const float radius = 1.5f + 4.0f * dot.brightness;
        list.AddCircleFilled(at, radius, color, 8);
        list.AddCircle(at, radius, IM_COL32(0, 0, 0, 160), 8);
    }
}

void Application::draw_picture() {
    if (!frame_) {
        return;
    }
    const Place place = place_of_picture();
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddImage(window_.texture(), {place.x, place.y}, {place.x + place.width, place.y + place.height});
    if (state_.shows_vpls && frame_->divisor == 1) {
        draw_dots(place);
    }
    if (const auto inspection = renderer_.inspection()) {
        draw_inspection_panel(*inspection);
        if (inspection->hits_surface && frame_->view) {
            if (const auto seen = frame_->view->place_of(inspection->position)) {
                list.AddCircle({place.x + static_cast<float>(seen->x) /
                                              static_cast<float>(frame_->image.width) * place.width,
                                place.y + static_cast<float>(seen->y) /
                                              static_cast<float>(frame_->image.height) * place.height},
                               7.0f, IM_COL32(255, 60, 200, 255), 16, 2.0f);
            }
        }
    }
}

void Application::apply(const Changes& changes) {
    if (changes.sampling) {
        renderer_.show(settings(), Change::sampling);
    } else if (changes.camera) {
        renderer_.show(settings(), Change::camera);
    }
    if (changes.samples) {
        renderer_.set_samples(state_.settings.gather.samples_per_pixel);
    }
    if (changes.pause) {
        renderer_.pause(state_.is_paused);
    }
    if (changes.automatic_exposure && frame_) {
        state_.display.exposure = automatic_exposure(frame_->image);
    }
    if (changes.display || changes.automatic_exposure) {
        refresh_picture();
    }
    if (changes.copy_command) {
        window_.set_clipboard(command());
        std::printf("%s\n", command().c_str());
        std::fflush(stdout);
        state_.message = "copied, and printed to the terminal";
    }
    if (changes.save) {
        save();
    }
}

void Application::save() {
    if (!frame_) {
        return;
    }
    const std::string name = state_.save_name.data();
    try {
        write_image(name, frame_->image, look());
        write_text(name + ".txt", command() + "\n");
        state_.message = "wrote " + name + (frame_->is_smoothed ? " (smoothed, of few samples)" : "") +
                         " and " + name + ".txt with its command line";
    } catch (const Error& error) {
        state_.message = error.what();
    }
}

void Application::end_if_wanted() {
    if (task_.frames == 0) {
        return;
    }
    if (const std::string error = renderer_.error(); !error.empty()) {
        throw Error(ErrorKind::failure, error);
    }
    const bool has_enough = frame_ && !frame_->is_quick && frame_->samples >= task_.frames;
    if (!has_enough && !(frame_ && renderer_.is_done())) {
        return;
    }
    if (!task_.inspect.empty() && !std::exchange(has_asked_, true)) {
        const auto [x, y] = pixel_of(task_.inspect);
        renderer_.inspect(frame_, std::clamp(x, 0, frame_->image.width - 1),
                          std::clamp(y, 0, frame_->image.height - 1));
    }
    if (task_.inspect.empty() || renderer_.inspection()) {
        --drawings_left_;
        has_ended_ = drawings_left_ <= 0;
        Window::wake();
    }
}

void Application::draw() {
    renderer_.rethrow_failure();
    take_scene();
    window_.begin_drawing();
    take_input();
    take_frame();
    draw_picture();
    apply(draw_settings_panel(state_, {.frame = frame_.get(),
                                       .has_scene = has_scene_,
                                       .is_done = renderer_.is_done(),
                                       .error = renderer_.error()}));
    end_if_wanted();
    if (has_ended_ && !task_.screenshot.empty()) {
        write_screenshot(task_.screenshot, window_.end_drawing_with_copy());
    } else {
        window_.end_drawing();
    }
}

}  // namespace nearlight::viewer
