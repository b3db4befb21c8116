// SPDX-License-Identifier: Apache-2.0
#include "host/cli/stored_reference.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "host/cli/log.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr const char* kSamplerAttribute = "nearlight:sampler";
constexpr const char* kSceneAttribute = "nearlight:sceneHash";

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

/// The option behind an attribute, and whether it is a flag.
struct AttributeOption {
    const char* attribute;
    const char* option;
    bool is_flag = false;
};
constexpr std::array kAttributeOptions{AttributeOption{"nearlight:clampRadius", "--clamp-radius"},
                                       AttributeOption{"nearlight:indirectOnly", "--indirect-only", true},
                                       AttributeOption{"nearlight:pixelCenters", "--pixel-centers", true},
                                       AttributeOption{"nearlight:maxDepth", "--max-depth"},
                                       AttributeOption{"nearlight:seed", "--seed"}};

/// How the stored value of an attribute differs from the one that is wanted, in words.
std::string difference_text(const std::string& name, const std::string& stored, const std::string& wanted) {
    const auto* const option = std::ranges::find(kAttributeOptions, name, &AttributeOption::attribute);
    if (option == kAttributeOptions.end()) {
        return name == kSceneAttribute ? "it has another scene, camera, --filter or --glass"
                                       : "its " + name + " is " + stored + ", not " + wanted;
    }
    if (option->is_flag) {
        return std::string(stored == "0" ? "it lacks " : "it has ") + option->option;
    }
    return std::string("it has ") + option->option + " " + stored + ", not " + wanted;
}

/// The differences in words, such as "it has --clamp-radius 0.1, not 0".
std::vector<std::string> differences(const Metadata& stored, const Metadata& wanted) {
    std::vector<std::string> found;
    for (const auto& [name, value] : wanted) {
        const auto other = stored.find(name);
        if (other == stored.end()) {
            found.push_back("its " + name + " is missing");
        } else if (other->second != value) {
            found.push_back(difference_text(name, to_text(other->second), to_text(value)));
        }
    }
    return found;
}

/// Throws Error(ErrorKind::file) if the picture was made by something else than `nearlight reference`.
void check_maker(const std::filesystem::path& file, const Metadata& stored, const Metadata& wanted) {
    const auto sampler = stored.find(kSamplerAttribute);
    if (sampler == stored.end() || sampler->second != wanted.at(kSamplerAttribute)) {
        throw Error(ErrorKind::file, "'" + file.string() +
                                         "' was not made by `nearlight reference`, so it cannot be resumed; "
                                         "give another output");
    }
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
    return {{kSamplerAttribute, std::string("reference")},
            {"nearlight:clampRadius", settings.clamp_radius},
            {"nearlight:indirectOnly", settings.indirect_only ? 1 : 0},
            {"nearlight:pixelCenters", settings.pixel_centers ? 1 : 0},
            {"nearlight:maxDepth", settings.max_depth},
            {"nearlight:seed", std::to_string(settings.seed)},
            {"nearlight:version", std::string(NEARLIGHT_VERSION)},
            {kSceneAttribute, fmt::format("{:016x}", scene_hash(scene))}};
}

std::optional<StoredReference> read_stored_reference(const std::filesystem::path& file,
                                                     const PathTracerSettings& wanted, const Scene& scene) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        return std::nullopt;
    }
    const Metadata stored = read_metadata(file);
    const Metadata identity = reference_identity(wanted, scene);
    check_maker(file, stored, identity);
    if (const std::vector<std::string> other = differences(stored, identity); !other.empty()) {
        refuse(file, fmt::format("{}", fmt::join(other, "; ")));
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
