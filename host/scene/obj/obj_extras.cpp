// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/obj_extras.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "host/scene/obj/obj_text.h"
#include "host/scene/vertex_colors.h"

namespace nearlight::core {
namespace {

/// The six numbers of `v x y z r g b`. Empty if there are more or fewer, as where a weight follows z.
std::optional<std::array<float, 6>> numbers_of_colored_vertex(std::string_view line) {
    std::array<float, 6> numbers{};
    const char* at = line.data() + line.find('v') + 1;
    const char* const end = line.data() + line.size();
    const auto skip_blanks = [&] {
        while (at != end && (*at == ' ' || *at == '\t' || *at == '+' || *at == '\r')) {
            ++at;
        }
    };
    for (float& number : numbers) {
        skip_blanks();
        const auto [after, error] = std::from_chars(at, end, number);
        if (error != std::errc()) {
            return std::nullopt;
        }
        at = after;
    }
    skip_blanks();
    return at == end ? std::optional(numbers) : std::nullopt;
}

/// Blanks comments behind faces, numbers of vertices and smoothing groups, which tinyobjloader would read on
/// into. Names may have the sign in them, and keep it.
void blank_comments(std::string& text) {
    constexpr std::array<std::string_view, 5> kWithoutNames{"f", "v", "vt", "vn", "s"};
    for (std::size_t at = text.find('#'); at != std::string::npos; at = text.find('#', at)) {
        const std::size_t begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view word = first_word(std::string_view(text).substr(begin, at - begin));
        if (std::ranges::find(kWithoutNames, word) != kWithoutNames.end()) {
            std::fill(text.begin() + static_cast<std::ptrdiff_t>(at),
                      text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
        }
        at = end;
    }
}

/// Whether the line that begins at this place, and is not blank, is a comment.
bool is_comment(std::string_view text, std::size_t begin) {
    return text[text.find_first_not_of(" \t", begin)] == '#';
}

uint group_of(const std::string& word) {
    if (word == "off" || word == "null") {
        return 0;
    }
    uint group = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), group);
    // Some programs write "on", which is a group too.
    return error == std::errc() ? group : 1;
}

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// How many words the text has, if they are decimal numbers alone; 0 if they are not.
std::size_t number_count(std::string_view line) {
    std::size_t count = 0;
    bool in_word = false;
    for (const char c : line) {
        const bool is_of_number =
            (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
        if (!is_of_number && !is_blank(c)) {
            return 0;
        }
        count += is_of_number && !in_word ? 1 : 0;
        in_word = is_of_number;
    }
    return count;
}

/// Blanks slashes of faces that no number follows; tinyobjloader would take the next corner's for theirs.
void blank_empty_fields(std::string& text) {
    std::size_t begin = 0;
    for_each_line(std::string(text), [&](int, std::string_view line) {
        if (starts_with_word(line, "f")) {
            for (std::size_t i = line.size(); i-- > 0;) {
                const char next = i + 1 < line.size() ? text[begin + i + 1] : ' ';
                if (line[i] == '/' && is_blank(next)) {
                    text[begin + i] = ' ';
                }
            }
        }
        begin += line.size() + 1;
        return true;
    });
}

}  // namespace

void tidy_lines(std::string& text) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(kByteOrderMark)) {
        text.erase(0, kByteOrderMark.size());
    }
    for (std::size_t at = text.find('\r'); at != std::string::npos; at = text.find('\r', at + 1)) {
        if (at + 1 == text.size() || text[at + 1] != '\n') {
            text[at] = '\n';
        }
    }
    std::string joined;
    std::size_t taken = 0;
    std::size_t missing = 0;  // line ends that were taken out
    std::size_t begin = 0;    // of the line
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', end + 1)) {
        const std::size_t last = end > 0 && text[end - 1] == '\r' ? end - 1 : end;
        if (last > taken && text[last - 1] == '\\' && (missing > 0 || !is_comment(text, begin))) {
            joined.append(text, taken, last - 1 - taken).append(" ");
            taken = end + 1;
            ++missing;
        } else if (missing > 0) {
            joined.append(text, taken, end + 1 - taken).append(missing, '\n');
            taken = end + 1;
            missing = 0;
        }
        begin = end + 1;
    }
    if (taken > 0) {
        text = joined.append(text, taken);
    }
    blank_comments(text);
    // Hardly any file has such slashes, and a single look at all of it costs little.
    const auto slash = std::ranges::adjacent_find(
        text, [](char c, char next) { return c == '/' && static_cast<unsigned char>(next) <= ' '; });
    if (slash != text.end() || text.ends_with('/')) {
        blank_empty_fields(text);
    }
}

OddNumbers odd_numbers(std::string_view text) {
    OddNumbers odd;
    for_each_line(text, [&](int number, std::string_view line) {
        while (!line.empty() && is_blank(line.front())) {
            line.remove_prefix(1);
        }
        const bool is_position = line == "v" || (line.size() > 1 && line[0] == 'v' && is_blank(line[1]));
        const std::size_t needed = is_position || line.starts_with("vn") ? 3 : line.starts_with("vt") ? 1 : 0;
        line = line.substr(std::min<std::size_t>(is_position ? 1 : 2, line.size()));
        if (needed > 0 && number_count(line) < needed) {
            odd.first_line = odd.lines++ == 0 ? number : odd.first_line;
        }
        return true;
    });
    return odd;
}

std::vector<SmoothingRun> smoothing_runs(std::string_view text) {
    std::vector<SmoothingRun> runs;
    std::size_t faces = 0;
    for_each_line(text, [&](int, std::string_view line) {
        if (starts_with_word(line, "f")) {
            ++faces;
        } else if (starts_with_word(line, "s")) {
            runs.push_back({faces, group_of(value_after(line, "s"))});
        }
        return true;
    });
    return runs;
}

std::vector<std::size_t> mesh_starts(std::string_view text) {
    std::vector<std::size_t> starts;
    std::size_t faces = 0;
    bool begins = true;
    for_each_line(text, [&](int, std::string_view line) {
        const std::string_view word = first_word(line);
        if (word == "g" || word == "usemtl") {
            begins = true;
        } else if (starts_with_word(line, "f")) {
            if (begins) {
                starts.push_back(faces);
            }
            begins = false;
            ++faces;
        }
        return true;
    });
    return starts;
}

std::vector<Vec3> vertex_colors(std::string_view text) {
    std::vector<Vec3> colors;
    bool has_all = true;
    for_each_line(text, [&](int, std::string_view line) {
        if (starts_with_word(line, "v")) {
            const std::optional<std::array<float, 6>> numbers = numbers_of_colored_vertex(line);
            has_all = numbers.has_value();
            if (has_all) {
                colors.push_back({(*numbers)[3], (*numbers)[4], (*numbers)[5]});
            }
        }
        return has_all;
    });
    if (!has_all) {
        return {};
    }
    decode_display_colors(colors);
    return colors;
}

}  // namespace nearlight::core
