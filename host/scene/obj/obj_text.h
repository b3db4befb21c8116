// SPDX-License-Identifier: Apache-2.0
// The lines of OBJ and MTL files.
#pragma once

#include <algorithm>
#include <cstddef>
#include <streambuf>
#include <string>
#include <string_view>
#include <unordered_map>

namespace nearlight::core {

/// An istream over text in memory, without a copy.
class TextBuffer : public std::streambuf {
  public:
    explicit TextBuffer(std::string& text) { setg(text.data(), text.data(), text.data() + text.size()); }
};

inline std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) {
        return {};
    }
    return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

/// Calls visit(line number, line) until it returns false.
template <typename Visit>
void for_each_line(std::string_view text, Visit visit) {
    int number = 1;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (!visit(number, text.substr(begin, end - begin))) {
            return;
        }
        begin = end + 1;
    }
}

inline bool starts_with_word(std::string_view line, std::string_view word) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return line.size() > word.size() && line.starts_with(word) &&
           (line[word.size()] == ' ' || line[word.size()] == '\t');
}

/// The first word of a line; empty if there is none.
inline std::string_view first_word(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    return line.substr(0, line.find_first_of(" \t\r"));
}

/// What follows the word in a line that starts with it.
inline std::string value_after(std::string_view line, std::string_view word) {
    return trimmed(line.substr(line.find(word) + word.size()));
}

/// A line, and where it begins in the text.
struct TextLine {
    int number = 0;  ///< counted from 1; 0 if there is no such line
    std::size_t begin = 0;
};

/// The first line `word VALUE` of each value.
inline std::unordered_map<std::string, TextLine> lines_by_value(std::string_view text,
                                                                std::string_view word) {
    std::unordered_map<std::string, TextLine> lines;
    for_each_line(text, [&](int number, std::string_view line) {
        if (starts_with_word(line, word)) {
            lines.try_emplace(value_after(line, word),
                              TextLine{number, static_cast<std::size_t>(line.data() - text.data())});
        }
        return true;
    });
    return lines;
}

/// The number of the line `word … value` in the block that begins at `first` and goes on to the next line
/// with the word that `first` has; 0 if there is none, or no such block. Blocks are short, so that all
/// searches in a file read it about once.
inline int find_in_block(std::string_view text, TextLine first, std::string_view block, std::string_view word,
                         std::string_view value) {
    if (first.number == 0) {
        return 0;
    }
    int found = 0;
    for_each_line(text.substr(first.begin), [&](int number, std::string_view line) {
        if (starts_with_word(line, word) && line.find(value) != std::string_view::npos) {
            found = first.number + number - 1;
        }
        return found == 0 && (number == 1 || !starts_with_word(line, block));
    });
    return found;
}

}  // namespace nearlight::core
