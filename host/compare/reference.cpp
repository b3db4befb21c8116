// SPDX-License-Identifier: Apache-2.0
#include "host/compare/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "host/base/division.h"
#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/base/stopwatch.h"
#include "host/compare/pictures.h"
#include "host/compare/settings.h"
#include "host/image/image_io.h"
#include "host/image/metrics.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// Samples per pixel of a pass of path tracing; a multiple of the path tracer's batch size.
constexpr std::size_t kPassSamples = 256;
/// Samples per pixel of a pass of path tracing are rounded up to a multiple of this: whole batches, and
/// enough of them to estimate the noise.
constexpr std::size_t kSampleUnit = 16;

/// Sums of values, squares and variances over passes.
class ReferenceSums {
  public:
    explicit ReferenceSums(const ReferenceSpec& spec)
        : values_(3 * static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height)),
          squares_(values_),
          own_(values_) {}

    void add(const Image& pass, double samples) {
        const Image picture = color_layer(pass, "");
        const bool has_own = has_color_layer(pass, "variance");
        const Image variance =
            has_own ? color_layer(pass, "variance") : make_picture(pass.width, pass.height);
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const double value = static_cast<double>(picture.values[i]);
            values_[i] += samples * value;
            squares_[i] += samples * value * value;
            own_[i] += samples * samples * static_cast<double>(variance.values[i]);
        }
        samples_ += samples;
        ++passes_;
        own_known_ = own_known_ && has_own;
    }
    /// Variance of the mean of value `i`; NaN if it is not known.
    [[nodiscard]] double variance(std::size_t i) const {
        if (own_known_) {
            return own_[i] / (samples_ * samples_);
        }
        const double mean = values_[i] / samples_;
        return std::max(0.0, squares_[i] / samples_ - mean * mean) / (static_cast<double>(passes_) - 1.0);
    }
    [[nodiscard]] double mean(std::size_t i) const { return values_[i] / samples_; }
    [[nodiscard]] std::size_t size() const { return values_.size(); }

  private:
    std::vector<double> values_, squares_, own_;
    double samples_ = 0;
    std::size_t passes_ = 0;
    bool own_known_ = true;
};

/// The mean noise of the picture; unknown if the variance of any value is.
ReferenceNoise noise_of(const Image& picture, std::span<const double> variances) {
    ReferenceNoise noise{.known = true};
    for (std::size_t i = 0; i < variances.size(); ++i) {
        const double value = static_cast<double>(picture.values[i]);
        noise.mean_variance += variances[i];
        noise.mean_relative_variance += variances[i] / (value * value + kRelativeErrorFloor);
    }
    const auto count = static_cast<double>(variances.size());
    noise.mean_variance /= count;
    noise.mean_relative_variance /= count;
    return std::isfinite(noise.mean_variance) ? noise : ReferenceNoise{};
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw Error(ErrorKind::file,
                "'" + file.string() + "' cannot be the reference of this comparison: " + why);
}

template <typename Value>
Value attribute(const std::filesystem::path& file, const Metadata& metadata, const char* name) {
    const auto found = metadata.find(name);
    if (found == metadata.end() || !std::holds_alternative<Value>(found->second)) {
        refuse(file, std::string("it has no attribute '") + name +
                         "'; make the reference with `nearlight reference`");
    }
    return std::get<Value>(found->second);
}

void check_reference_file(const std::filesystem::path& file, const Metadata& metadata, const Image& image,
                          const ReferenceSpec& spec) {
    const auto hash = attribute<std::string>(file, metadata, "nearlight:sceneHash");
    if (hash != hex_digits(spec.scene_hash)) {
        refuse(file, "it shows another scene (its hash is " + hash + ", that of " + spec.scene_name + " is " +
                         hex_digits(spec.scene_hash) + ")");
    }
    if (image.width != spec.width || image.height != spec.height) {
        refuse(file, "it has " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                         " pixels, but the comparison has " + std::to_string(spec.width) + "x" +
                         std::to_string(spec.height));
    }
    const float radius = attribute<float>(file, metadata, "nearlight:clampRadius");
    if (!(std::abs(radius - spec.clamp_radius) <= 1e-5f * spec.clamp_radius)) {
        refuse(file, "its clamp radius is " + std::to_string(radius) + ", but that of the comparison is " +
                         std::to_string(spec.clamp_radius));
    }
    const int depth = attribute<int>(file, metadata, "nearlight:maxDepth");
    if (depth != static_cast<int>(spec.max_depth)) {
        refuse(file, "its depth is " + std::to_string(depth) + ", but that of the comparison is " +
                         std::to_string(spec.max_depth));
    }
}

}  // namespace

