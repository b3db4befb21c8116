// SPDX-License-Identifier: Apache-2.0
// Mattes of a picture: for each pixel, how much of it each object or material covers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/scene/scene_names.h"
#include "host/stages/first_surfaces.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// A pixel's matte has so many pairs of identifier and coverage, those of most coverage first.
inline constexpr std::size_t kMatteRanks = 6;
inline constexpr std::size_t kMatteChannels = 2 * kMatteRanks;

/// The samples of one pass, which are those of its picture.
struct MattePass {
    uint seed = 0;
    uint samples_per_pixel = 1;
    bool spread_single_samples = false;  ///< as in the pass's GatherSettings
};

/// Takes finished rows, from top to bottom: a multiple of width · kinds · kMatteChannels floats. Returns
/// false if it wants no more.
using MatteSink = std::function<bool(std::span<const float> rows)>;

/// Divides the rows of the window into bands in which one launch has room for all samples of the largest
/// pass, unless a single row has more.
std::vector<PixelWindow> matte_bands(const PixelWindow& window, std::span<const MattePass> passes);
/// The launches for the samples of one pass in a band.
std::vector<SampleBlock> sample_blocks(const PixelWindow& band, const MattePass& pass);

/// Counts the samples of pixels by what they see.
class MatteCounter {
  public:
    /// Keeps a reference to the scene.
    MatteCounter(const Scene& scene, std::span<const NamedKind> kinds);

    /// Begins pixels, without any sample.
    void begin(std::size_t pixel_count);
    /// Counts the samples of all pixels, pixel by pixel: the triangle that each of them sees, or ~0.
    void add(std::span<const uint> triangles);
    /// kMatteChannels floats for each kind of each pixel. Equal coverages are in the order of identifiers,
    /// and ranks without coverage are 0.
    [[nodiscard]] std::vector<float> rows() const;

  private:
    struct Share {
        std::uint32_t id;
        std::uint64_t samples;
    };
    struct Kind {
        TriangleNames names;
        std::vector<std::uint32_t> ids;            ///< bits of the identifier of each name
        std::vector<std::vector<Share>> pixels{};  ///< the first pixel_count_ are in use
    };

    static void count(std::uint32_t id, std::vector<Share>& shares);
    void add_ranks(std::vector<Share> shares, std::vector<float>& rows) const;

    std::vector<Kind> kinds_;
    std::size_t pixel_count_ = 0;
    std::uint64_t samples_ = 0;  ///< of each pixel, in all passes
};

}  // namespace nearlight::core
