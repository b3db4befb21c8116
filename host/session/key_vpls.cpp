// SPDX-License-Identifier: Apache-2.0
#include "host/session/key_vpls.h"

#include <algorithm>
#include <utility>

#include "host/base/stopwatch.h"

namespace nearlight::core {
namespace {

/// The maximum number of VPLs in all sets that are kept. Sets beyond it are made again for each picture,
/// which takes time but no memory.
constexpr std::size_t kMaxKeptVpls = std::size_t{1} << 22u;

}  // namespace

JoinedVpls join_on_host(std::span<const VplPart> parts) {
    JoinedVpls all;
    bool have_budgets = true;
    RayBudget budget{.clamp_radius = 0.0f, .direct_samples_per_pixel = 0};
    for (const auto& [part, weight] : parts) {
        std::vector<Vpl> vpls = part->vpls.download();
        for (Vpl& vpl : vpls) {
            vpl.power *= weight;
        }
        all.vpls.insert(all.vpls.end(), vpls.begin(), vpls.end());
        all.set.close_count += part->close_count;
        all.set.distant_count += part->distant_count;
        all.set.sparse_count += part->sparse_count;
        all.set.candidate_count += part->candidate_count;
        all.set.asked_count = std::max(all.set.asked_count, part->asked_count);
        all.set.close_fraction += weight * part->close_fraction;
        have_budgets = have_budgets && part->ray_budget.has_value();
        const RayBudget own = part->ray_budget.value_or(RayBudget{});
        budget.clamp_radius += weight * own.clamp_radius;
        budget.direct_samples_per_pixel =
            std::max(budget.direct_samples_per_pixel, own.direct_samples_per_pixel);
        budget.shared_limit = std::min(budget.shared_limit, own.shared_limit);
        budget.aimed_rays = std::max(budget.aimed_rays, own.aimed_rays);
    }
    if (have_budgets && !parts.empty()) {
        all.set.ray_budget = budget;
    }
    return all;
}

void KeyVpls::set_views(std::vector<KeyView> views) {
    views_ = std::move(views);
    std::erase_if(sets_, [&](const auto& entry) {
        return std::ranges::find(views_, std::get<0>(entry.first), &KeyView::frame) == views_.end();
    });
    kept_vpls_ = 0;
    for (const auto& [key, set] : sets_) {
        kept_vpls_ += set.vpls.count();
    }
}

VplSet KeyVpls::make(Session& session, const ViewSettings& view, const SamplingSettings& sampling,
                     uint seed) {
    std::vector<VplSet> fresh;
    fresh.reserve(views_.size());
    std::vector<VplPart> parts;
    const Stopwatch watch;
    for (const KeyView& key : views_) {
        const Key name{key.frame, seed, sampling.vpl_count, view.ray_budget_pilot};
        const auto kept = sets_.find(name);
        if (kept != sets_.end()) {
            parts.push_back({&kept->second, key.weight});
            continue;
        }
        ViewSettings of_key = view_;
        of_key.ray_budget_pilot = view.ray_budget_pilot;
        VplSet set = session.sample(session.look(key.camera, of_key, seed), sampling, seed);
        if (kept_vpls_ + set.vpls.count() <= kMaxKeptVpls) {
            kept_vpls_ += set.vpls.count();
            parts.push_back({&sets_.emplace(name, std::move(set)).first->second, key.weight});
        } else {
            parts.push_back({&fresh.emplace_back(std::move(set)), key.weight});
        }
    }
    VplSet set = session.join(parts);
    most_seconds_ = std::max(most_seconds_, watch.seconds());
    set.seconds_unless_kept = most_seconds_;
    return set;
}

}  // namespace nearlight::core
