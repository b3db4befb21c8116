// SPDX-License-Identifier: Apache-2.0
#include "tests/session/convergence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/student_t.h"
#include "host/reference/path_tracer.h"

namespace nearlight::core::test {
namespace {

constexpr std::array<const char*, 3> kColors{".R", ".G", ".B"};
constexpr int kTests = 5;
constexpr int kPoolBlocks = 4;

double square(double x) {
    return x * x;
}

/// Means of a layer over a grid of blocks × blocks, for its three channels one after the other.
std::vector<double> block_means(const Image& image, const std::string& layer, int blocks_x, int blocks_y) {
    const int width = image.width / blocks_x;
    const int height = image.height / blocks_y;
    std::vector<double> means;
    for (const char* color : kColors) {
        const auto channel = static_cast<std::size_t>(image.find_channel(layer + color));
        for (int block = 0; block < blocks_x * blocks_y; ++block) {
            double sum = 0;
            for (int y = block / blocks_x * height; y < (block / blocks_x + 1) * height; ++y) {
                for (int x = block % blocks_x * width; x < (block % blocks_x + 1) * width; ++x) {
                    sum += image.at(x, y, channel);
                }
            }
            means.push_back(sum / (double(width) * height));
        }
    }
    return means;
}

/// A mean over renders and the expected value, with their variances.
struct Comparison {
    std::vector<std::vector<double>> renders;  ///< [render][cell]
    std::vector<double> mean, variance;        ///< of the mean over renders
    std::vector<double> expected, expected_variance;
    double render_freedom = 0;
    double truth_freedom = 0;

