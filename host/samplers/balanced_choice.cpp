// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/balanced_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nearlight::core {
namespace {

/// The ridge as a part of the mean square of a column. It keeps the least squares solvable if columns are
/// nearly alike.
constexpr double kRidge = 1e-4;
/// A probability closer to 0 or 1 than this is settled.
constexpr double kSettled = 1e-9;
/// The inverse is begun again after kExclusions exclusions, or when the square of a column exceeds kMaxGrowth
/// times the mean at the last beginning.
constexpr std::size_t kExclusions = 64;
constexpr double kMaxGrowth = 16.0;
/// Numbers beyond this are not used, because the sums of their squares might not be finite.
constexpr float kMaxNumber = 1e15f;

/// Moves row and column `from` to `to` and sets `from` to 0.
template <typename Matrix>
void move_slot(Matrix& matrix, std::size_t from, std::size_t to) {
    matrix[to] = matrix[from];
    matrix[from].fill(0);
    for (auto& row : matrix) {
        row[to] = row[from];
        row[from] = 0;
    }
}

}  // namespace

BalancedChoice::BalancedChoice(std::size_t row_length, double usual_length, Pcg32 random)
    : row_length_(row_length),
      count_weight_(static_cast<float>(std::min<double>(usual_length, kMaxNumber))),
      random_(random),
      columns_((row_length + 1) * kMaxOpen) {}

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
    const auto factor = static_cast<float>(open_.back().factor);
    for (std::size_t k = 0; k < row_length_; ++k) {
        const float number = row[k] * factor;
        columns_[k * kMaxOpen + slot] = std::abs(number) < kMaxNumber ? number : 0.0f;
    }
    columns_[row_length_ * kMaxOpen + slot] = count_weight_;
    add_products(slot);
    if (exclusions_ >= kExclusions || products_[slot][slot] > kMaxGrowth * usual_square_) {
        invert_again();
    } else {
        include(slot);
    }
    while (open_.size() == kMaxOpen) {
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

/// Computes the dot products of the column in `slot` with all columns, its own included. The inner loop
/// covers all slots, so that it becomes vector code.
void BalancedChoice::add_products(std::size_t slot) {
    std::array<float, kMaxOpen> sums{};
    for (std::size_t k = 0; k <= row_length_; ++k) {
        const float* numbers = columns_.data() + k * kMaxOpen;
        const float own = numbers[slot];
        for (std::size_t other = 0; other < kMaxOpen; ++other) {
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

/// The mean of the squared lengths of the open columns.
double BalancedChoice::mean_square() const {
    double sum = 0;
    for (std::size_t i = 0; i < open_.size(); ++i) {
        sum += products_[i][i];
    }
    return sum / static_cast<double>(open_.size());
}

/// Extends the inverse by the row and column of a slot (bordering).
void BalancedChoice::include(std::size_t slot) {
    Direction solution{};
    double projected = 0;
    for (std::size_t i = 0; i < kMaxOpen; ++i) {
        const double product = i == slot ? 0.0 : products_[slot][i];
        for (std::size_t k = 0; k < kMaxOpen; ++k) {
            solution[k] += product * inverse_[i][k];
        }
    }
    for (std::size_t i = 0; i < kMaxOpen; ++i) {
        projected += i == slot ? 0.0 : products_[slot][i] * solution[i];
    }
    // The pivot must stay above 0, whatever rounding did to the products, which are sums of floats.
    const double pivot = std::max(products_[slot][slot] + ridge_ - projected, 0.1 * ridge_);
    solution[slot] = -1.0;
    for (std::size_t i = 0; i < kMaxOpen; ++i) {
        for (std::size_t k = 0; k < kMaxOpen; ++k) {
            inverse_[i][k] += solution[i] / pivot * solution[k];
        }
    }
}

/// Removes the row and column of a slot from the inverse.
void BalancedChoice::exclude(std::size_t slot) {
    const Direction row = inverse_[slot];
    for (std::size_t i = 0; i < kMaxOpen; ++i) {
        for (std::size_t k = 0; k < kMaxOpen; ++k) {
            inverse_[i][k] -= row[i] / row[slot] * row[k];
        }
    }
    inverse_[slot].fill(0);
    for (Direction& other : inverse_) {
        other[slot] = 0;
    }
    ++exclusions_;
}

/// Begins the inverse again, with a ridge that suits the present columns and without accumulated rounding
/// errors.
void BalancedChoice::invert_again() {
    usual_square_ = mean_square();
    ridge_ = usual_square_ > 0 ? kRidge * usual_square_ : 1.0;
    inverse_ = {};
    exclusions_ = 0;
    for (std::size_t slot = 0; slot < open_.size(); ++slot) {
        include(slot);
    }
}

/// Finds how far the walk can go along `direction` if `sign` is 1, or against it if `sign` is −1.
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

/// Takes one step of the walk, whose expectation is 0, so that each candidate keeps its probability. The
/// direction moves the oldest candidate, so that open candidates stay near each other, and changes the
/// balance least: products · direction is 1 in that slot and 0 elsewhere.
void BalancedChoice::settle_one() {
    const Direction direction = inverse_[oldest()];
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

/// Removes a settled candidate; the last open candidate takes its slot.
void BalancedChoice::settle(std::size_t slot, bool drawn) {
    if (drawn) {
        drawn_.emplace_back(open_[slot].index, static_cast<float>(open_[slot].factor));
    }
    exclude(slot);
    const std::size_t last = open_.size() - 1;
    if (slot != last) {
        open_[slot] = open_[last];
        for (std::size_t k = 0; k <= row_length_; ++k) {
            columns_[k * kMaxOpen + slot] = columns_[k * kMaxOpen + last];
        }
        move_slot(products_, last, slot);
        move_slot(inverse_, last, slot);
    }
    open_.pop_back();
}

}  // namespace nearlight::core
