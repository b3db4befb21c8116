// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/obj_extras.h"

#include <array>
#include <charconv>

#include "host/image/color.h"
#include "host/scene/obj/obj_text.h"

namespace nearlight::core {
namespace {

/// The numbers of a line behind its first word, at most seven; those behind the first that is none do not
/// count.
std::size_t read_numbers(std::string_view line, std::array<float, 7>& numbers) {
    const char* at = line.data() + std::min(line.find_first_of(" \t"), line.size());
    const char* const end = line.data() + line.size();
    std::size_t count = 0;
    while (count < numbers.size()) {
        while (at != end && (*at == ' ' || *at == '\t' || *at == '+')) {
            ++at;
        }
        const auto [after, error] = std::from_chars(at, end, numbers[count]);
        if (error != std::errc()) {
            break;
        }
        at = after;
        ++count;
    }
    return count;
}

uint group_of(const std::string& word) {
    uint group = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), group);
    // Some programs write "on", which is a group too.
    return error == std::errc() ? group : word == "off" || word == "null" ? 0 : 1;
}

}  // namespace

void join_continued_lines(std::string& text) {
    std::string joined;
    std::size_t taken = 0;
    std::size_t missing = 0;  // line ends that were taken out
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', end + 1)) {
        const std::size_t last = end > 0 && text[end - 1] == '\r' ? end - 1 : end;
        if (last > taken && text[last - 1] == '\\') {
            joined.append(text, taken, last - 1 - taken).append(" ");
            taken = end + 1;
            ++missing;
        } else if (missing > 0) {
            joined.append(text, taken, end + 1 - taken).append(missing, '\n');
            taken = end + 1;
            missing = 0;
        }
    }
    if (taken > 0) {
        text = joined.append(text, taken);
    }
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

std::vector<Vec3> vertex_colors(std::string_view text) {
    std::vector<Vec3> colors;
    bool has_all = true;
    for_each_line(text, [&](int, std::string_view line) {
        if (starts_with_word(line, "v")) {
            line.remove_prefix(line.find('v'));
            std::array<float, 7> numbers{};
            has_all = read_numbers(line, numbers) == 6;
            colors.push_back(
                {srgb_to_linear(numbers[3]), srgb_to_linear(numbers[4]), srgb_to_linear(numbers[5])});
        }
        return has_all;
    });
    return has_all ? colors : std::vector<Vec3>{};
}

}  // namespace nearlight::core
