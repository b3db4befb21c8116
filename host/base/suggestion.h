// SPDX-License-Identifier: Apache-2.0
// Suggestions for misspelt words ("did you mean …?").
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace nearlight::core {

/// The minimum number of insertions, deletions, replacements and swaps of neighbours that turn one word into
/// the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word of `words` nearest to `word`. Of several, it is one that begins with `word`, or else the first.
/// If none is but one mistake away, it is the first that begins with `word`, if there is one. An empty string
/// says that none is near enough.
std::string nearest_word(std::string_view word, std::span<const std::string> words);

}  // namespace nearlight::core
