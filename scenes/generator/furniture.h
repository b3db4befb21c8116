// SPDX-License-Identifier: Apache-2.0
// Rooms and their furniture. Everything stands on y = 0 and is centred in x and z.
#pragma once

#include "host/base/random.h"
#include "scenes/generator/files.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// A random number, uniform in [low, high).
float between(Pcg32& random, float low, float high);

/// A room of the given inner size; the top of the floor is y = 0. Its parts are floor, ceiling, wall_back (at
/// −z), wall_front, wall_left (at −x), wall_right and skirting.
Model make_room(Vec3 size);
/// A round column with base and capital that reaches from the floor to `height`.
Mesh make_column(float radius, float height);
enum class BookFinish { plain, gilded };
/// A book that lies flat, its spine at −x; `size` is page width, thickness, page height. Its parts are
/// `cover` and pages. A gilded book is rounder and has gold bands on the spine.
Model make_book(Vec3 size, const std::string& cover, BookFinish finish);
/// A plain book that stands upright with its spine to the front (+z) and its thickness along x.
Model make_standing_book(Vec3 size, const std::string& cover);
/// A row of upright books from x = 0 to about `width`, backs at z = 0. The names of their covers are chosen
/// at random from `covers`.
Model make_book_row(float width, float height, const std::vector<std::string>& covers, Pcg32& random);
/// A bookcase with books, open to +z. Its parts are `wood` and those of the books.
Model make_bookcase(Vec3 size, int shelves, const std::string& wood, const std::vector<std::string>& covers,
                    Pcg32& random);
Mesh make_armchair();
/// A table with four turned legs.
Mesh make_table(Vec3 size);
/// A bitmap of wood with its grain along u. It wraps around in both directions.
Bitmap make_wood_grain(Vec3 light, Vec3 dark, int rings);

}  // namespace nearlight::core::scenes