    [[nodiscard]] double error(std::size_t cell) const {
        return std::sqrt(variance[cell] + expected_variance[cell]);
    }
    [[nodiscard]] double deviation(std::size_t cell) const {
        const double gap = mean[cell] - expected[cell];
        // This is for rounding, because both sides sum in single precision.
        const double rounding = 1e-5 * std::abs(expected[cell]);
        return std::copysign(std::max(0.0, std::abs(gap) - rounding), gap);
    }
    /// Degrees of freedom of the difference [Welch 1947, Satterthwaite 1946].
    [[nodiscard]] double freedom(std::size_t cell) const {
        const double a = variance[cell];
        const double b = expected_variance[cell];
        const double total = a + b;
        return total > 0 ? total * total / (a * a / render_freedom + b * b / truth_freedom) : render_freedom;
    }
    /// Probability that chance alone causes such a deviation; 0 if a value is not a number.
    [[nodiscard]] double tail(std::size_t cell) const {
        if (!std::isfinite(mean[cell])) {
            return 0.0;
        }
        const double gap = deviation(cell);
        // Below four standard errors, as in most cells, the probability is too large to matter.
        return std::abs(gap) <= 4.0 * error(cell) ? 1.0 : student_t_tail(gap / error(cell), freedom(cell));
    }
};

double batches_of(const Image& truth) {
    const int samples =
        static_cast<int>(truth.at(0, 0, static_cast<std::size_t>(truth.find_channel("count.X"))));
    return double(samples) / samples_per_batch(samples);
}

Comparison compare(std::span<const Image> renders, const Image& truth, const std::string& layer, int blocks_x,
                   int blocks_y) {
    Comparison result;
    const auto count = static_cast<double>(renders.size());
    result.render_freedom = count - 1;
    result.truth_freedom = batches_of(truth) - 1;
    result.expected = block_means(truth, layer, blocks_x, blocks_y);
    result.expected_variance =
        block_means(truth, layer == "indirect" ? "indirectVariance" : "variance", blocks_x, blocks_y);
    const double pixels_per_block = double(truth.width / blocks_x) * (truth.height / blocks_y);
    for (double& variance : result.expected_variance) {
        variance /= pixels_per_block;
    }
    for (const Image& image : renders) {
        result.renders.push_back(block_means(image, layer, blocks_x, blocks_y));
    }
    for (std::size_t cell = 0; cell < result.expected.size(); ++cell) {
        double sum = 0;
        for (const auto& values : result.renders) {
            sum += values[cell];
        }
        const double mean = sum / count;
        double squares = 0;
        for (const auto& values : result.renders) {
            squares += square(values[cell] - mean);
        }
        result.mean.push_back(mean);
        result.variance.push_back(squares / (count * (count - 1)));
    }
    return result;
}

/// The variance of a pixel, but at least the mean of its block, because a pixel's own sample variance is far
/// too small if the rare bright samples of a long-tailed distribution are missing.
std::vector<double> steady_variances(const std::vector<double>& own, int width, int height) {
    const int block_width = width / kPoolBlocks;
    const int block_height = height / kPoolBlocks;
    std::vector<double> blocks(kColors.size() * kPoolBlocks * kPoolBlocks);
    const auto block_of = [&](std::size_t cell) {
        const auto plane = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        const auto x = static_cast<int>(cell % static_cast<std::size_t>(width)) / block_width;
        const auto y = static_cast<int>(cell % plane) / width / block_height;
        return (cell / plane * kPoolBlocks + static_cast<std::size_t>(y)) * kPoolBlocks +
               static_cast<std::size_t>(x);
    };
    for (std::size_t cell = 0; cell < own.size(); ++cell) {
        blocks[block_of(cell)] += own[cell] / (double(block_width) * block_height);
    }
    std::vector<double> steady;
    for (std::size_t cell = 0; cell < own.size(); ++cell) {
        steady.push_back(std::max(own[cell], blocks[block_of(cell)]));
    }
    return steady;
}

void reject(Verdict& verdict, const std::string& reason) {
    verdict.agrees = false;
    verdict.reason += (verdict.reason.empty() ? "" : "; ") + reason;
}

/// The verdict on all cells; the least probable one decides.
void judge_cells(const Comparison& cells, const std::string& name, Verdict& verdict) {
    const std::size_t count = cells.mean.size();
    std::size_t worst = 0;
    for (std::size_t cell = 1; cell < count; ++cell) {
        worst = cells.tail(cell) < cells.tail(worst) ? cell : worst;
    }
    if (cells.tail(worst) * static_cast<double>(count) < kFalseAlarm / kTests) {
        const std::size_t per_channel = count / kColors.size();
        reject(verdict, name + " " + std::to_string(worst % per_channel) + kColors[worst / per_channel] +
                            ": " + std::to_string(cells.mean[worst]) + " instead of " +
                            std::to_string(cells.expected[worst]) + ", " +
                            std::to_string(cells.deviation(worst) / cells.error(worst)) + " standard errors");
    }
}

/// Mean of z² − 1 over all pixels, and its spread without bias. z is in units of the variances of `steady`,
/// and the subtracted expectation follows from the pixels' own variances, which are unbiased.
void judge_mean_square(const Comparison& pixels, const Comparison& steady, Verdict& verdict) {
    const std::size_t renders = pixels.renders.size();
    const std::size_t cells = pixels.mean.size();
    std::vector<double> weights(cells);
    double excess = 0;
    double truth_spread = 0;  // variance of the excess due to the truth's noise
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const double total = square(steady.error(cell));
        if (!(total > 1e-12 * square(pixels.expected[cell]))) {
            continue;  // exact on both sides, so the test of pixels judges it
        }
        weights[cell] = 1.0 / total;
        excess += (square(pixels.deviation(cell)) - square(pixels.error(cell))) / total;
        const double truth = steady.expected_variance[cell] / total;
        truth_spread += 2.0 * square(truth) + 4.0 * truth * (1.0 - truth);
    }
    double squared_products = 0;
    for (std::size_t j = 0; j < renders; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
            double product = 0;
            for (std::size_t cell = 0; cell < cells; ++cell) {
                product += weights[cell] * (pixels.renders[j][cell] - pixels.mean[cell]) *
                           (pixels.renders[k][cell] - pixels.mean[cell]);
            }
            squared_products += square(product);
        }
    }
    const double n = static_cast<double>(renders);
    const double pair_mean = squared_products / (0.5 * n * (n - 1));
    // There are n·(n − 1) products, in equal pairs.
    const double spread = std::sqrt(2.0 * pair_mean / (n * (n - 1)) + truth_spread);
    const double t = student_t_quantile(kFalseAlarm / kTests, n - 1);
    const double bound = (t * t - 1.0) / std::numbers::sqrt2;
    const double count = static_cast<double>(cells);
    if (excess > bound * spread) {
        reject(verdict, "mean z² of the pixels is above what noise makes it by " +
                            std::to_string(excess / count) + "; at most " +
                            std::to_string(bound * spread / count) + " is chance");
    }
}

}  // namespace

Verdict judge_convergence(std::span<const Image> renders, const Image& truth, const std::string& layer) {
    Verdict verdict;
    const Comparison whole = compare(renders, truth, layer, 1, 1);
    const double expected = whole.expected[0] + whole.expected[1] + whole.expected[2];
    verdict.relative_error = (whole.error(0) + whole.error(1) + whole.error(2)) / expected;
    verdict.bias = (whole.mean[0] + whole.mean[1] + whole.mean[2]) / expected - 1;
    judge_cells(whole, "picture", verdict);
    judge_cells(compare(renders, truth, layer, 4, 4), "block of 4 × 4", verdict);
    judge_cells(compare(renders, truth, layer, 8, 8), "block of 8 × 8", verdict);
    const Comparison pixels = compare(renders, truth, layer, truth.width, truth.height);
    Comparison steady = pixels;
    steady.variance = steady_variances(pixels.variance, truth.width, truth.height);
    steady.expected_variance = steady_variances(pixels.expected_variance, truth.width, truth.height);
    judge_cells(steady, "pixel", verdict);
    judge_mean_square(pixels, steady, verdict);
    return verdict;
}

}  // namespace nearlight::core::test
