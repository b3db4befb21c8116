// SPDX-License-Identifier: Apache-2.0
#include "host/reference/pixel_statistics.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

void add_square(VectorSum& sum, const VectorSum& a, const VectorSum& b, int divisor) {
    const auto square = [divisor](double value) { return value / divisor * (value / divisor); };
    sum.add(VectorSum{square(a.x + b.x), square(a.y + b.y), square(a.z + b.z)});
}

/// Variance of the mean of `batches` batches of equal size, from the sums of the batches' means and of their
/// squares.
float variance_of_mean(double sum, double square_sum, int batches) {
    if (batches < 2) {
        return std::numeric_limits<float>::infinity();
    }
    const double excess = std::max(0.0, square_sum - sum * sum / batches);
    return static_cast<float>(excess / (double(batches) * (batches - 1)));
}

/// Writes the values of a pixel's channels one after the other.
class ChannelWriter {
  public:
    explicit ChannelWriter(float* values) : values_(values) {}
    void number(double value) { *values_++ = static_cast<float>(value); }
    void mean(const VectorSum& sum, int count) {
        const double scale = count > 0 ? 1.0 / count : 0.0;
        number(sum.x * scale);
        number(sum.y * scale);
        number(sum.z * scale);
    }
    void variance(const VectorSum& sum, const VectorSum& square_sum, double batch_size, int batches) {
        number(variance_of_mean(sum.x / batch_size, square_sum.x, batches));
        number(variance_of_mean(sum.y / batch_size, square_sum.y, batches));
        number(variance_of_mean(sum.z / batch_size, square_sum.z, batches));
    }

  private:
    float* values_;
};

void write_pixel(const PixelStatistics& pixel, float* values) {
    const BatchSum& sum = pixel.sum;
    VectorSum beauty = sum.direct;
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
    out.number(pixel.samples);
    out.number(sum.receivers);
    out.number(sum.surfaces);
}

std::vector<std::string> channel_names() {
    std::vector<std::string> names{"R", "G", "B"};
    for (const char* layer : {"direct", "indirect", "albedo"}) {
        for (const char* color : {".R", ".G", ".B"}) {
            names.push_back(std::string(layer) + color);
        }
    }
    names.insert(names.end(), {"N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "depth.Z"});
    for (const char* layer : {"variance", "indirectVariance"}) {
        for (const char* color : {".R", ".G", ".B"}) {
            names.push_back(std::string(layer) + color);
        }
    }
    names.insert(names.end(), {"count.X", "count.Y", "count.Z"});
    return names;
}

/// The index in channel_names() of the first channel of each layer.
enum Place : std::size_t {
    kDirect = 3,
    kIndirect = 6,
    kAlbedo = 9,
    kNormal = 12,
    kPosition = 15,
    kDepth = 18,
    kVariance = 19,
    kIndirectVariance = 22,
    kSamples = 25,
    kReceivers,
    kSurfaces,
};

/// Reads values by channel name, in whatever order the file stores the channels.
class ChannelReader {
  public:
    explicit ChannelReader(const Image& image) : image_(image) {
        for (const std::string& name : channel_names()) {
            const int index = image.find_channel(name);
            if (index < 0) {
                throw Error(ErrorKind::file, "the picture to continue has no channel '" + name + "'");
            }
            indices_.push_back(static_cast<std::size_t>(index));
        }
    }
    /// The value of the channel that channel_names() has at `place`.
    [[nodiscard]] double number(std::size_t pixel, std::size_t place) const {
        return image_.values[pixel * image_.channel_count() + indices_[place]];
    }
    [[nodiscard]] VectorSum sum(std::size_t pixel, std::size_t place, double count) const {
        return {number(pixel, place) * count, number(pixel, place + 1) * count,
                number(pixel, place + 2) * count};
    }

  private:
    const Image& image_;
    std::vector<std::size_t> indices_;
};

/// The sum of squares for which variance_of_mean() returns `variance`.
double square_sum(double sum, double variance, int batches) {
    if (batches == 0) {
        return 0.0;
    }
    const double mean_part = sum * sum / batches;
    return batches < 2 ? mean_part : variance * double(batches) * (batches - 1) + mean_part;
}

VectorSum square_sums(const VectorSum& sum, const VectorSum& variance, double batch_size, int batches) {
    return {square_sum(sum.x / batch_size, variance.x, batches),
            square_sum(sum.y / batch_size, variance.y, batches),
            square_sum(sum.z / batch_size, variance.z, batches)};
}

/// The sums of pixel `i`, from channels in the order of channel_names().
PixelStatistics read_pixel(const ChannelReader& in, std::size_t i, int batch_size) {
    PixelStatistics pixel;
    const auto samples = in.number(i, kSamples);
    const auto receivers = in.number(i, kReceivers);
    const auto surfaces = in.number(i, kSurfaces);
    if (!(samples >= 0 && samples <= 1 << 30 && receivers >= 0 && receivers <= samples && surfaces >= 0 &&
          surfaces <= samples)) {
        throw Error(ErrorKind::file, "the picture to continue has contradictory counts of samples");
    }
    pixel.samples = static_cast<int>(samples);
    pixel.batches = pixel.samples / batch_size;
    if (pixel.batches * batch_size != pixel.samples) {
        throw Error(ErrorKind::file, "the picture to continue was made with another batch size");
    }
    BatchSum& sum = pixel.sum;
    sum.receivers = static_cast<int>(receivers);
    sum.surfaces = static_cast<int>(surfaces);
    sum.direct = in.sum(i, kDirect, samples);
    sum.indirect = in.sum(i, kIndirect, samples);
    sum.albedo = in.sum(i, kAlbedo, samples);
    sum.normal = in.sum(i, kNormal, receivers);
    sum.position = in.sum(i, kPosition, receivers);
    sum.depth = in.number(i, kDepth) * surfaces;
    VectorSum beauty = sum.direct;
    beauty.add(sum.indirect);
    pixel.beauty_square = square_sums(beauty, in.sum(i, kVariance, 1.0), batch_size, pixel.batches);
    pixel.indirect_square =
        square_sums(sum.indirect, in.sum(i, kIndirectVariance, 1.0), batch_size, pixel.batches);
    return pixel;
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
    Image image = make_image(width, height, channel_names());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        write_pixel(pixels[i], &image.values[i * image.channel_count()]);
    }
    return image;
}

std::vector<PixelStatistics> from_image(const Image& image, int batch_size) {
    const ChannelReader reader(image);
    std::vector<PixelStatistics> pixels;
    const std::size_t pixel_count = image.values.size() / image.channel_count();
    pixels.reserve(pixel_count);
    for (std::size_t i = 0; i < pixel_count; ++i) {
        pixels.push_back(read_pixel(reader, i, batch_size));
    }
    return pixels;
}

}  // namespace nearlight::core
