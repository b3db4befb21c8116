// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/balanced_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nearlight {
namespace {

/// Of the mean square of a column: keeps the least squares solvable where columns are nearly alike.
constexpr double kRidge = 1e-4;
/// Nearer to 0 or 1 than this is there.
constexpr double kSettled = 1e-9;

}  // namespace

BalancedChoice::BalancedChoice(std::size_t row_length, double usual_length, Pcg32 random)
    : row_length_(row_length),
      count_weight_(static_cast<float>(usual_length)),
      random_(random),
      columns_((row_length + 1) * kMostOpen) {}

void BalancedChoice::offer(uint index, double probability, std::span<const float> row) {
    if (!(probability > 0)) {
        return;
    }
    if (probability >= 1) {
        drawn_.emplace_back(index, 1.0f);
        return;
    }
    const std::size_t slot = open_.size();
    open_.push_back({index, probability, 1.0 / probability, arrivals_++});
    for (std::size_t k = 0; k < row_length_; ++k) {
        const auto number = static_cast<float>(row[k] / probability);
        columns_[k * kMostOpen + slot] = std::isfinite(number) ? number : 0.0f;
    }
    columns_[row_length_ * kMostOpen + slot] = count_weight_;
    add_products(slot);
    while (open_.size() == kMostOpen) {
        settle_one();
    }
}

Choice BalancedChoice::finish() {
    while (!open_.empty()) {
        settle_one();
    }
    std::ranges::sort(drawn_);
    Choice choice;
    for (const auto& [index, factor] : drawn_) {
        choice.indices.push_back(index);
        choice.factors.push_back(factor);
    }
    drawn_.clear();
    return choice;
}

/// Of the column in `slot` with all, itself among them; all slots at once, which makes vector code.
void BalancedChoice::add_products(std::size_t slot) {
    std::array<float, kMostOpen> sums{};
    for (std::size_t k = 0; k <= row_length_; ++k) {
        const float* numbers = columns_.data() + k * kMostOpen;
        const float own = numbers[slot];
        for (std::size_t other = 0; other < kMostOpen; ++other) {
            sums[other] += own * numbers[other];
        }
    }
    for (std::size_t other = 0; other <= slot; ++other) {
        products_[slot][other] = products_[other][slot] = sums[other];
    }
}

std::size_t BalancedChoice::oldest() const {
    return static_cast<std::size_t>(std::ranges::min_element(open_, {}, &Open::arrival) - open_.begin());
}

/// The direction that moves the oldest and changes the balance least: products · direction = 1 there, 0
/// elsewhere, by Cholesky's decomposition. (The oldest is to go, so that the open ones stay near each other.)
BalancedChoice::Direction BalancedChoice::least_change() const {
    const std::size_t count = open_.size();
    double mean_square = 0;
    for (std::size_t i = 0; i < count; ++i) {
        mean_square += products_[i][i] / static_cast<double>(count);
    }
    const double ridge = mean_square > 0 ? kRidge * mean_square : 1.0;
    auto root = products_;  // row by row, upper triangle: rootᵀ · root = products + ridge
    Direction direction{};
    direction[oldest()] = 1.0;
    for (std::size_t i = 0; i < count; ++i) {
        // Rounding (products are sums of floats) must not make a root of what is not above 0.
        const double pivot = std::sqrt(std::max(root[i][i] + ridge, 0.1 * ridge));
        root[i][i] = pivot;
        direction[i] /= pivot;
        for (std::size_t j = i + 1; j < count; ++j) {
            root[i][j] /= pivot;
            direction[j] -= root[i][j] * direction[i];
        }
        for (std::size_t j = i + 1; j < count; ++j) {
            for (std::size_t k = j; k < count; ++k) {
                root[j][k] -= root[i][j] * root[i][k];
            }
        }
    }
    for (std::size_t i = count; i-- > 0;) {
        for (std::size_t j = i + 1; j < count; ++j) {
            direction[i] -= root[i][j] * direction[j];
        }
        direction[i] /= root[i][i];
    }
    return direction;
}

/// `sign` 1: along the direction; −1: the other way.
BalancedChoice::Limit BalancedChoice::limit(const Direction& direction, double sign) const {
    Limit nearest{.step = std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < open_.size(); ++i) {
        const double slope = sign * direction[i];
        const double end = slope > 0 ? 1.0 : 0.0;
        const double step = (end - open_[i].probability) / slope;
        if (slope != 0 && step < nearest.step) {
            nearest = {step, i, end};
        }
    }
    return nearest;
}

/// One step of the walk. Its expectation is no step at all, so that each keeps its probability.
void BalancedChoice::settle_one() {
    const Direction direction = least_change();
    const Limit ahead = limit(direction, 1.0);
    const Limit behind = limit(direction, -1.0);
    const bool go_ahead = random_.uniform() * (ahead.step + behind.step) < behind.step;
    const Limit& taken = go_ahead ? ahead : behind;
    const double step = go_ahead ? ahead.step : -behind.step;
    for (std::size_t i = 0; i < open_.size(); ++i) {
        open_[i].probability += step * direction[i];
    }
    open_[taken.who].probability = taken.probability;
    for (std::size_t i = open_.size(); i-- > 0;) {
        const double probability = open_[i].probability;
        if (probability < kSettled || probability > 1.0 - kSettled) {
            settle(i, probability > 0.5);
        }
    }
}

/// The last of the open ones takes its place.
void BalancedChoice::settle(std::size_t slot, bool drawn) {
    if (drawn) {
        drawn_.emplace_back(open_[slot].index, static_cast<float>(open_[slot].factor));
    }
    const std::size_t last = open_.size() - 1;
    if (slot != last) {
        open_[slot] = open_[last];
        for (std::size_t k = 0; k <= row_length_; ++k) {
            columns_[k * kMostOpen + slot] = columns_[k * kMostOpen + last];
        }
        const double square = products_[last][last];
        for (std::size_t other = 0; other < last; ++other) {
            products_[slot][other] = products_[other][slot] = products_[last][other];
        }
        products_[slot][slot] = square;
    }
    open_.pop_back();
}

}  // namespace nearlight
