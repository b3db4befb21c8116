// SPDX-License-Identifier: Apache-2.0
// Principled materials of formats whose base lies below facets, clearcoat and sheen, and gets what these let
// through. They reflect no more than they get, unlike Disney's.
#pragma once

#include <map>

#include "host/scene/scene.h"
#include "host/scene/transmission_curve.h"

namespace nearlight::core {

/// Makes such materials, and shares their curves among those that are nearly alike.
class LayeredMaterials {
  public:
    /// A white material with the index of the layers, whose curve is added to the scene. It is for the caller
    /// to set all else. Of what will have a texture, `layers` has the smallest roughness, because smooth
    /// facets reflect most and no point may reflect more than it gets, and the means of all else.
    Material of(Scene& scene, const Layers& layers);

  private:
    std::map<Layers, Material> made_;
};

}  // namespace nearlight::core
