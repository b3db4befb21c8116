// SPDX-License-Identifier: Apache-2.0
#include "host/base/suggestion.h"

#include <algorithm>
#include <vector>

namespace nearlight::core {
namespace {

/// A beginning of a word that is shorter could be anything.
constexpr std::size_t kMinBeginning = 3;

}  // namespace

// This computes the optimal string alignment distance row by row.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        current[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before_last.swap(last);
        last.swap(current);
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({last[j] + 1, current[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                current[j] = std::min(current[j], before_last[j - 2] + 1);
            }
        }
    }
    return current[b.size()];
}

std::string nearest_word(std::string_view word, std::span<const std::string> words) {
    // At most a third of the letters may be wrong, because a suggestion misleads beyond that.
    std::size_t best_distance = word.size() / 3;
    std::string best;
    for (const std::string& known : words) {
        const std::size_t distance = edit_distance(word, known);
        // Of words that are equally near, people rather leave out the end than mistake a letter.
        const bool is_better = best.empty() || (known.starts_with(word) && !best.starts_with(word));
        if (distance < best_distance || (distance == best_distance && is_better)) {
            best_distance = distance;
            best = known;
        }
    }
    const bool is_far = best.empty() || best_distance > 1;
    if (is_far && word.size() >= kMinBeginning) {
        const auto begins = [&](const std::string& known) { return known.starts_with(word); };
        const auto longer = std::ranges::find_if(words, begins);
        best = longer == words.end() ? best : *longer;
    }
    return best;
}

}  // namespace nearlight::core
