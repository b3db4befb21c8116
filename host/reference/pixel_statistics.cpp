// SPDX-License-Identifier: Apache-2.0
#include "host/reference/pixel_statistics.h"

#include <limits>

namespace nearlight {
namespace {

void add_square(Double3& sum, const Double3& a, const Double3& b, int divisor) {
    const auto square = [divisor](double value) { return value / divisor * (value / divisor); };
    sum.add(Double3{square(a.x + b.x), square(a.y + b.y), square(a.z + b.z)});
}

/// Of the mean of `batches` equally large batches whose means sum to `sum`.
float variance_of_mean(double sum, double square_sum, int batches) {
    if (batches < 2) {
        return std::numeric_limits<float>::infinity();
    }
    const double excess = std::max(0.0, square_sum - sum * sum / batches);
    return static_cast<float>(excess / (double(batches) * (batches - 1)));
}

/// Writes channels one after the other.
class ChannelWriter {
  public:
    explicit ChannelWriter(float* values) : values_(values) {}
    void number(double value) { *values_++ = static_cast<float>(value); }
    void mean(const Double3& sum, int count) {
        const double scale = count > 0 ? 1.0 / count : 0.0;
        number(sum.x * scale);
        number(sum.y * scale);
        number(sum.z * scale);
    }
    void variance(const Double3& sum, const Double3& square_sum, double batch_size, int batches) {
        number(variance_of_mean(sum.x / batch_size, square_sum.x, batches));
        number(variance_of_mean(sum.y / batch_size, square_sum.y, batches));
        number(variance_of_mean(sum.z / batch_size, square_sum.z, batches));
    }

  private:
    float* values_;
};

void write_pixel(const PixelStatistics& pixel, float* values) {
    const BatchSum& sum = pixel.sum;
    Double3 beauty = sum.direct;
    beauty.add(sum.indirect);
    const double batch_size = pixel.batches > 0 ? double(pixel.samples) / pixel.batches : 1.0;
    ChannelWriter out(values);
    out.mean(beauty, pixel.samples);
    out.mean(sum.direct, pixel.samples);
    out.mean(sum.indirect, pixel.samples);
    out.mean(sum.albedo, pixel.samples);
    out.mean(sum.normal, sum.receivers);
    out.mean(sum.position, sum.receivers);
    out.number(sum.surfaces > 0 ? sum.depth / sum.surfaces : 0.0);
    out.variance(beauty, pixel.beauty_square, batch_size, pixel.batches);
    out.variance(sum.indirect, pixel.indirect_square, batch_size, pixel.batches);
}

}  // namespace

void BatchSum::add(Vec3 direct_light, Vec3 indirect_light, const CameraPath& path) {
    direct.add(direct_light);
    indirect.add(indirect_light);
    if (path.depth > 0.0f) {
        depth += path.depth;
        ++surfaces;
    }
    if (path.has_receiver) {
        albedo.add(path.throughput * path.receiver.albedo);
        normal.add(path.receiver.normal);
        position.add(path.receiver.position);
        ++receivers;
    }
}

void PixelStatistics::add(const BatchSum& batch, int batch_size) {
    sum.direct.add(batch.direct);
    sum.indirect.add(batch.indirect);
    sum.albedo.add(batch.albedo);
    sum.normal.add(batch.normal);
    sum.position.add(batch.position);
    sum.depth += batch.depth;
    sum.receivers += batch.receivers;
    sum.surfaces += batch.surfaces;
    add_square(beauty_square, batch.direct, batch.indirect, batch_size);
    add_square(indirect_square, batch.indirect, {}, batch_size);
    samples += batch_size;
    ++batches;
}

Image to_image(std::span<const PixelStatistics> pixels, int width, int height) {
    Image image = make_image(width, height,
                             {"R",
                              "G",
                              "B",
                              "direct.R",
                              "direct.G",
                              "direct.B",
                              "indirect.R",
                              "indirect.G",
                              "indirect.B",
                              "albedo.R",
                              "albedo.G",
                              "albedo.B",
                              "N.X",
                              "N.Y",
                              "N.Z",
                              "P.X",
                              "P.Y",
                              "P.Z",
                              "depth.Z",
                              "variance.R",
                              "variance.G",
                              "variance.B",
                              "indirectVariance.R",
                              "indirectVariance.G",
                              "indirectVariance.B"});
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        write_pixel(pixels[i], &image.values[i * image.channel_count()]);
    }
    return image;
}

}  // namespace nearlight
