// SPDX-License-Identifier: Apache-2.0
#include "host/cli/stored_reference.h"

#include <algorithm>
#include <string>
#include <vector>

#include "host/cli/log.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

std::string to_text(const Metadata::mapped_type& value) {
    if (const auto* integer = std::get_if<int>(&value)) {
        return std::to_string(*integer);
    }
    if (const auto* number = std::get_if<float>(&value)) {
        return fmt::format("{}", *number);
    }
    return std::get<std::string>(value);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) {
    throw Error(ErrorKind::file,
                "cannot resume '" + file.string() + "': " + reason +
                    "; use the scene and options that it was made with, or give another output");
}

/// The attribute `name` of type T. Throws Error(ErrorKind::file) if there is none.
template <typename T>
T attribute(const std::filesystem::path& file, const Metadata& stored, const std::string& name) {
    const auto found = stored.find(name);
    if (found == stored.end() || !std::holds_alternative<T>(found->second)) {
        refuse(file, "it has no attribute " + name + ", so it is not a reference that can be resumed");
    }
    return std::get<T>(found->second);
}

/// The differences in words, such as "nearlight:clampRadius is 0.1, not 0".
std::vector<std::string> differences(const Metadata& stored, const Metadata& wanted) {
    std::vector<std::string> found;
    for (const auto& [name, value] : wanted) {
        const auto other = stored.find(name);
        if (other == stored.end()) {
            found.push_back(name + " is missing");
        } else if (other->second != value) {
            found.push_back(name + " is " + to_text(other->second) + ", not " + to_text(value));
        }
    }
    return found;
}

int min_samples(const Image& image, const std::filesystem::path& file) {
    const int channel = image.find_channel("count.X");
    if (channel < 0) {
        refuse(file, "it has no channel count.X");
    }
    float min_count = image.at(0, 0, static_cast<std::size_t>(channel));
    for (std::size_t i = static_cast<std::size_t>(channel); i < image.values.size();
         i += image.channel_count()) {
        min_count = std::min(min_count, image.values[i]);
    }
    return static_cast<int>(min_count);
}

}  // namespace

Metadata reference_identity(const PathTracerSettings& settings, const Scene& scene) {
    return {{"nearlight:sampler", std::string("reference")},
            {"nearlight:clampRadius", settings.clamp_radius},
            {"nearlight:indirectOnly", settings.indirect_only ? 1 : 0},
            {"nearlight:pixelCenters", settings.pixel_centers ? 1 : 0},
            {"nearlight:maxDepth", settings.max_depth},
            {"nearlight:seed", std::to_string(settings.seed)},
            {"nearlight:version", std::string(NEARLIGHT_VERSION)},
            {"nearlight:sceneHash", fmt::format("{:016x}", scene_hash(scene))}};
}

std::optional<StoredReference> read_stored_reference(const std::filesystem::path& file,
                                                     const PathTracerSettings& wanted, const Scene& scene) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        return std::nullopt;
    }
    const Metadata stored = read_metadata(file);
    const std::vector<std::string> other = differences(stored, reference_identity(wanted, scene));
    if (!other.empty()) {
        refuse(file, fmt::format("{}", fmt::join(other, ", ")));
    }
    StoredReference reference{.image = read_image(file),
                              .batch_size = attribute<int>(file, stored, "nearlight:samplesPerBatch"),
                              .render_seconds = attribute<float>(file, stored, "renderTimeSeconds")};
    const Image& image = reference.image;
    if (image.width != wanted.width || image.height != wanted.height) {
        refuse(file, fmt::format("it has {}x{} pixels, not {}x{}", image.width, image.height, wanted.width,
                                 wanted.height));
    }
    reference.samples = min_samples(image, file);
    return reference;
}

}  // namespace nearlight::core
