// SPDX-License-Identifier: Apache-2.0
#include "viewer/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>

#include "viewer/command_text.h"
#include "viewer/pass_settings.h"

namespace nearlight::viewer {
namespace {

constexpr std::array kSamplers{SamplerKind::close_range,   SamplerKind::instant_radiosity,
                               SamplerKind::rejection,     SamplerKind::metropolis,
                               SamplerKind::bidirectional, SamplerKind::local};
constexpr std::array kToneCurves{ToneCurve::linear, ToneCurve::neutral, ToneCurve::agx, ToneCurve::filmic};
constexpr std::array kPolicies{Policy::complete, Policy::partition, Policy::paper};

void tooltip(const char* text) {
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", text);
    }
}

bool slider(const char* label, std::uint32_t& value, int min, int max, const char* help) {
    int number = static_cast<int>(value);
    const bool is_changed = ImGui::SliderInt(label, &number, min, max, "%d",
                                             ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    tooltip(help);
    if (is_changed) {
        value = static_cast<std::uint32_t>(number);
    }
    return is_changed;
}

/// A slider that can be left to the program. `current` is what the program has chosen.
bool optional_slider(const char* label, std::optional<float>& value, float current, float min, float max,
                     const char* help) {
    ImGui::PushID(label);
    bool is_auto = !value;
    bool is_changed = ImGui::Checkbox("auto", &is_auto);
    if (is_changed) {
        value = is_auto ? std::nullopt : std::optional(std::max(current, min));
    }
    ImGui::SameLine();
    float number = value.value_or(current);
    ImGui::SetNextItemWidth(120.0f);
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | (min > 0.0f ? ImGuiSliderFlags_Logarithmic : 0);
    if (ImGui::SliderFloat(label, &number, min, max, value ? "%.3f" : "(%.3f)", flags)) {
        value = number;
        is_changed = true;
    }
    tooltip(help);
    ImGui::PopID();
    return is_changed;
}

template <typename Choice, std::size_t kCount>
bool combo(const char* label, Choice& value, const std::array<Choice, kCount>& choices) {
    bool is_changed = false;
    if (ImGui::BeginCombo(label, name_of(value))) {
        for (const Choice choice : choices) {
            if (ImGui::Selectable(name_of(choice), choice == value) && choice != value) {
                value = choice;
                is_changed = true;
            }
        }
        ImGui::EndCombo();
    }
    return is_changed;
}

/// The share of the frame's VPLs that lie in the close range.
float close_share(const Frame* frame) {
    return frame != nullptr && frame->vpls->size() > 0
               ? static_cast<float>(frame->vpls->close_count()) / static_cast<float>(frame->vpls->size())
               : 0.5f;
}

void draw_progress(const ViewerState& state, const PanelFacts& facts) {
    if (facts.frame == nullptr) {
        ImGui::TextUnformatted(facts.has_scene ? "getting ready: tree, kernels ..."
                                               : "loading the scene ...");
        return;
    }
    const Frame& frame = *facts.frame;
    ImGui::Text("%dx%d%s, %u of %u samples%s", frame.image.width, frame.image.height,
                frame.divisor > 1 ? " (moving)"
                : frame.smoothed  ? " (smoothed)"
                                  : "",
                frame.samples, state.settings.gather.samples_per_pixel,
                facts.is_done     ? ", done"
                : state.is_paused ? ", paused"
                                  : "");
    ImGui::Text("%.0f ms a pass, %zu VPLs (%zu close)", 1000.0 * frame.seconds, frame.vpls->size(),
                frame.vpls->close_count());
    if (!facts.error.empty()) {
        ImGui::TextWrapped("error: %s", facts.error.c_str());
    }
}

void draw_light_settings(ViewerState& state, const PanelFacts& facts, Changes& changes) {
    RenderSettings& settings = state.settings;
    const std::optional<View> view = facts.frame != nullptr ? facts.frame->view : std::nullopt;
    const float range = view ? view->range() : 1.0f;
    changes.sampling |= combo("sampler", settings.sampling.sampler, kSamplers);
    if (settings.sampling.sampler == SamplerKind::close_range) {
        changes.sampling |= combo("policy", settings.sampling.policy, kPolicies);
        changes.sampling |=
            optional_slider("close fraction", settings.sampling.close_fraction, close_share(facts.frame),
                            0.0f, 1.0f, "share of the VPLs that lie in the close range");
    }
    changes.sampling |=
        slider("VPLs", settings.sampling.vpl_count, 1, 100'000, "VPLs that a pixel asks in all");
    changes.samples |= slider("samples", settings.gather.samples_per_pixel, 1, 4096,
                              "samples of a pixel, which are as many passes");
    std::uint32_t direct = settings.gather.direct_samples_per_pixel.value_or(kDefaultDirectSamples);
    if (slider("light samples", direct, 1, 4096, "shadow rays of a pixel towards lamps and the sky")) {
        settings.gather.direct_samples_per_pixel = direct;
        changes.sampling = true;
    }
    changes.sampling |=
        slider("rays", settings.gather.rays_per_pixel, 1, 4096, "rays of a pixel for the remainder");
    changes.sampling |= ImGui::Checkbox("compensate", &settings.gather.compensate);
    tooltip("rays bring back what the clamp radius takes away, and reflections");
    changes.sampling |= optional_slider("range", settings.view.range, range, 0.01f, 100.0f,
                                        "distance at which the close range ends, m");
    changes.sampling |=
        optional_slider("clamp radius", settings.view.clamp_radius, view ? view->clamp_radius() : 0.05f,
                        1e-4f, 10.0f, "VPLs nearer than this count as if they were at this distance, m");
}

void draw_display_settings(ViewerState& state, Changes& changes) {
    const std::span<const ShownLayer> layers = shown_layers();
    if (ImGui::BeginCombo("layer", layers[state.display.layer].name)) {
        for (std::size_t i = 0; i < layers.size(); ++i) {
            if (ImGui::Selectable(layers[i].name, i == state.display.layer)) {
                state.display.layer = i;
                changes.display = true;
            }
            tooltip(layers[i].what);
        }
        ImGui::EndCombo();
    }
    changes.automatic_exposure = ImGui::Button("auto");
    tooltip("the exposure at which this picture looks right");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(146.0f);
    changes.display |= ImGui::SliderFloat("exposure", &state.display.exposure, -10.0f, 10.0f, "%.2f EV");
    changes.display |= combo("tone curve", state.display.curve, kToneCurves);
    changes.display |= ImGui::Checkbox("show the close range", &state.display.show_close_range);
    ImGui::Checkbox("VPLs", &state.shows_vpls);
    tooltip("orange: close VPLs, blue: distant ones");
    ImGui::SameLine();
    ImGui::Checkbox("hidden ones too", &state.shows_hidden_vpls);
}

void draw_camera(ViewerState& state, Changes& changes) {
    const FreeCamera& camera = state.camera;
    ImGui::Text("at %.3f %.3f %.3f", static_cast<double>(camera.origin.x),
                static_cast<double>(camera.origin.y), static_cast<double>(camera.origin.z));
    if (camera.fov_degrees > 0.0) {
        auto degrees = static_cast<float>(camera.fov_degrees);
        if (ImGui::SliderFloat("field of view", &degrees, 5.0f, 150.0f, "%.1f deg",
                               ImGuiSliderFlags_AlwaysClamp)) {
            state.camera.fov_degrees = static_cast<double>(degrees);
            changes.camera = true;
        }
    }
    ImGui::SliderFloat("speed", &state.walking_speed, 0.01f, 100.0f, "%.2f m/s",
                       ImGuiSliderFlags_Logarithmic);
    if (ImGui::Button("return")) {
        state.camera = state.first_camera;
        changes.camera = true;
    }
    tooltip("back to the camera at the start");
    ImGui::SameLine();
    if (ImGui::Button(state.is_paused ? "go on" : "pause")) {
        state.is_paused = !state.is_paused;
        changes.pause = true;
    }
}

void draw_saving(ViewerState& state, Changes& changes) {
    ImGui::InputText("file", state.save_name.data(), state.save_name.size());
    tooltip("a name that ends in .exr (all layers) or .png");
    changes.save = ImGui::Button("save");
    ImGui::SameLine();
    changes.copy_command = ImGui::Button("copy command line");
    tooltip("`nearlight render` with this camera and these settings, to the clipboard");
    if (!state.message.empty()) {
        ImGui::TextWrapped("%s", state.message.c_str());
    }
}

}  // namespace

Changes draw_settings_panel(ViewerState& state, const PanelFacts& facts) {
    Changes changes;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({kPanelWidth, ImGui::GetIO().DisplaySize.y});
    ImGui::Begin("nearlight", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
    ImGui::PushItemWidth(190.0f);
    draw_progress(state, facts);
    if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen)) {
        draw_display_settings(state, changes);
    }
    if (ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen)) {
        draw_light_settings(state, facts, changes);
    }
    if (ImGui::CollapsingHeader("Camera", ImGuiTreeNodeFlags_DefaultOpen)) {
        draw_camera(state, changes);
    }
    if (ImGui::CollapsingHeader("Save", ImGuiTreeNodeFlags_DefaultOpen)) {
        draw_saving(state, changes);
    }
    ImGui::TextDisabled(
        "left drag: orbit; right: look; middle: pan\nwheel: nearer; W A S D Q E: walk, Shift: fast\nclick: "
        "what lights the pixel");
    ImGui::PopItemWidth();
    ImGui::End();
    return changes;
}

}  // namespace nearlight::viewer
