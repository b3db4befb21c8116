// SPDX-License-Identifier: Apache-2.0
// Mitsuba's films with their reconstruction filter.
#pragma once

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// The size of a whole film in pixels.
struct FilmSize {
    int width = 768;
    int height = 576;
};

/// The property as a whole number from `low` to `high`. Calls fail() for any other.
int whole_number(const Object& object, const char* name, int fallback, int low, int high);

/// Sets the picture's size and its place on the film, the filter and the colour mode. Returns the size of the
/// whole film.
FilmSize apply_film(const Object& film, SceneCamera& camera, NoteSink& notes);

}  // namespace nearlight::core::mitsuba
