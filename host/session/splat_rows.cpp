// SPDX-License-Identifier: Apache-2.0
#include "host/session/splat_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/base/math.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kLayers = NEARLIGHT_LAYER_CHANNELS;

void add(RowSplat& sum, const RowSplat& more) {
    sum.all.direct += more.all.direct;
    sum.all.indirect += more.all.indirect;
    sum.all.half_light += more.all.half_light;
    sum.all.weight += more.all.weight;
    sum.all.half_weight += more.all.half_weight;
    sum.all.coverage += more.all.coverage;
    sum.camera.first += more.camera.first;
    sum.camera.second += more.camera.second;
    sum.camera.first_weight += more.camera.first_weight;
    sum.camera.second_weight += more.camera.second_weight;
}

/// Black where nothing counts, or where negative lobes of the filter take all of it away.
Vec3 mean_of(Vec3 sum, float weight) {
    return weight > 0.0f ? sum / weight : Vec3{0, 0, 0};
}

void store(Vec3 value, float* channels) {
    channels[0] = value.x;
    channels[1] = value.y;
    channels[2] = value.z;
}

/// The variance of the mean by how far apart the means of both halves of the samples lie, as film.cl has it.
Vec3 variance_of(const RowSplat& splat, uint samples) {
    const Splat& all = splat.all;
    const Vec3 second_sum = all.direct + all.indirect - all.half_light;
    const Vec3 first =
        mean_of(all.half_light, all.half_weight) + mean_of(splat.camera.first, splat.camera.first_weight);
    const Vec3 second = mean_of(second_sum, all.weight - all.half_weight) +
                        mean_of(splat.camera.second, splat.camera.second_weight);
    const Vec3 change = first - second;
    const auto in_first = static_cast<float>(samples / 2);
    const auto count = static_cast<float>(samples);
    const float share = NEARLIGHT_HALVES_TO_WHOLE * in_first * (count - in_first) / (count * count);
    return share * (change * change);
}

/// Writes the layers that have the weights of the filter: those of light, and the coverage.
void store_filtered(const RowSplat& splat, uint samples, float* pixel) {
    const Vec3 camera = mean_of(splat.camera.first + splat.camera.second,
                                splat.camera.first_weight + splat.camera.second_weight);
    const Vec3 direct = mean_of(splat.all.direct, splat.all.weight) + camera;
    const Vec3 indirect = mean_of(splat.all.indirect, splat.all.weight);
    store(direct + indirect, pixel + NEARLIGHT_LAYER_BEAUTY);
    store(direct, pixel + NEARLIGHT_LAYER_DIRECT);
    store(indirect, pixel + NEARLIGHT_LAYER_INDIRECT);
    store(variance_of(splat, samples), pixel + NEARLIGHT_LAYER_VARIANCE);
    // Negative lobes of a filter must not make pixels more than covered, or less than not at all.
    const float covered = splat.all.weight > 0.0f ? splat.all.coverage / splat.all.weight : 0.0f;
    pixel[NEARLIGHT_LAYER_ALPHA] = std::clamp(covered, 0.0f, 1.0f);
}

}  // namespace

uint splat_reach(const PixelFilter& filter, const GatherSettings& settings) {
    // How far from a pixel's edge, in pixels, samples count in it.
    const double beyond = filter.radius - 0.5;
    const bool is_possible = settings.splat && settings.samples_per_pixel >= kMinSplattedSamples &&
                             !is_pixel_box(filter) && beyond <= NEARLIGHT_MAX_SPLAT_REACH;
    return is_possible && beyond > 0.0 ? static_cast<uint>(std::ceil(beyond)) : 0;
}

std::size_t band_floats_per_pixel(uint reach) {
    return kLayers + (reach > 0 ? splat_rows(reach) * sizeof(RowSplat) / sizeof(float) : 0);
}

std::size_t SplatRows::row_count() const {
    return first_ + layers_.size() / (std::size_t{width_} * kLayers);
}

void SplatRows::take(std::vector<float>& band) {
    if (reach_ == 0) {
        return;
    }
    const std::size_t pixels = band.size() / band_floats_per_pixel(reach_);
    const auto layers_end = band.begin() + static_cast<std::ptrdiff_t>(pixels * kLayers);
    layers_.insert(layers_.end(), band.begin(), layers_end);
    const std::size_t kept = splats_.size();
    splats_.resize(kept + pixels * splat_rows(reach_));
    std::memcpy(splats_.data() + kept, band.data() + pixels * kLayers,
                pixels * splat_rows(reach_) * sizeof(RowSplat));
    band.clear();
    for (; next_ + reach_ < row_count(); ++next_) {
        finish_row(next_, band);
    }
    drop_rows();
}

std::vector<float> SplatRows::finish() {
    std::vector<float> finished;
    for (; next_ < row_count(); ++next_) {
        finish_row(next_, finished);
    }
    return finished;
}

void SplatRows::finish_row(std::size_t row, std::vector<float>& finished) {
    const std::size_t rows_of_splats = splat_rows(reach_);
    const std::size_t top = std::max(first_, row - std::min<std::size_t>(row, reach_));
    const std::size_t end = std::min(row_count(), row + reach_ + 1);
    const auto from = layers_.begin() + static_cast<std::ptrdiff_t>((row - first_) * width_ * kLayers);
    finished.insert(finished.end(), from, from + static_cast<std::ptrdiff_t>(width_ * kLayers));
    float* const pixels = finished.data() + finished.size() - width_ * kLayers;
    for (std::size_t x = 0; x < width_; ++x) {
        RowSplat sum{};
        for (std::size_t other = top; other < end; ++other) {
            const std::size_t pixel = (other - first_) * width_ + x;
            add(sum, splats_[pixel * rows_of_splats + (row + reach_ - other)]);
        }
        store_filtered(sum, samples_, pixels + x * kLayers);
    }
}

/// Forgets the rows that have splats for finished rows alone.
void SplatRows::drop_rows() {
    const std::size_t needed = next_ - std::min<std::size_t>(next_, reach_);
    const auto count = static_cast<std::ptrdiff_t>((needed - first_) * width_);
    layers_.erase(layers_.begin(), layers_.begin() + count * static_cast<std::ptrdiff_t>(kLayers));
    splats_.erase(splats_.begin(), splats_.begin() + count * static_cast<std::ptrdiff_t>(splat_rows(reach_)));
    first_ = needed;
}

}  // namespace nearlight::core
