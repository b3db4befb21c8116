// SPDX-License-Identifier: Apache-2.0
#include "tests/session/energy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/student_t.h"
#include "host/reference/path_tracer.h"

namespace nearlight::core::test {
namespace {

constexpr int kTruthSpp = 256;
constexpr std::size_t kFewPixels = 20;

double luminance_at(const Image& image, std::size_t pixel, const std::string& layer) {
    const float* values = &image.values[pixel * image.channel_count()];
    const auto value = [&](const char* color) {
        return values[static_cast<std::size_t>(image.find_channel(layer + color))];
    };
    return luminance({value(".R"), value(".G"), value(".B")});
}

/// Upper bound of the standard deviation of luminance, for fully correlated colour channels.
double luminance_error(const Image& image, std::size_t pixel, const std::string& layer) {
    const float* values = &image.values[pixel * image.channel_count()];
    const auto value = [&](const char* color) {
        return std::sqrt(values[static_cast<std::size_t>(image.find_channel(layer + color))]);
    };
    return luminance({value(".R"), value(".G"), value(".B")});
}

}  // namespace

std::string to_string(const EnergyClass& energy_class) {
    return "camera " + std::to_string(energy_class.camera) + ", " +
           (energy_class.inside ? "inside" : "outside") +
           (energy_class.depth > 0 ? ", depth " + std::to_string(energy_class.depth) : ", all depths");
}

bool in_region(const CloseRange& region, Vec3 p) {
    const Vec3 q = p - region.origin;
    for (const auto& plane : region.planes) {
        if (plane[0] * q.x + plane[1] * q.y + plane[2] * q.z + plane[3] < 0.0f) {
            return false;
        }
    }
    return length(q) < region.range;
}

Photographer::Photographer(const Scene& scene, std::vector<SceneCamera> cameras, const CloseRange& region,
                           uint depths)
    : embree_(scene), depths_(depths) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        films_.push_back({cameras[i], inverse(cameras[i].to_world), {}});
        trace_truth(scene, i, region);
    }
    std::erase_if(truth_, [this](const auto& entry) {
        const auto& inside = films_[entry.first.camera].inside;
        return static_cast<std::size_t>(std::ranges::count(inside, entry.first.inside)) < kFewPixels;
    });
}

void Photographer::trace_truth(const Scene& scene, std::size_t camera, const CloseRange& region) {
    Film& film = films_[camera];
    Scene view = scene;
    view.camera = film.camera;
    Image shallower;
    for (uint depth = 1; depth <= depths_; ++depth) {
        // With the same seed, the shorter paths of both pictures are equal and cancel in the difference.
        const Image image =
            trace_paths(view, {.spp = kTruthSpp, .max_depth = static_cast<int>(depth) + 1, .seed = 23});
        const std::size_t pixels = image.values.size() / image.channel_count();
        const auto position = static_cast<std::size_t>(image.find_channel("P.X"));
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            const float* p = &image.values[pixel * image.channel_count() + position];
            if (depth == 1) {
                film.inside.push_back(in_region(region, {p[0], p[1], p[2]}));
            }
            Expected& expected = truth_[{camera, film.inside[pixel], depth}];
            const double all = luminance_at(image, pixel, depth == 1 ? "direct" : "indirect");
            const double less = depth <= 2 ? 0.0 : luminance_at(shallower, pixel, "indirect");
            expected.mean += all - less;
            // The variance of the whole is an upper bound for that of the difference, which is positive for
            // every path.
            expected.error +=
                std::pow(luminance_error(image, pixel, depth == 1 ? "variance" : "indirectVariance"), 2);
        }
        shallower = image;
    }
    for (auto& [energy_class, expected] : truth_) {
        if (energy_class.camera == camera) {
            expected.error = std::sqrt(expected.error);
        }
    }
}

