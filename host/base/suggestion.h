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

/// The word of `words` nearest to `word`, by edit_distance(), with at most a third of its letters wrong. Of
/// several, it is one that begins with `word`, or else the first. If even the nearest has more than one
/// mistake, the first that begins with `word` takes its place, if there is one and `word` has three letters
/// or more. An empty string says that none is near enough.
std::string nearest_word(std::string_view word, std::span<const std::string> words);

}  // namespace nearlight::core
