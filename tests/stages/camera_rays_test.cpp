// SPDX-License-Identifier: Apache-2.0
// Film samples and rays of kernels/lib/camera.cl and of the reference path tracer, against the definition of
// filters and lenses.
#include <array>
#include <cmath>
#include <set>

#include "host/base/random.h"
#include "host/reference/camera_path.h"
#include "host/scene/camera.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"

namespace nearlight::core {
namespace {

using test::KernelProbe;

constexpr int kWidth = 7;
constexpr int kHeight = 1;
constexpr int kSide = 256;  ///< film samples along each axis of the unit square

/// One place on the film with its weight.
struct Placed {
    double x, y, weight;
};

/// The mean over the samples of weight · function(x, y).
template <typename Function>
double mean(const std::vector<Placed>& samples, Function function) {
    double sum = 0.0;
    for (const Placed& sample : samples) {
        sum += sample.weight * function(sample.x, sample.y);
    }
    return sum / static_cast<double>(samples.size());
}

/// What a picture shows in a pixel whose filter has the middle `middle` on a film from `low` to `high`, where
/// the light at x is function(x): ∫ filter · function ÷ ∫ filter.
template <typename Function>
double filtered(const PixelFilter& filter, double middle, double low, double high, Function function) {
    constexpr int kSteps = 20'000;
    const double begin = std::max(low, middle - filter.radius);
    const double end = std::min(high, middle + filter.radius);
    double sum = 0.0;
    double weights = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = begin + (i + 0.5) / kSteps * (end - begin);
        const double value = filter_value(filter, x - middle);
        sum += value * function(x);
        weights += value;
    }
    return sum / weights;
}

Point2 square_point(int index) {
    return {(static_cast<float>(index % kSide) + 0.5f) / kSide,
            (static_cast<float>(index / kSide) + 0.5f) / kSide};
}

std::vector<Placed> place_on_device(KernelProbe& probe, const SceneCamera& camera, uint pixel) {
    const std::vector<Camera> cameras{make_camera(camera, kWidth, kHeight)};
    Buffer<float> out(probe.device(), 4 * kSide * kSide);
    probe.kernel().launch(kSide * kSide, 64, Buffer<Camera>(probe.device(), cameras), pixel, out);
    const std::vector<float> values = out.download();
    std::vector<Placed> samples;
    for (std::size_t i = 0; i < values.size(); i += 4) {
        samples.push_back({values[i], values[i + 1], values[i + 2]});
        const double away =
            std::max(std::abs(samples.back().x - pixel - 0.5), std::abs(samples.back().y - 0.5));
        EXPECT_EQ(values[i + 3], away <= 0.5 ? 1.0f : 0.0f) << "in its own pixel";
    }
    return samples;
}

std::vector<Placed> place_on_host(const SceneCamera& camera, int pixel) {
    const FilterSampler sampler(camera, kWidth, kHeight);
    std::vector<Placed> samples;
    for (int i = 0; i < kSide * kSide; ++i) {
        const FilterPoint point = sampler.sample(pixel, 0, square_point(i));
        samples.push_back({point.place.x, point.place.y, point.weight});
    }
    return samples;
}

constexpr const char* kPlacingKernel =
    "#include \"lib/camera.cl\"\n"
    "kernel void probe(const global Camera* camera, uint pixel, global float* out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const float2 u = ((float2)(i % 256u, i / 256u) + 0.5f) / 256.0f;\n"
    "    const FilmSample sample = sample_film(camera, pixel, 0, u);\n"
    "    out[4 * i] = sample.position.x;\n"
    "    out[4 * i + 1] = sample.position.y;\n"
    "    out[4 * i + 2] = sample.weight;\n"
    "    out[4 * i + 3] = sample.is_in_own_pixel;\n"
    "}\n";

/// A filter of each kind, with a film that has a border and one that has none.
std::vector<SceneCamera> filtering_cameras() {
    std::vector<SceneCamera> cameras;
    for (const FilterKind kind : {FilterKind::box, FilterKind::tent, FilterKind::gaussian,
                                  FilterKind::mitchell, FilterKind::catmull_rom, FilterKind::lanczos}) {
        SceneCamera camera;
        camera.filter = default_filter(kind);
        cameras.push_back(camera);
        camera.sample_border = true;
        cameras.push_back(camera);
    }
    cameras.back().filter.radius = 2.0;  // fewer lobes
    SceneCamera wide_box;
    wide_box.filter.radius = 1.2;
    cameras.push_back(wide_box);
    return cameras;
}

void expect_filtered(const std::vector<Placed>& samples, const SceneCamera& camera, int pixel) {
    const std::string name = to_string(camera.filter.kind) + " pixel " + std::to_string(pixel);
    const double low = camera.sample_border ? -100.0 : 0.0;
    const double right = camera.sample_border ? 100.0 : kWidth;
    const double bottom = camera.sample_border ? 100.0 : kHeight;
    const auto wave = [](double x) { return 2.0 + std::sin(1.7 * x + 0.3) + 0.1 * x * x; };
    const double across = filtered(camera.filter, pixel + 0.5, low, right, wave);
    const double down = filtered(camera.filter, 0.5, low, bottom, wave);
    EXPECT_NEAR(mean(samples, [](double, double) { return 1.0; }), 1.0, 0.03) << name;
    EXPECT_NEAR(mean(samples, [&](double x, double) { return wave(x); }), across, 0.03 * across) << name;
    EXPECT_NEAR(mean(samples, [&](double x, double y) { return wave(x) * wave(y); }), across * down,
                0.04 * across * down)
        << name;
    for (const Placed& sample : samples) {
        ASSERT_LE(std::abs(sample.x - pixel - 0.5), camera.filter.radius + 1e-5) << name;
        ASSERT_TRUE(sample.x >= low && sample.x <= right && sample.y >= low && sample.y <= bottom) << name;
    }
}

class CameraRaysTest : public test::DeviceTest {};

TEST_F(CameraRaysTest, SamplesOfAPixelHaveTheExpectationOfItsFilter) {
    on_each_device([](Device& device) {
        KernelProbe probe(device, kPlacingKernel);
        for (const SceneCamera& camera : filtering_cameras()) {
            for (const int pixel : {0, 1, 3, kWidth - 1}) {
                expect_filtered(place_on_device(probe, camera, static_cast<uint>(pixel)), camera, pixel);
                expect_filtered(place_on_host(camera, pixel), camera, pixel);
            }
        }
    });
}

/// In tables too, a box is even down to the last of its samples.
TEST_F(CameraRaysTest, SamplesOfAWideBoxAreEven) {
    SceneCamera camera;
    camera.filter.radius = 1.2;
    const auto expect_even = [](const std::vector<Placed>& samples) {
        for (int i = 0; i < kSide; ++i) {
            EXPECT_NEAR(samples[static_cast<std::size_t>(i)].x, 3.5 + 1.2 * ((2 * i + 1.0) / kSide - 1),
                        1e-3);
        }
    };
    expect_even(place_on_host(camera, 3));
    on_each_device([&](Device& device) {
        KernelProbe probe(device, kPlacingKernel);
        expect_even(place_on_device(probe, camera, 3));
    });
}

TEST_F(CameraRaysTest, EachSampleOfAPictureHasRandomNumbersOfItsOwn) {
    constexpr uint kPixels = 16;  // along each side
    constexpr uint kSamples = 4;
    const std::vector<Camera> cameras{make_camera({}, kPixels, kPixels)};
    on_each_device([&](Device& device) {
        KernelProbe probe(device,
                          "#include \"lib/camera_sample.cl\"\n"
                          "kernel void probe(const global Camera* camera, global uint* keys) {\n"
                          "    const uint i = get_global_id(0);\n"
                          "    keys[i] = camera_sample(camera, i % 16, i / 16 % 16, i / 256, 4, 1).key;\n"
                          "}\n");
        Buffer<uint> keys(probe.device(), kPixels * kPixels * kSamples);
        probe.kernel().launch(kPixels * kPixels * kSamples, 64, Buffer<Camera>(probe.device(), cameras),
                              keys);
        const std::vector<uint> found = keys.download();
        EXPECT_EQ(std::set<uint>(found.begin(), found.end()).size(), found.size());
    });
}

/// A camera of each kind in an oblique place, with clip planes.
std::vector<SceneCamera> clipped_cameras() {
    SceneCamera camera;
    camera.to_world = look_at({3, -2, 5}, {-1, 4, 0.5}, {0.3, 1, 0.2});
    camera.near_clip = 0.5;
    camera.far_clip = 9.0;
    camera.center_x = 0.1;
    std::vector<SceneCamera> cameras{camera, camera, camera};
    cameras[1].aperture_radius = 0.3;
    cameras[1].focus_distance = 4.0;
    cameras[2].kind = CameraKind::orthographic;
    return cameras;
}

/// Checks a ray through the film position that stands for d in `made` (see Camera).
void expect_ray(const Camera& made, const SceneCamera& camera, Vec3 d, const Ray& ray) {
    EXPECT_NEAR(length(ray.direction), 1.0f, 1e-5f);
    const float cosine = dot(ray.direction, made.forward);
    const auto depth = [&](float t) {
        return dot(ray.origin + ray.direction * t - made.origin, made.forward);
    };
    EXPECT_NEAR(depth(ray.t_min), 0.5f, 1e-4f);
    EXPECT_NEAR(depth(ray.t_max), 9.0f, 1e-3f);
    if (camera.kind == CameraKind::orthographic) {
        EXPECT_NEAR(cosine, 1.0f, 1e-5f);
        EXPECT_LT(length(ray.origin - made.origin - d), 1e-5f);
        return;
    }
    const auto focus = static_cast<float>(camera.focus_distance);
    const Vec3 in_focus = ray.origin + ray.direction * (focus / cosine);
    EXPECT_LT(length(in_focus - made.origin - d * focus), 2e-4f);
    EXPECT_LE(length(ray.origin - made.origin), camera.aperture_radius + 1e-5);
    EXPECT_NEAR(dot(ray.origin - made.origin, made.forward), 0.0f, 1e-5f);
}

TEST_F(CameraRaysTest, RaysMeetInTheFocusAndSeeBetweenTheClipPlanes) {
    constexpr std::size_t kRays = 64;
    std::vector<float> random_numbers(4 * kRays);
    Pcg32 random(3);
    std::ranges::generate(random_numbers, [&] { return random.uniform(); });
    on_each_device([&](Device& device) {
        KernelProbe probe(
            device,
            "#include \"lib/camera.cl\"\n"
            "kernel void probe(const global Camera* camera, const global float4* random,\n"
            "                  global float8* rays) {\n"
            "    const uint i = get_global_id(0);\n"
            "    const CameraRay ray = camera_ray(camera, random[i].xy * 40.0f, random[i].zw);\n"
            "    rays[i] = (float8)(ray.origin, ray.t_min, ray.direction, ray.t_max);\n"
            "}\n");
        for (const SceneCamera& camera : clipped_cameras()) {
            const Camera made = make_camera(camera, 40, 40);
            const CameraRays host(camera, 40, 40);
            Buffer<float> rays(probe.device(), 8 * kRays);
            probe.kernel().launch(kRays, 64, Buffer<Camera>(probe.device(), std::vector<Camera>{made}),
                                  Buffer<float>(probe.device(), random_numbers), rays);
            const std::vector<float> found = rays.download();
            for (std::size_t i = 0; i < kRays; ++i) {
                const float* const u = &random_numbers[4 * i];
                const float* const r = &found[8 * i];
                const Vec3 d = made.corner + made.step_x * (u[0] * 40.0f) + made.step_y * (u[1] * 40.0f);
                expect_ray(made, camera, d, {{r[0], r[1], r[2]}, {r[4], r[5], r[6]}, r[3], r[7]});
                expect_ray(made, camera, d, host.through({u[0] * 40.0f, u[1] * 40.0f}, {u[2], u[3]}));
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
