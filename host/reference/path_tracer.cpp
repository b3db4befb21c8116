// SPDX-License-Identifier: Apache-2.0
#include "host/reference/path_tracer.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <vector>

#include "host/base/division.h"
#include "host/base/fork_join.h"
#include "host/base/math.h"
#include "host/base/stopwatch.h"
#include "host/reference/arena_size.h"
#include "host/reference/path_integrator.h"
#include "host/reference/pixel_statistics.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr int kTileSize = 16;

class PathTracer {
  public:
    PathTracer(const Scene& scene, const PathTracerSettings& settings)
        : settings_(settings),
          integrator_(scene, settings.max_depth, settings.clamp_radius),
          camera_(scene.camera, settings.width, settings.height),
          filter_(scene.camera, settings.width, settings.height),
          is_monochrome_(scene.camera.is_monochrome) {}

    void trace_batch(int x, int y, int batch, int batch_size, PixelStatistics& pixel) const;

  private:
    /// The light as the film has it.
    [[nodiscard]] Vec3 seen(Vec3 light) const {
        return is_monochrome_ ? Vec3{1, 1, 1} * luminance(light) : light;
    }

    PathTracerSettings settings_;
    PathIntegrator integrator_;
    CameraRays camera_;
    FilterSampler filter_;
    bool is_monochrome_;
};

void PathTracer::trace_batch(int x, int y, int batch_index, int batch_size, PixelStatistics& pixel) const {
    const auto pixel_index = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(settings_.width) +
                             static_cast<std::uint64_t>(x);
    SampleBatch batch(settings_.seed, pixel_index, static_cast<std::uint64_t>(batch_index), batch_size);
    BatchSum sum;
    for (int sample = 0; sample < batch_size; ++sample) {
        const FilterPoint film =
            settings_.pixel_centers
                ? FilterPoint{.place = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}}
                : filter_.sample(x, y, batch.point(Decision::film, sample));
        const Ray ray = camera_.through(film.place, batch.point(Decision::lens, sample));
        const PathLight light = integrator_.trace(ray, batch, sample);
        const auto weight = static_cast<float>(film.weight);
        sum.add(settings_.indirect_only ? Vec3{0, 0, 0} : weight * seen(as_float(light.direct)),
                weight * seen(as_float(light.indirect)), light.camera);
    }
    pixel.add(sum, batch_size);
}

/// Counts the work that is done and reports it, from one thread at a time.
class ProgressGate {
  public:
    ProgressGate(const Progress& progress, double total) : progress_(progress), total_(total) {}
    [[nodiscard]] bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
    void advance(double amount) {
        const std::scoped_lock lock(mutex_);
        done_ += amount;
        if (progress_ && !stopped() && !progress_(std::min(1.0, done_ / total_))) {
            stopped_ = true;
        }
    }

  private:
    const Progress& progress_;
    double total_;
    double done_ = 0;
    std::mutex mutex_;
    std::atomic<bool> stopped_ = false;
};

/// Traces one more batch for each pixel that has exactly `batch` batches.
void trace_round(const PathTracer& tracer, const PathTracerSettings& settings, int batch,
                 std::vector<PixelStatistics>& pixels, ProgressGate& gate) {
    const tbb::blocked_range2d<int> film(0, settings.height, kTileSize, 0, settings.width, kTileSize);
    const auto trace_tile = [&](const tbb::blocked_range2d<int>& tile) {
        if (gate.stopped()) {
            return;
        }
        for (int y = tile.rows().begin(); y < tile.rows().end(); ++y) {
            for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) {
                PixelStatistics& pixel =
                    pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(settings.width) +
                           static_cast<std::size_t>(x)];
                if (pixel.batches == batch) {
                    tracer.trace_batch(x, y, batch, settings.batch_size, pixel);
                }
            }
        }
        gate.advance(double(tile.rows().size()) * double(tile.cols().size()));
    };
    ForkJoin fork;
    tbb::parallel_for(film, fork.task(trace_tile), tbb::simple_partitioner());
}

/// The sums of the earlier picture, or empty sums without one.
std::vector<PixelStatistics> first_pixels(const PathTracerSettings& settings, const Image* earlier) {
    if (earlier == nullptr) {
        return std::vector<PixelStatistics>(static_cast<std::size_t>(settings.width) *
                                            static_cast<std::size_t>(settings.height));
    }
    if (earlier->width != settings.width || earlier->height != settings.height) {
        throw Error(ErrorKind::file, "the picture to continue has another size");
    }
    return from_image(*earlier, settings.batch_size);
}

}  // namespace

int samples_per_batch(int spp) {
    return spp < 32 ? 1 : spp < 256 ? 4 : 16;
}

PathTracerSettings completed(PathTracerSettings settings, const SceneCamera& camera) {
    if (settings.width <= 0) {
        settings.width = camera.width;
        settings.height = camera.height;
    } else if (settings.height <= 0) {
        settings.height =
            std::max(1, static_cast<int>(std::lround(double(settings.width) * camera.height / camera.width)));
    }
    if (settings.width <= 0 || settings.height <= 0 || settings.spp <= 0) {
        throw Error(ErrorKind::invalid_argument,
                    "the reference needs a picture of at least 1×1 pixels and 1 sample");
    }
    if (settings.batch_size == 0) {
        settings.batch_size = samples_per_batch(settings.spp);
    }
    if (settings.batch_size != 1 && settings.batch_size != 4 && settings.batch_size != 16) {
        throw Error(ErrorKind::invalid_argument, "batches have 1, 4 or 16 samples");
    }
    settings.spp = round_up_to_multiple(settings.spp, settings.batch_size);
    if (settings.max_depth < -1) {
        throw Error(ErrorKind::invalid_argument, "max depth must be 1 or more, or 0 or -1 for no limit");
    }
    if (!(settings.clamp_radius >= 0.0f) || !std::isfinite(settings.clamp_radius)) {
        throw Error(ErrorKind::invalid_argument, "the clamp radius must be 0 or more");
    }
    return settings;
}

Image trace_paths(const Scene& scene, const PathTracerSettings& wanted, const Progress& progress,
                  const LongTrace& long_trace) {
    const PathTracerSettings settings = completed(wanted, scene.camera);
    std::vector<PixelStatistics> pixels = first_pixels(settings, long_trace.earlier);
    const PathTracer tracer(scene, settings);
    const int batch_count = settings.spp / settings.batch_size;
    const int first = std::ranges::min(pixels, {}, &PixelStatistics::batches).batches;
    ProgressGate gate(progress, double(pixels.size()) * std::max(1, batch_count - first));
    tbb::task_arena arena(arena_size(settings.threads));
    Stopwatch since_save;
    for (int batch = first; batch < batch_count && !gate.stopped(); ++batch) {
        arena.execute([&] { trace_round(tracer, settings, batch, pixels, gate); });
        if (long_trace.save && since_save.seconds() > long_trace.seconds_between_saves) {
            long_trace.save(to_image(pixels, settings.width, settings.height));
            since_save.lap();
        }
    }
    return to_image(pixels, settings.width, settings.height);
}

}  // namespace nearlight::core
