// SPDX-License-Identifier: Apache-2.0
#include "host/scene/pixel_filter.h"
#include "host/base/words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace nearlight::core {
namespace {

struct FilterEntry {
    FilterKind kind;
    const char* name;
    double radius, b, c;
};

constexpr double kThird = 1.0 / 3.0;
constexpr std::array kFilters{
    FilterEntry{FilterKind::box, "box", 0.5, 0, 0},
    FilterEntry{FilterKind::tent, "tent", 1.0, 0, 0},
    FilterEntry{FilterKind::gaussian, "gaussian", 2.0, 0, 0},
    FilterEntry{FilterKind::mitchell, "mitchell", 2.0, kThird, kThird},
    FilterEntry{FilterKind::catmull_rom, "catmullrom", 2.0, 0, 0.5},
    FilterEntry{FilterKind::lanczos, "lanczos", 3.0, 0, 0},
};

const FilterEntry& filter_entry(FilterKind kind) {
    return *std::ranges::find(kFilters, kind, &FilterEntry::kind);
}

/// The Gaussian with a standard deviation of a quarter of its radius, lowered to 0 at the radius.
double gaussian(double x, double radius) {
    const double deviations = 4.0 * x / radius;
    return std::exp(-0.5 * deviations * deviations) - std::exp(-8.0);
}

/// The piecewise cubic of [Mitchell & Netravali, Reconstruction Filters in Computer Graphics, 1988, eq. 8].
double cubic(double x, double b, double c) {
    if (x < 1.0) {
        return (((12 - 9 * b - 6 * c) * x + (-18 + 12 * b + 6 * c)) * x * x + (6 - 2 * b)) / 6.0;
    }
    return (((-b - 6 * c) * x + (6 * b + 30 * c)) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6.0;
}

double sinc(double x) {
    const double angle = std::numbers::pi * x;
    return angle < 1e-9 ? 1.0 : std::sin(angle) / angle;
}

}  // namespace

PixelFilter default_filter(FilterKind kind) {
    const FilterEntry& entry = filter_entry(kind);
    return {.kind = kind, .radius = entry.radius, .b = entry.b, .c = entry.c};
}

bool is_pixel_box(const PixelFilter& filter) {
    return filter.kind == FilterKind::box && filter.radius == 0.5;
}

double filter_value(const PixelFilter& filter, double x) {
    x = std::abs(x);
    if (x >= filter.radius) {
        return 0.0;
    }
    switch (filter.kind) {
        case FilterKind::box:
            return 1.0;
        case FilterKind::tent:
            return 1.0 - x / filter.radius;
        case FilterKind::gaussian:
            return gaussian(x, filter.radius);
        case FilterKind::mitchell:
        case FilterKind::catmull_rom:
            return cubic(x, filter.b, filter.c);
        case FilterKind::lanczos:
            return sinc(x) * sinc(x / filter.radius);
    }
    return 0.0;
}

std::string to_string(FilterKind kind) {
    return filter_entry(kind).name;
}

std::optional<FilterKind> filter_kind(const std::string& name) {
    const auto* const found = std::ranges::find(kFilters, name, &FilterEntry::name);
    return found == kFilters.end() ? std::nullopt : std::optional(found->kind);
}

std::string filter_names() {
    return joined(kFilters, ", ", &FilterEntry::name);
}

void fill_filter_tables(const PixelFilter& filter, std::span<float> absolute, std::span<float> with_sign) {
    constexpr int kSteps = 64;  // of the midpoint rule within a cell
    const double cell = filter.radius / static_cast<double>(absolute.size() - 1);
    double sum = 0.0;
    double absolute_sum = 0.0;
    absolute[0] = with_sign[0] = 0.0f;
    for (std::size_t i = 1; i < absolute.size(); ++i) {
        double value = 0.0;
        for (int step = 0; step < kSteps; ++step) {
            value += filter_value(filter, (static_cast<double>(i - 1) + (step + 0.5) / kSteps) * cell);
        }
        sum += value * cell / kSteps;
        absolute_sum += std::abs(value) * cell / kSteps;
        with_sign[i] = static_cast<float>(sum);
        absolute[i] = static_cast<float>(absolute_sum);
    }
}

}  // namespace nearlight::core
