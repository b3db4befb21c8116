// SPDX-License-Identifier: Apache-2.0
#include "viewer/application.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "nearlight/error.h"
#include "viewer/channels.h"
#include "viewer/command_text.h"
#include "viewer/imgui_versions.h"
#include "viewer/screenshot.h"
#include "viewer/task_scene.h"
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

int direction(char letter_plus, char letter_minus) {
    return (ImGui::IsKeyDown(imgui_key(letter_plus)) ? 1 : 0) -
           (ImGui::IsKeyDown(imgui_key(letter_minus)) ? 1 : 0);
}

/// Throws if the pixel that is to be inspected lies outside of the picture.
void check_inspected(const std::optional<Pixel>& pixel, int width, int height) {
    if (pixel && (pixel->x < 0 || pixel->x >= width || pixel->y < 0 || pixel->y >= height)) {
        const auto text = [](int a, const char* between, int b) {
            return std::to_string(a) + between + std::to_string(b);
        };
        throw Error(ErrorKind::invalid_argument, "there is no pixel " + text(pixel->x, ",", pixel->y) +
                                                     " to inspect in a picture of " +
                                                     text(width, "x", height) + " pixels");
    }
}

}  // namespace

Application::Application(const ViewerTask& task, Window& window)
    : task_(task),
      window_(window),
      tev_(task.tev.empty() ? nullptr
                            : std::make_unique<TevSender>(task.tev, task.scene.filename().string())),
      renderer_(
          Devices::choose(task.device, task.device_options), [&task] { return load_scene(task); },
          task.settings, [] { Window::wake(); }) {
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
    } else if (task_.load.fov_x_degrees) {
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
    check_inspected(task_.inspect, *state_.settings.view.width, *state_.settings.view.height);
}

void Application::take_frame() {
    std::shared_ptr<const Frame> frame = renderer_.frame();
    if (!frame || frame == frame_) {
        return;
    }
    frame_ = std::move(frame);
    if (state_.has_automatic_exposure) {
        state_.display.exposure = automatic_exposure(frame_->shown());
        state_.has_automatic_exposure = frame_->divisor > 1;
    }
    refresh_picture();
    dots_.reset();
    // Small pictures would replace whole ones in tev by pictures of another size.
    if (tev_ && frame_->divisor == 1) {
        tev_->send(with_file_layers(frame_->image));
    }
}

void Application::watch_tev() {
    if (tev_ && !tev_->error().empty()) {
        state_.message = tev_->error();
        tev_.reset();
    }
}

void Application::refresh_picture() {
    if (frame_) {
        window_.set_picture(to_screen(frame_->shown(), state_.display), frame_->divisor > 1);
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

void Application::draw_dots(const Place& place) {
    if (!dots_) {
        dots_ = vpl_dots(*frame_);
    }
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const VplDot& dot : *dots_) {
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
        draw_inspection(*inspection, place);
    }
}

/// Draws the panel, and a ring around the place in the picture that it is about.
void Application::draw_inspection(const Inspection& inspection, const Place& place) const {
    draw_inspection_panel(inspection);
    if (!inspection.hits_surface || !frame_->view) {
        return;
    }
    if (const auto seen = frame_->view->place_of(inspection.position)) {
        const float scale_x = place.width / static_cast<float>(frame_->image.width);
        const float scale_y = place.height / static_cast<float>(frame_->image.height);
        ImGui::GetBackgroundDrawList()->AddCircle({place.x + static_cast<float>(seen->x) * scale_x,
                                                   place.y + static_cast<float>(seen->y) * scale_y},
                                                  7.0f, IM_COL32(255, 60, 200, 255), 16, 2.0f);
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
        state_.display.exposure = automatic_exposure(frame_->shown());
    }
    if (changes.display || changes.automatic_exposure) {
        refresh_picture();
    }
    if (changes.copy_command) {
        window_.set_clipboard(command());
        std::fprintf(stderr, "%s\n", command().c_str());
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
        write_image(name, with_file_layers(frame_->image), look());
        write_text(name + ".txt", command() + "\n");
        state_.message = "wrote " + name + (frame_->smoothed ? " (not smoothed, of few samples)" : "") +
                         " and " + name + ".txt with its command line";
    } catch (const Error& error) {
        state_.message = error.what();
    }
}

void Application::end_if_wanted() {
    if (task_.until_samples == 0) {
        return;
    }
    renderer_.rethrow_error();
    if (!frame_ || frame_->samples == 0 || (frame_->samples < task_.until_samples && !renderer_.is_done())) {
        return;
    }
    if (task_.inspect && !std::exchange(has_asked_, true)) {
        renderer_.inspect(frame_, task_.inspect->x, task_.inspect->y);
    }
    if (!task_.inspect || renderer_.inspection()) {
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
    watch_tev();
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
