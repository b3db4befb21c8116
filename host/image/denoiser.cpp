// SPDX-License-Identifier: Apache-2.0
#include "host/image/denoiser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/image/oidn_library.h"
#include "host/image/rendered_share.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

template <typename Handle>
using OidnHandle = std::unique_ptr<std::remove_pointer_t<Handle>, void (*)(Handle)>;

OidnHandle<OidnDevice> start_device(const OidnFunctions& oidn, int threads) {
    OidnHandle<OidnDevice> device(oidn.NewDevice(kOidnCpuDevice), oidn.ReleaseDevice);
    // Pinned threads would stay where OpenCL's own threads work.
    oidn.SetDeviceBool(device.get(), "setAffinity", false);
    if (threads > 0) {
        oidn.SetDeviceInt(device.get(), "numThreads", threads);
    }
    oidn.CommitDevice(device.get());
    return device;
}

/// Packed RGB.
using Pixels = std::vector<float>;

/// Less than any component of a normal, rounding included.
constexpr float kAnyNormal = 2.0f;

/// Copies three channels, with `other` for what is not finite or less than `min`.
Pixels cleaned(const float* pixels, const DenoisingTask& task, float min, float other = 0.0f) {
    Pixels result(static_cast<std::size_t>(task.width) * static_cast<std::size_t>(task.height) * 3);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const float value = pixels[i / 3 * task.pixel_floats + i % 3];
        result[i] = std::isfinite(value) && value >= min ? value : other;
    }
    return result;
}

/// The sum of the parts of light, each where it is finite.
Pixels sum_of(const std::vector<Pixels>& parts) {
    Pixels sum(parts.front().size());
    for (const Pixels& part : parts) {
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += std::isfinite(part[i]) ? part[i] : 0.0f;
        }
    }
    return sum;
}

/// Gives `denoised` back what the denoiser took away without being noise.
void keep_detail(const DenoisingTask& task, const Pixels& rendered, Pixels& denoised) {
    const Pixels variance = cleaned(task.variance, task, 0.0f, std::numeric_limits<float>::infinity());
    const std::vector<float> shares =
        rendered_shares({task.width, task.height, rendered, denoised, variance});
    for (std::size_t i = 0; i < denoised.size(); ++i) {
        denoised[i] += shares[i / 3] * (rendered[i] - denoised[i]);
    }
}

}  // namespace

struct Denoiser::State {
    explicit State(int threads) : device(start_device(library.functions(), threads)) { check(); }

    /// Throws if the library reports a failure.
    void check() {
        const char* message = nullptr;
        if (library.functions().GetDeviceError(device.get(), &message) != 0) {
            throw Error(ErrorKind::failure, "Open Image Denoise " + library.version() + " failed: " +
                                                (message == nullptr ? "it gives no reason" : message) +
                                                "; render without denoising, or smaller");
        }
    }

    struct NamedImage {
        const char* name;
        Pixels& pixels;
    };

    /// Denoises the first of the images, packed RGB, in place. The others are its auxiliaries.
    void filter(const DenoisingTask& task, const std::vector<NamedImage>& images, bool is_light) {
        const OidnFunctions& oidn = library.functions();
        const OidnHandle<OidnFilter> filter(oidn.NewFilter(device.get(), "RT"), oidn.ReleaseFilter);
        check();
        const auto set_image = [&](const char* name, Pixels& pixels) {
            oidn.SetSharedFilterImage(filter.get(), name, pixels.data(), kOidnFloat3,
                                      static_cast<std::size_t>(task.width),
                                      static_cast<std::size_t>(task.height), 0, 0, 0);
        };
        for (const NamedImage& image : images) {
            set_image(image.name, image.pixels);
        }
        set_image("output", images.front().pixels);
        oidn.SetFilterBool(filter.get(), "hdr", is_light);
        oidn.SetFilterBool(filter.get(), "cleanAux", is_light && task.thorough);
        // Auxiliaries of the best quality take twice the time and help no more (bench/log/denoise.md).
        const int best = is_light ? kOidnHighQuality : kOidnBalancedQuality;
        oidn.SetFilterInt(filter.get(), "quality", task.thorough ? best : kOidnFastQuality);
        oidn.CommitFilter(filter.get());
        oidn.ExecuteFilter(filter.get());
        check();
    }

    /// Denoises all parts of the light.
    void filter(const DenoisingTask& task, std::vector<Pixels>& parts) {
        Pixels albedo = cleaned(task.albedo, task, 0.0f);
        Pixels normal = cleaned(task.normal, task, -kAnyNormal);
        if (task.thorough) {
            filter(task, {{"albedo", albedo}}, false);
            filter(task, {{"normal", normal}}, false);
        }
        for (Pixels& light : parts) {
            filter(task, {{"color", light}, {"albedo", albedo}, {"normal", normal}}, true);
        }
    }

    OidnLibrary library;
    OidnHandle<OidnDevice> device;
};

Denoiser::Denoiser(int threads) : state_(std::make_unique<State>(threads)) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

std::string Denoiser::name() const {
    return "Open Image Denoise " + state_->library.version();
}

void Denoiser::denoise(const DenoisingTask& task) {
    std::vector<Pixels> parts;
    for (const float* light : task.light) {
        parts.push_back(cleaned(light, task, 0.0f));
    }
    Pixels sum = sum_of(parts);
    if (std::min(task.width, task.height) >= kMinSide) {
        state_->filter(task, parts);
        const Pixels rendered = std::exchange(sum, sum_of(parts));
        if (task.variance != nullptr) {
            keep_detail(task, rendered, sum);
        }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
        task.output[i / 3 * task.pixel_floats + i % 3] = sum[i];
    }
}

}  // namespace nearlight::core
