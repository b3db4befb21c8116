// SPDX-License-Identifier: Apache-2.0
#include "host/scene/named_choice.h"

#include <algorithm>
#include <charconv>

#include "host/base/suggestion.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

std::string first_name(const std::vector<std::string>& names) {
    const auto named = std::ranges::find_if(names, [](const std::string& name) { return !name.empty(); });
    return named == names.end() ? "" : *named;
}

[[noreturn]] void fail_unknown(const std::filesystem::path& file, const std::string& kind,
                               std::span<const std::vector<std::string>> things, const std::string& wanted) {
    std::string list;
    std::vector<std::string> words;
    for (std::size_t i = 0; i < things.size(); ++i) {
        const std::string name = first_name(things[i]);
        list += (i > 0 ? ", " : "") + std::to_string(i + 1) + (name.empty() ? "" : " (" + name + ")");
        words.insert(words.end(), things[i].begin(), things[i].end());
    }
    const std::string near = nearest_word(wanted, words);
    throw Error(ErrorKind::invalid_argument,
                file.string() + ": has no " + kind + " '" + wanted + "'; " +
                    (near.empty() ? "" : "did you mean '" + near + "'? ") +
                    (things.empty() ? "the file has no " + kind + "s" : "choose one of: " + list));
}

}  // namespace

std::size_t choose_named(const std::filesystem::path& file, const std::string& kind,
                         std::span<const std::vector<std::string>> names, const std::string& wanted) {
    if (wanted.empty()) {
        return 0;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (std::ranges::find(names[i], wanted) != names[i].end()) {
            return i;
        }
    }
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    if (error != std::errc{} || end != wanted.data() + wanted.size() || number < 1 || number > names.size()) {
        fail_unknown(file, kind, names, wanted);
    }
    return number - 1;
}

}  // namespace nearlight::core
