// SPDX-License-Identifier: Apache-2.0
#include "host/cli/pass_list.h"

#include <charconv>
#include <string_view>

#include "host/base/limits.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// The number that the whole text is, from 1 to `max`; 0 if it is none.
uint whole_number_in(std::string_view text, uint max) {
    uint value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value <= max ? value : 0;
}

}  // namespace

std::string pass_list_text(std::span<const uint> samples) {
    std::string text;
    for (std::size_t i = 0; i < samples.size();) {
        std::size_t end = i + 1;
        while (end < samples.size() && samples[end] == samples[i]) {
            ++end;
        }
        text += (text.empty() ? "" : ",") + std::to_string(samples[i]);
        if (end - i > 1) {
            text += "*" + std::to_string(end - i);
        }
        i = end;
    }
    return text;
}

std::vector<uint> parse_pass_list(const std::string& text) {
    std::vector<uint> samples;
    std::string_view rest = text;
    while (true) {
        const std::string_view part = rest.substr(0, rest.find(','));
        const std::size_t star = part.find('*');
        const uint each = whole_number_in(part.substr(0, star), kMaxSamplesPerPixel);
        const uint count = star == part.npos ? 1 : whole_number_in(part.substr(star + 1), kMaxListedPasses);
        if (each == 0 || count == 0 || samples.size() + count > kMaxListedPasses) {
            throw Error(ErrorKind::invalid_argument,
                        "--pass-spp is '" + text +
                            "'; give samples per pixel of each pass, as in 16,16,16,7 or 16*3,7");
        }
        samples.insert(samples.end(), count, each);
        if (part.size() == rest.size()) {
            return samples;
        }
        rest.remove_prefix(part.size() + 1);
    }
}

}  // namespace nearlight::core
