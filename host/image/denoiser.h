// SPDX-License-Identifier: Apache-2.0
// Takes the noise out of rendered pictures with Open Image Denoise, which is looked for when it is first
// needed.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace nearlight::core {

/// One picture in memory, pixel after pixel and row after row. Each pointer is to the first of three floats
/// of the first pixel, and every further pixel lies `pixel_floats` floats behind.
struct DenoisingTask {
    int width = 0;
    int height = 0;
    std::size_t pixel_floats = 3;
    /// The parts of the picture's linear radiance, of any range, at least one. They are denoised one by one
    /// and added up.
    std::vector<const float*> light;
    const float* albedo = nullptr;  ///< [0, 1]
    const float* normal = nullptr;  ///< unit vectors; zero where there is no surface
    /// Of the sum of the light, as far as it is known, otherwise infinite. Where the denoiser changed more
    /// than that explains, the output keeps some of the light as it was (rendered_share.h). Without it,
    /// everything is denoised.
    const float* variance = nullptr;
    /// Takes the noise out of albedo and normals first, and takes the library's best filter instead of its
    /// fastest one.
    bool thorough = true;
    float* output = nullptr;  ///< denoised radiance; may be the same as a part of the light
};

class Denoiser {
  public:
    static constexpr int kMinSide = 16;  ///< pixels

    /// Finds the library and starts it on `threads` threads of the CPU, or on all of them if that is 0.
    /// Throws Error(ErrorKind::failure) as OidnLibrary does.
    explicit Denoiser(int threads = 0);
    ~Denoiser();
    Denoiser(Denoiser&&) noexcept;
    Denoiser& operator=(Denoiser&&) noexcept;

    /// The library's name and version: "Open Image Denoise 2.5.1".
    [[nodiscard]] std::string name() const;
    /// Denoises a picture. Light that is negative or not finite counts as black, and the output is finite.
    /// The light of a picture of less than kMinSide rows or columns stays as it is: the library darkens such
    /// pictures. Throws Error(ErrorKind::failure) if the library fails.
    void denoise(const DenoisingTask& task);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight::core
