// SPDX-License-Identifier: Apache-2.0
#include "host/session/mattes.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "host/base/cryptomatte_id.h"
#include "host/stages/camera_pass.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kSamplesPerLaunch = std::size_t{1} << 19u;

}  // namespace

std::vector<PixelWindow> matte_bands(const PixelWindow& window, std::span<const MattePass> passes) {
    std::size_t samples = 1;  // of a pixel, in the largest pass
    for (const MattePass& pass : passes) {
        samples = std::max<std::size_t>(samples, pass.samples_per_pixel);
    }
    const std::size_t fitting = kSamplesPerLaunch / (samples * std::max(window.width, 1u));
    const auto rows = static_cast<uint>(std::clamp<std::size_t>(fitting, 1, std::max(window.height, 1u)));
    std::vector<PixelWindow> bands;
    for (uint row = 0; row < window.height; row += rows) {
        bands.push_back({window.x, window.y + row, window.width, std::min(rows, window.height - row)});
    }
    return bands;
}

std::vector<SampleBlock> sample_blocks(const PixelWindow& band, const MattePass& pass) {
    const std::size_t pixels = std::size_t{band.width} * band.height;
    const auto together = static_cast<uint>(
        std::clamp<std::size_t>(kSamplesPerLaunch / pixels, 1, std::max(pass.samples_per_pixel, 1u)));
    std::vector<SampleBlock> blocks;
    for (uint first = 0; first < pass.samples_per_pixel; first += together) {
        blocks.push_back({.first_column = band.x,
                          .first_row = band.y,
                          .width = band.width,
                          .row_count = band.height,
                          .first_sample = first,
                          .sample_count = std::min(together, pass.samples_per_pixel - first),
                          .in_middle = are_in_middle(pass.samples_per_pixel, pass.spread_single_samples)});
    }
    return blocks;
}

MatteCounter::MatteCounter(const Scene& scene, std::span<const NamedKind> kinds) {
    for (const NamedKind kind : kinds) {
        Kind counted{.names = TriangleNames(scene, kind), .ids = {}};
        for (std::size_t i = 0; i < counted.names.count(); ++i) {
            counted.ids.push_back(cryptomatte_id(counted.names.name(i)));
        }
        kinds_.push_back(std::move(counted));
    }
}

void MatteCounter::begin(std::size_t pixel_count) {
    pixel_count_ = pixel_count;
    samples_ = 0;
    for (Kind& kind : kinds_) {
        kind.pixels.resize(std::max(kind.pixels.size(), pixel_count));
        for (std::vector<Share>& shares : kind.pixels) {
            shares.clear();
        }
    }
}

void MatteCounter::count(std::uint32_t id, std::vector<Share>& shares) {
    const auto known = std::ranges::find(shares, id, &Share::id);
    if (known != shares.end()) {
        ++known->samples;
    } else {
        shares.push_back({id, 1});
    }
}

void MatteCounter::add(std::span<const uint> triangles) {
    const std::size_t samples = triangles.size() / pixel_count_;
    samples_ += samples;
    for (Kind& kind : kinds_) {
        uint last = ~0u;
        std::uint32_t id = 0;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            if (triangles[i] == ~0u) {
                continue;
            }
            if (triangles[i] != last) {
                last = triangles[i];
                id = kind.ids[kind.names.number_of(last)];
            }
            count(id, kind.pixels[i / samples]);
        }
    }
}

void MatteCounter::add_ranks(std::vector<Share> shares, std::vector<float>& rows) const {
    std::ranges::sort(shares, {}, [](const Share& share) { return std::tuple(~share.samples, share.id); });
    shares.resize(kMatteRanks, Share{0, 0});
    for (const Share& share : shares) {
        rows.push_back(std::bit_cast<float>(share.id));
        rows.push_back(static_cast<float>(share.samples) / static_cast<float>(samples_));
    }
}

std::vector<float> MatteCounter::rows() const {
    std::vector<float> rows;
    rows.reserve(pixel_count_ * kinds_.size() * kMatteChannels);
    for (std::size_t pixel = 0; pixel < pixel_count_; ++pixel) {
        for (const Kind& kind : kinds_) {
            add_ranks(kind.pixels[pixel], rows);
        }
    }
    return rows;
}

}  // namespace nearlight::core
