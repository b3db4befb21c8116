// SPDX-License-Identifier: Apache-2.0
#include "host/session/pass_average.h"

#include <algorithm>

#include "host/session/relative_error.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kLightChannels = NEARLIGHT_CHANNELS_RGB;
constexpr std::size_t kRowChannels = NEARLIGHT_LAYER_CHANNELS;
/// The factor of the passes' own variances begins at 1, with the weight of this many spreads of two passes.
/// The spread of two passes over a picture is no exact measure, because pixels share the VPLs.
constexpr double kTrustInOwn = 1.0;

/// The index of colour channel `color` of a layer, in the row of a picture.
std::size_t row_channel(std::size_t layer, std::size_t color) {
    return color / kLightChannels * kRowChannels + layer + color % kLightChannels;
}

}  // namespace

PassAverage::PassAverage(uint width, uint height)
    : width_(width),
      row_size_(std::size_t{width} * kRowChannels),
      sums_(row_size_ * height),
      spread_(std::size_t{width} * height * kLightChannels),
      rows_(height) {}

void PassAverage::begin_pass(float weight) {
    end_ = 0;
    weight_ = weight;
}

void PassAverage::add_rows(std::span<const float> rows) {
    for (; !rows.empty(); rows = rows.subspan(row_size_)) {
        add_row(end_++, rows.first(row_size_));
    }
}

void PassAverage::add_row(std::size_t y, std::span<const float> values) {
    const auto rules = pass_rules();
    const std::span<float> sums = std::span(sums_).subspan(y * row_size_, row_size_);
    Row& row = rows_[y];
    if (row.passes == 0) {
        std::ranges::copy(values, sums.begin());
    } else {
        add_spread(y, values);
        const float first = row.passes == 1 ? row.weight : 1.0f;
        for (std::size_t i = 0; i < row_size_; ++i) {
            const PassRule rule = rules[i % rules.size()];
            if (rule == PassRule::mean) {
                sums[i] = sums[i] * first + values[i] * weight_;
            } else if (rule == PassRule::variance) {
                sums[i] = sums[i] * first * first + values[i] * weight_ * weight_;
            }
        }
    }
    ++row.passes;
    row.weight += weight_;
}

/// The update of weighted variances is that of West, Updating Mean and Variance Estimates, 1979.
void PassAverage::add_spread(std::size_t y, std::span<const float> values) {
    const Row& row = rows_[y];
    const float weight = weight_ * row.weight / (weight_ + row.weight);
    for (std::size_t c = 0; c < kLightChannels * width_; ++c) {
        const std::size_t i = row_channel(NEARLIGHT_LAYER_BEAUTY, c);
        const float difference = values[i] - mean_of(y, i);
        spread_[y * width_ * kLightChannels + c] += weight * difference * difference;
    }
}

/// The mean of an averaged channel, by its index in row `y`.
float PassAverage::mean_of(std::size_t y, std::size_t index) const {
    const float sum = sums_[y * row_size_ + index];
    return rows_[y].passes == 1 ? sum : sum * (1.0f / rows_[y].weight);
}

std::size_t PassAverage::reached_rows() const {
    return static_cast<std::size_t>(std::ranges::find(rows_, 0u, &Row::passes) - rows_.begin());
}

std::vector<float> PassAverage::beauty() const {
    std::vector<float> result;
    result.reserve(spread_.size());
    for (std::size_t y = 0; y < reached_rows(); ++y) {
        for (std::size_t c = 0; c < kLightChannels * width_; ++c) {
            result.push_back(mean_of(y, row_channel(NEARLIGHT_LAYER_BEAUTY, c)));
        }
    }
    return result;
}

/// The variance of the mean by the passes' own variances.
std::vector<float> PassAverage::own_variances() const {
    std::vector<float> result;
    result.reserve(spread_.size());
    for (std::size_t y = 0; y < reached_rows(); ++y) {
        const float scale = rows_[y].passes == 1 ? 1.0f : 1.0f / (rows_[y].weight * rows_[y].weight);
        for (std::size_t c = 0; c < kLightChannels * width_; ++c) {
            result.push_back(sums_[y * row_size_ + row_channel(NEARLIGHT_LAYER_VARIANCE, c)] * scale);
        }
    }
    return result;
}

/// The variance of the mean by the spread of the passes; 0 in rows that one pass has reached.
std::vector<float> PassAverage::spread_variances() const {
    const std::size_t row_size = kLightChannels * width_;
    std::vector<float> result(reached_rows() * row_size);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const Row& row = rows_[i / row_size];
        result[i] = row.passes > 1 ? spread_[i] / (static_cast<float>(row.passes - 1) * row.weight) : 0.0f;
    }
    return result;
}

std::vector<float> PassAverage::variances(std::span<const float> norms) const {
    std::vector<float> own = own_variances();
    const std::vector<float> spread = spread_variances();
    const std::size_t row_size = kLightChannels * width_;
    double known = 0.0;
    double own_sum = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const double others = rows_[i / row_size].passes - 1.0;
        if (norms[i] > 0.0f) {
            known += (others * double{spread[i]} + kTrustInOwn * double{own[i]}) / double{norms[i]};
            own_sum += (others + kTrustInOwn) * double{own[i]} / double{norms[i]};
        }
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
        const auto passes = static_cast<float>(rows_[i / row_size].passes);
        // Passes of one sample have no variance of their own.
        own[i] = own_sum > 0.0
                     ? (static_cast<float>(known / own_sum) * own[i] + (passes - 1.0f) * spread[i]) / passes
                     : spread[i];
    }
    return own;
}

double PassAverage::error() const {
    const std::vector<float> norms = error_norms(beauty(), width_);
    return relative_error(variances(norms), norms);
}

uint PassAverage::telling_passes() const {
    constexpr std::size_t kTellingPixels = 64;
    constexpr std::size_t kMaxTelling = 8;
    const std::size_t pixels = std::max<std::size_t>(std::size_t{width_} * rows_.size(), 1);
    return static_cast<uint>(std::clamp<std::size_t>(kTellingPixels / pixels, 1, kMaxTelling));
}

void PassAverage::send(const std::function<void(std::span<const float> rows)>& sink) const {
    const auto rules = pass_rules();
    const std::vector<float> variance = variances(error_norms(beauty(), width_));
    std::vector<float> row(row_size_);
    for (std::size_t y = 0; y < reached_rows(); ++y) {
        for (std::size_t i = 0; i < row_size_; ++i) {
            row[i] = rules[i % rules.size()] == PassRule::mean ? mean_of(y, i) : sums_[y * row_size_ + i];
        }
        for (std::size_t c = 0; c < kLightChannels * width_; ++c) {
            row[row_channel(NEARLIGHT_LAYER_VARIANCE, c)] = variance[y * kLightChannels * width_ + c];
        }
        sink(row);
    }
}

}  // namespace nearlight::core