void Photographer::expose(std::size_t camera, const Vpl& vpl, std::map<EnergyClass, double>& sums) const {
    const Film& film = films_[camera];
    const Vec3 seen = transform_point(film.to_camera, vpl.position);
    const double tan_x = std::tan(film.camera.fov_x_degrees * std::numbers::pi / 360.0);
    const double pixels_per_unit = film.camera.width / (2.0 * tan_x);  // on the plane at distance 1
    const double x = 0.5 * film.camera.width - seen.x / seen.z * pixels_per_unit;
    const double y = 0.5 * film.camera.height - seen.y / seen.z * pixels_per_unit;
    if (!(seen.z > 0.0f && x >= 0 && x < film.camera.width && y >= 0 && y < film.camera.height)) {
        return;
    }
    const Vec3 eye = transform_point(film.camera.to_world, {0, 0, 0});
    const Vec3 away = vpl.position - eye;
    const double distance = length(away);
    const double cosine = -dot(away, vpl.normal) / distance;
    if (cosine <= 0.0 || embree_.occluded(eye, away, 0.0f, 0.999f)) {
        return;
    }
    // A solid angle covers 1/cos³ times its size on the film.
    const double on_axis = seen.z / distance;
    const double pixels_per_area =
        cosine / (distance * distance) / (on_axis * on_axis * on_axis) * pixels_per_unit * pixels_per_unit;
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(film.camera.width) +
                       static_cast<std::size_t>(x);
    const double light = luminance(vpl.power) / std::numbers::pi * pixels_per_area;
    if (const auto found = sums.find({camera, film.inside[pixel], vpl.depth});
        vpl.depth > 0 && found != sums.end()) {
        found->second += light;
    }
    sums[{camera, film.inside[pixel], 0}] += light;
}

std::map<EnergyClass, double> Photographer::photograph(const std::vector<Vpl>& vpls) const {
    std::map<EnergyClass, double> sums;
    for (const auto& [energy_class, expected] : truth_) {
        sums[energy_class] = 0.0;
        sums[{energy_class.camera, energy_class.inside, 0}] = 0.0;
    }
    for (const Vpl& vpl : vpls) {
        for (std::size_t camera = 0; camera < films_.size(); ++camera) {
            expose(camera, vpl, sums);
        }
    }
    return sums;
}

std::map<EnergyClass, Expected> light_up_to(uint depth, const std::map<EnergyClass, Expected>& truth) {
    std::map<EnergyClass, Expected> sums;
    for (const auto& [energy_class, expected] : truth) {
        if (energy_class.depth <= depth) {
            Expected& sum = sums[{energy_class.camera, energy_class.inside, 0}];
            sum.mean += expected.mean;
            sum.error = std::hypot(sum.error, expected.error);
        }
    }
    return sums;
}

Verdict judge_energies(const std::vector<std::map<EnergyClass, double>>& photographs,
                       const std::map<EnergyClass, Expected>& truth) {
    Verdict verdict;
    const auto n = static_cast<double>(photographs.size());
    double worst = kFalseAlarm / static_cast<double>(truth.size());
    for (const auto& [energy_class, expected] : truth) {
        double sum = 0;
        double squares = 0;
        for (const auto& photograph : photographs) {
            sum += photograph.at(energy_class);
            squares += photograph.at(energy_class) * photograph.at(energy_class);
        }
        const double mean = sum / n;
        const double variance = std::max(0.0, squares / n - mean * mean) / (n - 1);
        const double error = std::hypot(std::sqrt(variance), expected.error);
        verdict.relative_error = std::max(verdict.relative_error, error / expected.mean);
        const double gap = mean - expected.mean;
        const bool differs = std::abs(gap) > 1e-5 * expected.mean;  // by more than rounding
        const double tail = !std::isfinite(gap) ? 0.0 : differs ? student_t_tail(gap / error, n - 1) : 1.0;
        if (tail < worst) {
            worst = tail;
            verdict.agrees = false;
            verdict.bias = mean / expected.mean - 1;
            verdict.reason = to_string(energy_class) + ": " + std::to_string(mean) + " instead of " +
                             std::to_string(expected.mean) + ", " + std::to_string(gap / error) +
                             " standard errors";
        }
    }
    return verdict;
}

}  // namespace nearlight::core::test