std::string samples_text(const Reference& reference) {
    return std::to_string(reference.samples) + (reference.path_traced ? " samples per pixel" : " VPLs");
}

std::uint64_t identity(const Reference& reference) {
    return hash64(std::as_bytes(std::span(reference.picture.values)));
}

std::vector<std::size_t> pass_sizes(const ReferenceSpec& spec, std::size_t samples) {
    const bool traced = !spec.sampler;
    const std::size_t size = traced ? kPassSamples : divide_rounding_up(samples, kReferencePasses);
    std::vector<std::size_t> sizes(samples / size, size);
    if (const std::size_t rest = samples % size; rest > 0) {
        sizes.push_back(traced ? round_up_to_multiple(rest, kSampleUnit) : rest);
    }
    return sizes;
}

std::optional<Reference> make_reference(const ReferenceSpec& spec, std::size_t samples,
                                        const ReferenceStore& store, const PassMaker& make_pass) {
    const Stopwatch watch;
    ReferenceSums sums(spec);
    bool made = false;
    const std::vector<std::size_t> sizes = pass_sizes(spec, samples);
    for (std::size_t index = 0; index < sizes.size(); ++index) {
        std::optional<Image> pass = store.load(spec, index, sizes[index]);
        if (!pass) {
            pass = make_pass(index, sizes[index]);
            if (!pass) {
                return std::nullopt;
            }
            made = true;
            store.save(spec, index, sizes[index], *pass);
        }
        sums.add(*pass, static_cast<double>(sizes[index]));
    }
    Reference reference{.picture = make_picture(spec.width, spec.height),
                        .method = method_name(spec),
                        .path_traced = !spec.sampler,
                        .samples = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0})};
    std::vector<double> variances(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        reference.picture.values[i] = static_cast<float>(sums.mean(i));
        variances[i] = sums.variance(i);
    }
    reference.noise = noise_of(reference.picture, variances);
    reference.display_scale = display_scale(reference.picture);
    reference.seconds = made ? watch.seconds() : 0.0;
    return reference;
}

Reference load_reference(const std::filesystem::path& file, const ReferenceSpec& spec) {
    const Metadata metadata = read_metadata(file);
    const Image image = read_image(file);
    check_reference_file(file, metadata, image, spec);
    if (!has_color_layer(image, "indirect")) {
        refuse(file, "it has no layer 'indirect'");
    }
    Reference reference{
        .picture = color_layer(image, "indirect"),
        .method = method_name({}),
        .samples = static_cast<std::size_t>(attribute<int>(file, metadata, "nearlight:samplesPerPixel")),
        .file = file.string()};
    if (has_color_layer(image, "indirectVariance")) {
        const Image variance = color_layer(image, "indirectVariance");
        reference.noise =
            noise_of(reference.picture, std::vector<double>(variance.values.begin(), variance.values.end()));
    }
    if (attribute<int>(file, metadata, "nearlight:complete") == 0) {
        say_warning(
            fmt::format("'{}' was interrupted: some of its pixels are noisier than others", file.string()));
    }
    const auto centers = metadata.find("nearlight:pixelCenters");
    const bool has_centers = centers != metadata.end() && centers->second == Metadata::mapped_type(1);
    if (has_centers != spec.pixel_centers) {
        say_warning(
            fmt::format("'{}' was sampled {}, but the pictures of the comparison are sampled {}; the "
                        "difference counts as error",
                        file.string(), has_centers ? "at the centres of pixels" : "all over the pixels",
                        spec.pixel_centers ? "at the centres of pixels" : "all over the pixels"));
    }
    reference.display_scale = display_scale(reference.picture);
    return reference;
}

}  // namespace nearlight::core
