// SPDX-License-Identifier: Apache-2.0
#include "host/cli/advice.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace nearlight::core {
namespace {

struct SettingAdvice {
    std::string_view setting;  ///< as in Error::setting()
    std::string_view text;
};

constexpr std::array kAdvice{
    SettingAdvice{"cache_dir", "use --cache-dir"},
    SettingAdvice{"camera", "check --origin, --target, --up and --fov"},
    SettingAdvice{"clamp_fraction", "use --clamp-radius or --clamp-fraction"},
    SettingAdvice{"device", "use --device"},
    SettingAdvice{"file", "see --load-vpls"},
    SettingAdvice{"frames", "leave out --frames for a picture of it"},
    SettingAdvice{"interleave", "use --preview, which sets it"},
    SettingAdvice{"kernel_dir", "check --kernel-dir"},
    SettingAdvice{"reference_files", "use --reference or --reference-vpls"},
    SettingAdvice{"segments", "`nearlight bench gather --dump` writes such a file"},
    SettingAdvice{"size", "give a --size of at least 1x1"},
    SettingAdvice{"strict", "without --strict it is a warning"},
    SettingAdvice{"window", "see --crop"},
};

/// The option of a setting that has no advice of its own: most options have the setting's name.
std::string option_of(std::string_view setting) {
    std::string option = "--" + std::string(setting);
    std::ranges::replace(option, '_', '-');
    return option;
}

std::string advice(const Error& error) {
    const bool lacks_memory = error.kind() == ErrorKind::out_of_memory;
    if (lacks_memory && error.setting() == "size") {
        return "use a smaller --size";
    }
    const auto found = std::ranges::find(kAdvice, error.setting(), &SettingAdvice::setting);
    if (found != kAdvice.end()) {
        return std::string(found->text);
    }
    if (!error.setting().empty()) {
        return "see " + option_of(error.setting());
    }
    return lacks_memory ? "use a smaller --size, --spp or scene" : "";
}

}  // namespace

std::string with_advice(const Error& error) {
    const std::string text = advice(error);
    return text.empty() ? error.what() : error.what() + ("; " + text);
}

}  // namespace nearlight::core
