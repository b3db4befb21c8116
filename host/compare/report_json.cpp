// SPDX-License-Identifier: Apache-2.0
#include "host/compare/report_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "host/base/hash.h"

namespace nearlight::core {
namespace {

using Json = nlohmann::ordered_json;

Json policy_of(const Method& method) {
    return method.policy ? Json(to_string(*method.policy)) : Json(nullptr);
}

Json to_json(const Reference& reference) {
    const ReferenceNoise& noise = reference.noise;
    return {{"method", reference.method},
            {"samples", reference.samples},
            {"noise", noise.known ? Json(std::sqrt(noise.mean_variance)) : Json(nullptr)},
            {"file", reference.file.empty() ? Json(nullptr) : Json(reference.file)},
            {"seconds", reference.seconds},
            {"display_scale", reference.display_scale}};
}

Json to_json(const EqualVplsRow& row) {
    return {{"sampler", to_string(row.method.sampler)},
            {"policy", policy_of(row.method)},
            {"vpls", row.vpls},
            {"gathered_vpls", row.gathered_vpls},
            {"sparse_vpls", row.sparse_vpls},
            {"rmse", row.rmse.value},
            {"rmse_ci95", row.rmse.half_width},
            {"rmse_low", row.rmse.low},
            {"rmse_high", row.rmse.high},
            {"rmse_ratio", row.rmse_ratio},
            {"relative_mse", row.relative_mse.mean},
            {"relative_mse_ci95", row.relative_mse.half_width},
            {"mean_ratio", row.mean_ratio.mean},
            {"mean_ratio_ci95", row.mean_ratio.half_width},
            {"flip", row.flip.mean},
            {"flip_ci95", row.flip.half_width},
            {"generate_s", row.generate_seconds},
            {"gather_s", row.gather_seconds}};
}

Json to_json(const EqualRmse& group, const CompareSettings& settings) {
    Json rows = Json::array();
    for (const EqualRmseRow& row : group.rows) {
        const Method& method = settings.methods[row.curve];
        rows.push_back({{"sampler", to_string(method.sampler)},
                        {"policy", policy_of(method)},
                        {"vpls", row.vpls},
                        {"seconds", row.seconds},
                        {"vpls_ratio", row.vpls_ratio},
                        {"time_ratio", row.time_ratio},
                        {"reach", to_string(row.reach)}});
    }
    return {{"rmse", group.rmse}, {"rows", rows}};
}

Json to_json(const SceneComparison& scene, const CompareSettings& settings) {
    Json equal_vpls = Json::array();
    for (const EqualVplsRow& row : scene.equal_vpls) {
        equal_vpls.push_back(to_json(row));
    }
    Json groups = Json::array();
    for (const EqualRmse& group : scene.equal_rmse) {
        groups.push_back(to_json(group, settings));
    }
    return {{"name", scene.facts.name},
            {"source", scene.facts.source},
            {"scene_hash", hex_digits(scene.facts.hash)},
            {"triangles", scene.facts.triangles},
            {"range", scene.facts.range},
            {"clamp_radius", scene.facts.clamp_radius},
            {"max_depth", scene.facts.max_depth},
            {"setup_s", {{"build_bvh", scene.facts.setup.build_bvh}, {"compile", scene.facts.setup.compile}}},
            {"reference", to_json(scene.reference)},
            {"equal_vpls", equal_vpls},
            {"equal_rmse", groups}};
}

}  // namespace

std::string comparison_json(const Comparison& comparison, const CompareSettings& settings) {
    Json scenes = Json::array();
    for (const SceneComparison& scene : comparison.scenes) {
        scenes.push_back(to_json(scene, settings));
    }
    const Json json{{"scenes", scenes},
                    {"baseline", to_string(settings.baseline)},
                    {"width", settings.width},
                    {"height", settings.height},
                    {"samples_per_pixel", settings.samples_per_pixel},
                    {"seeds", settings.seed_count},
                    {"first_seed", settings.first_seed},
                    {"device", {comparison.device}},
                    {"driver", comparison.driver},
                    {"version", settings.program_version},
                    {"bvh", to_string(settings.bvh_quality)},
                    {"cells", {{"measured", comparison.measured_cells}, {"reused", comparison.reused_cells}}},
                    {"report", (settings.output / "report.html").string()}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace nearlight::core
