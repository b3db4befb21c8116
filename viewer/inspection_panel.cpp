// SPDX-License-Identifier: Apache-2.0
#include <imgui.h>

#include <algorithm>
#include <vector>

#include "viewer/panels.h"
#include "viewer/vectors.h"

namespace nearlight::viewer {
namespace {

constexpr std::size_t kListed = 8;  ///< lights of each table

const char* light_name(LightKind kind) {
    switch (kind) {
        case LightKind::vpl:
            return "VPL";
        case LightKind::area:
            return "area light";
        case LightKind::point:
            return "point light";
        case LightKind::spot:
            return "spot";
        case LightKind::projector:
            return "projector";
        case LightKind::directional:
            return "directional";
        case LightKind::sun:
            return "sun";
        case LightKind::environment:
            return "environment";
    }
    return "";
}

/// The strongest shares of VPLs or of emitters, strongest first.
std::vector<LightShare> strongest(const std::vector<LightShare>& shares, bool vpls) {
    std::vector<LightShare> chosen;
    std::ranges::copy_if(shares, std::back_inserter(chosen), [&](const LightShare& share) {
        return (share.kind == LightKind::vpl) == vpls && luminance(share.irradiance) > 0.0f;
    });
    std::ranges::sort(chosen, std::greater{}, [](const LightShare& s) { return luminance(s.irradiance); });
    chosen.resize(std::min(chosen.size(), kListed));
    return chosen;
}

double part(Vec3 light, double total) {
    return total > 0.0 ? 100.0 * static_cast<double>(luminance(light)) / total : 0.0;
}

void row(const char* name, Vec3 light, double total) {
    ImGui::Text("%-22s %8.4g  %5.1f %%", name, static_cast<double>(luminance(light)), part(light, total));
}

void table(const char* title, const std::vector<LightShare>& shares, double total) {
    ImGui::Separator();
    ImGui::TextUnformatted(title);
    if (shares.empty()) {
        ImGui::TextUnformatted("  none");
        return;
    }
    ImGui::TextDisabled("%-11s %5s  %7s %7s %7s  %8s  %7s", "", "no.", "x", "y", "z", "W/m2", "share");
    for (const LightShare& share : shares) {
        ImGui::Text("%-11s %5zu  %7.2f %7.2f %7.2f  %8.3g  %5.1f %%", light_name(share.kind), share.index,
                    static_cast<double>(share.position.x), static_cast<double>(share.position.y),
                    static_cast<double>(share.position.z), static_cast<double>(luminance(share.irradiance)),
                    part(share.irradiance, total));
    }
}

}  // namespace

void draw_inspection_panel(const Inspection& inspection) {
    ImGui::SetNextWindowPos({kPanelWidth + 8.0f, 8.0f}, ImGuiCond_FirstUseEver);
    ImGui::Begin("What lights this pixel", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    if (!inspection.hits_surface) {
        ImGui::TextUnformatted("The camera sees no surface here.");
        ImGui::End();
        return;
    }
    const double total =
        static_cast<double>(luminance(inspection.direct + inspection.from_vpls + inspection.remainder));
    ImGui::Text("pixel %d, %d at %.3f %.3f %.3f", inspection.x, inspection.y,
                static_cast<double>(inspection.position.x), static_cast<double>(inspection.position.y),
                static_cast<double>(inspection.position.z));
    ImGui::TextUnformatted("luminance of the irradiance, W/m2");
    row("direct", inspection.direct, total);
    row("VPLs", inspection.from_vpls, total);
    row("remainder, by rays", inspection.remainder, total);
    row("clamped from VPLs", inspection.clamped, total);
    table("emitters", strongest(inspection.shares, false), total);
    table("VPLs", strongest(inspection.shares, true), total);
    ImGui::End();
}

}  // namespace nearlight::viewer
