// SPDX-License-Identifier: Apache-2.0
// VPLs that stay put while a camera moves: sets that were made for a few of its views.
#pragma once

#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "host/session/session.h"

namespace nearlight::core {

/// Several sets of VPLs as one, whose VPLs are on the host.
struct JoinedVpls {
    VplSet set;  ///< without its VPLs
    std::vector<Vpl> vpls;
};
/// What Session::join() makes of its parts; the VPLs are not sorted yet. If every part has a ray budget, the
/// clamp radius is the weighted mean of theirs, light samples and aimed rays are the most that any part has,
/// and the shared limit is the least.
JoinedVpls join_on_host(std::span<const VplPart> parts);

/// A view of an animation for which VPLs are made.
struct KeyView {
    int frame = 0;  ///< of the animation; tells key views apart
    SceneCamera camera;
    float weight = 1.0f;  ///< of its VPLs in the next picture
};

/// Makes the VPLs of a sequence of pictures in which only the camera moves. The VPLs of a picture are those
/// of one or two key views that are near in time. From one picture to the next only their weights change, so
/// that the error of VPLs, which looks like stains on the walls, fades slowly instead of flickering, while
/// there are always VPLs where the camera looks. Sets are unbiased, and so is their mean. They depend on
/// nothing but their key views, so that a picture has the same bits whichever others are made.
class KeyVpls {
  public:
    /// `view` has the settings of each picture's view, before a pass decided any of them.
    explicit KeyVpls(ViewSettings view) : view_(std::move(view)) {}

    /// The key views of the next picture, whose weights add up to 1. Sets of others are dropped.
    void set_views(std::vector<KeyView> views);
    [[nodiscard]] bool has_views() const { return !views_.empty(); }
    [[nodiscard]] const std::vector<KeyView>& views() const { return views_; }

    /// The VPLs of a pass of the picture. Of `view` only `ray_budget_pilot` counts, because all else is that
    /// of the key views.
    VplSet make(Session& session, const ViewSettings& view, const SamplingSettings& sampling, uint seed);

  private:
    using Key = std::tuple<int, uint, uint, bool>;  ///< frame, seed, VPLs, and whether the pilot ran

    ViewSettings view_;
    std::vector<KeyView> views_;
    std::map<Key, VplSet> sets_;
    std::size_t kept_vpls_ = 0;
    double most_seconds_ = 0.0;  ///< that the VPLs of a pass took so far
};

}  // namespace nearlight::core
