// SPDX-License-Identifier: Apache-2.0
#include "host/compare/settings.h"

#include <algorithm>
#include <charconv>

#include "host/base/words.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

template <typename Number>
std::optional<Number> whole_number(const std::string& text) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && rest == end ? std::optional(value) : std::nullopt;
}

uint parse_vpl_count(const std::string& text) {
    const std::optional<uint> count = whole_number<uint>(text);
    if (!count || *count < 1 || *count > kMaxVpls) {
        throw Error(ErrorKind::invalid_argument,
                    "'" + text + "' is not a number of VPLs; give whole numbers from 1 to " +
                        std::to_string(kMaxVpls) + ", separated by commas, as in 1000,2000",
                    "vpls");
    }
    return *count;
}

template <typename Item, typename Name>
void refuse_twins(const std::vector<Item>& items, const char* setting, Name&& name) {
    for (auto item = items.begin(); item != items.end(); ++item) {
        if (std::find(items.begin(), item, *item) != item) {
            throw Error(ErrorKind::invalid_argument, name(*item) + " is named twice; name it once", setting);
        }
    }
}

void check_crop(const Crop& crop, int width, int height) {
    if (crop.x < 0 || crop.y < 0 || crop.x > width - crop.width || crop.y > height - crop.height) {
        throw Error(ErrorKind::invalid_argument,
                    "the crop " + std::to_string(crop.width) + "x" + std::to_string(crop.height) + "+" +
                        std::to_string(crop.x) + "+" + std::to_string(crop.y) +
                        " reaches beyond the picture of " + std::to_string(width) + "x" +
                        std::to_string(height) + " pixels",
                    "crop");
    }
}

void check_baseline(const CompareSettings& settings) {
    if (std::find(settings.methods.begin(), settings.methods.end(), settings.baseline) !=
        settings.methods.end()) {
        return;
    }
    throw Error(ErrorKind::invalid_argument,
                "the baseline " + to_string(settings.baseline) +
                    " is not among the samplers to compare: " + to_string(settings.methods),
                "baseline");
}

std::size_t min_reference_vpls(const CompareSettings& settings) {
    if (!settings.reference_sampler ||
        settings.reference_sampler->sampler == SamplerKind::instant_radiosity) {
        return kMinReferenceVpls;
    }
    return kReferenceExcess * std::ranges::max(settings.vpl_counts);
}

void check_reference_sampler(const CompareSettings& settings) {
    const Method& sampler = *settings.reference_sampler;
    if (sampler.policy == Policy::paper) {
        throw Error(ErrorKind::invalid_argument,
                    to_string(sampler) + " loses light, so it cannot make the reference; use another",
                    "reference_sampler");
    }
    if (settings.reference_vpls == 0) {
        throw Error(ErrorKind::invalid_argument,
                    "a reference by " + to_string(sampler) + " needs a number of VPLs; say how many",
                    "reference_vpls");
    }
}

void check_reference(const CompareSettings& settings) {
    if (settings.reference_sampler) {
        check_reference_sampler(settings);
    }
    if (settings.reference_vpls > 0 && settings.reference_vpls < min_reference_vpls(settings)) {
        throw Error(ErrorKind::invalid_argument,
                    std::to_string(settings.reference_vpls) +
                        " VPLs are too few for a reference; use at least " +
                        std::to_string(min_reference_vpls(settings)),
                    "reference_vpls");
    }
    if (settings.reference_vpls > 0 && !settings.reference_files.empty()) {
        throw Error(ErrorKind::invalid_argument,
                    "a reference is either read from a file or made of VPLs; give a file or a number of VPLs",
                    "reference_files");
    }
}

}  // namespace

std::vector<Method> parse_methods(const std::string& list) {
    std::vector<Method> methods;
    for (const std::string& name : split(list, ',')) {
        methods.push_back(parse_method(name));
    }
    refuse_twins(methods, "samplers", [](const Method& method) { return to_string(method); });
    return methods;
}

std::vector<uint> parse_vpl_counts(const std::string& list) {
    std::vector<uint> counts;
    for (const std::string& item : split(list, ',')) {
        counts.push_back(parse_vpl_count(item));
    }
    refuse_twins(counts, "vpls", [](uint count) { return std::to_string(count); });
    std::sort(counts.begin(), counts.end());
    return counts;
}

void check_settings(const CompareSettings& settings) {
    if (settings.methods.empty() || settings.vpl_counts.empty() || settings.seed_count == 0) {
        throw Error(ErrorKind::invalid_argument,
                    "nothing to compare: give at least one sampler, one number of VPLs and one seed");
    }
    if (settings.clamp_radius && settings.clamp_fraction) {
        throw Error(ErrorKind::invalid_argument,
                    "the clamp radius is given both as a length and as a fraction of the range; give only "
                    "one of them",
                    "clamp_fraction");
    }
    if (settings.max_depth && *settings.max_depth < 3) {
        throw Error(ErrorKind::invalid_argument,
                    "a depth of " + std::to_string(*settings.max_depth) +
                        " leaves no indirect light, which is what is compared; use 3 or more",
                    "max_depth");
    }
    check_baseline(settings);
    check_reference(settings);
    for (const Crop& crop : settings.crops) {
        check_crop(crop, settings.width, settings.height);
    }
}

}  // namespace nearlight::core
