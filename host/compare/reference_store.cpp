// SPDX-License-Identifier: Apache-2.0
#include "host/compare/reference_store.h"

#include <fmt/format.h>

#include <system_error>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/image/image_io.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// Change this when a change of the program changes references.
constexpr const char* kReferenceFormat = "reference 1";

std::string description(const ReferenceSpec& spec) {
    return std::string(kReferenceFormat) + "|" + method_name(spec) + "|" + hex_digits(spec.scene_hash) + "|" +
           std::to_string(spec.width) + "x" + std::to_string(spec.height) + "|" +
           exact_text(spec.clamp_radius) + "|" + std::to_string(spec.max_depth) + "|" +
           (spec.pixel_centers ? "centres" : "areas");
}

}  // namespace

std::string method_name(const ReferenceSpec& spec) {
    return spec.sampler ? to_string(*spec.sampler) : "path tracing";
}

std::filesystem::path ReferenceStore::file(const ReferenceSpec& spec, std::size_t index,
                                           std::size_t samples) const {
    return folder_ / (spec.scene_name + "-" + hex_digits(hash64(description(spec))) + "-pass" +
                      std::to_string(index) + "-" + std::to_string(samples) + ".exr");
}

std::optional<Image> ReferenceStore::load(const ReferenceSpec& spec, std::size_t index,
                                          std::size_t samples) const {
    const std::filesystem::path path = file(spec, index, samples);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return std::nullopt;
    }
    try {
        Image pass = read_image(path);
        if (pass.width == spec.width && pass.height == spec.height && pass.find_channel("R") >= 0) {
            return pass;
        }
        say_warning(fmt::format("'{}' does not contain what its name says; making it again", path.string()));
    } catch (const Error& error) {
        say_warning(std::string(error.what()) + "; making it again");
    }
    return std::nullopt;
}

void ReferenceStore::save(const ReferenceSpec& spec, std::size_t index, std::size_t samples,
                          const Image& pass) const {
    make_folder(folder_);
    write_image(file(spec, index, samples), pass,
                {.metadata = {{"nearlight:sampler", "reference pass, " + method_name(spec)},
                              {"nearlight:sceneHash", hex_digits(spec.scene_hash)},
                              {"nearlight:clampRadius", spec.clamp_radius},
                              {"nearlight:maxDepth", static_cast<int>(spec.max_depth)},
                              {"nearlight:pixelCenters", spec.pixel_centers ? 1 : 0},
                              {"nearlight:samples", static_cast<int>(samples)}}});
}

}  // namespace nearlight::core
