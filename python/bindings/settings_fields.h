// SPDX-License-Identifier: Apache-2.0
// The fields of each settings struct, as tables: constructors, properties, keyword arguments, texts and
// documentation of the Python classes follow from them. A test compares the names and defaults with
// include/nearlight/settings.h.
#pragma once

#include <tuple>

#include "nearlight/nearlight.h"

namespace nearlight::python {

template <typename Settings, typename Value>
struct Field {
    const char* name;
    Value Settings::*member;
    const char* text;            ///< what the field means, in one line
    bool takes_numbers = false;  ///< whether whole numbers may stand for names; for std::string
};
template <typename Settings, typename Value>
Field(const char*, Value Settings::*, const char*) -> Field<Settings, Value>;
template <typename Settings, typename Value>
Field(const char*, Value Settings::*, const char*, bool) -> Field<Settings, Value>;

/// What the tables say about a struct: FieldsOf<Settings>::name, ::text and ::fields.
template <typename Settings>
struct FieldsOf;

template <>
struct FieldsOf<CameraPose> {
    static constexpr const char* name = "CameraPose";
    static constexpr const char* text = "Where a camera stands and where it looks.";
    static constexpr auto fields =
        std::tuple{Field{"origin", &CameraPose::origin, "where it stands, m"},
                   Field{"target", &CameraPose::target, "a point in the middle of the picture, m"},
                   Field{"up", &CameraPose::up,
                         "what points upwards in the picture; None: as the scene's camera has it"},
                   Field{"fov_x_degrees", &CameraPose::fov_x_degrees,
                         "horizontal field of view, between 0 and 180; None: the scene's"}};
};

template <>
struct FieldsOf<ViewSettings> {
    static constexpr const char* name = "ViewSettings";
    static constexpr const char* text = "What to look at. The scene and a pilot view decide what is None.";
    static constexpr auto fields =
        std::tuple{Field{"camera", &ViewSettings::camera, "a CameraPose; None: the scene's camera"},
                   Field{"width", &ViewSettings::width, "pixels; None: the scene's"},
                   Field{"height", &ViewSettings::height, "pixels; None: the scene's"},
                   Field{"range", &ViewSettings::range,
                         "where the close range ends, m; None: it holds nine tenths of what is seen"},
                   Field{"clamp_radius", &ViewSettings::clamp_radius,
                         "radius of the bounded geometry term, m; None: the one of least noise"},
                   Field{"ray_budget_pilot", &ViewSettings::ray_budget_pilot,
                         "whether a pilot chooses that radius and the number of light samples"},
                   Field{"max_depth", &ViewSettings::max_depth,
                         "length of the longest light path, 2 is direct light; None: the scene's, or 256"}};
};

template <>
struct FieldsOf<SamplingSettings> {
    static constexpr const char* name = "SamplingSettings";
    static constexpr const char* text = "How to make virtual point lights (VPLs).";
    static constexpr auto fields = std::tuple{
        Field{"sampler", &SamplingSettings::sampler, "a SamplerKind or its name"},
        Field{"policy", &SamplingSettings::policy, "a Policy or its name, for the sampler close_range"},
        Field{"vpl_count", &SamplingSettings::vpl_count, "about how many VPLs a pixel asks"},
        Field{"cuts", &SamplingSettings::cuts,
              "whether the set holds more VPLs, of which pixels ask those that could bring most"},
        Field{"set_count", &SamplingSettings::set_count,
              "about how many VPLs the set has, with cuts; None: 64 times vpl_count, but at most 2^20"},
        Field{"close_fraction", &SamplingSettings::close_fraction,
              "share of VPLs in the close range, 0 to 1; None: a pilot chooses"},
        Field{"file", &SamplingSettings::file,
              "PLY file that the VPLs come from, whatever the other fields say; empty: none"}};
};

template <>
struct FieldsOf<PixelWindow> {
    static constexpr const char* name = "PixelWindow";
    static constexpr const char* text = "A part of a picture, in pixels.";
    static constexpr auto fields = std::tuple{Field{"x", &PixelWindow::x, "of the leftmost pixel"},
                                              Field{"y", &PixelWindow::y, "of the topmost pixel"},
                                              Field{"width", &PixelWindow::width, "at least 1"},
                                              Field{"height", &PixelWindow::height, "at least 1"}};
};

template <>
struct FieldsOf<GatherSettings> {
    static constexpr const char* name = "GatherSettings";
    static constexpr const char* text = "How to make pixels from VPLs and emitters.";
    static constexpr auto fields = std::tuple{
        Field{"samples_per_pixel", &GatherSettings::samples_per_pixel, "camera samples of each pixel"},
        Field{"strata", &GatherSettings::strata,
              "parts of the set of VPLs, of which each sample asks one; None: one a sample"},
        Field{"interleave", &GatherSettings::interleave,
              "1, 2 or 4: the pixels of a square of this size share the strata, which suits denoisers"},
        Field{"window", &GatherSettings::window, "a PixelWindow, the part to make; None: the whole picture"},
        Field{"direct_samples_per_pixel", &GatherSettings::direct_samples_per_pixel,
              "samples towards area lights and the environment; None: a pilot chooses"},
        Field{"compensate", &GatherSettings::compensate,
              "whether rays bring back what the clamp radius takes away and what surfaces reflect other than "
              "diffusely"},
        Field{"rays_per_pixel", &GatherSettings::rays_per_pixel, "the number of these rays"},
        Field{"refine", &GatherSettings::refine,
              "whether edges of lamps and windows, of their images and of highlights get more camera paths"},
        Field{
            "splat", &GatherSettings::splat,
            "whether samples count in all pixels whose reconstruction filter reaches them; denoisers expect "
            "that they do not"},
        Field{"indirect_only", &GatherSettings::indirect_only,
              "leaves out the direct light of receivers, but not lights that are seen, mirrored or in "
              "highlights"},
        Field{"shared_limit", &GatherSettings::shared_limit,
              "radiance of lamps met by chance that bundles share at most; None: a pilot chooses"},
        Field{"roulette", &GatherSettings::roulette,
              "threshold of Russian roulette, in means of what VPLs could bring; 0 asks them all"},
        Field{"spread_single_samples", &GatherSettings::spread_single_samples,
              "whether a pixel's only sample lies anywhere in its filter's reach and not in its middle, so "
              "that the mean of many such pictures has smooth edges"}};
};

template <>
struct FieldsOf<RenderSettings> {
    static constexpr const char* name = "RenderSettings";
    static constexpr const char* text =
        "How to make a picture: a view, VPLs and a gather, in one pass or several.";
    static constexpr auto fields = std::tuple{
        Field{"view", &RenderSettings::view, "ViewSettings"},
        Field{"sampling", &RenderSettings::sampling, "SamplingSettings"},
        Field{"gather", &RenderSettings::gather, "GatherSettings"},
        Field{"seed", &RenderSettings::seed, "of the random numbers: equal seeds give equal bits"},
        Field{"passes", &RenderSettings::passes, "number of passes to average; None: one, or as limits say"},
        Field{"seconds", &RenderSettings::seconds, "time limit: makes as many passes as fit"},
        Field{"error", &RenderSettings::error, "makes passes until the relative error is at most this"},
        Field{"pass_samples", &RenderSettings::pass_samples,
              "samples per pixel of each pass, as Picture.pass_samples has them"}};
};

template <>
struct FieldsOf<SessionOptions> {
    static constexpr const char* name = "SessionOptions";
    static constexpr const char* text = "How a session gets ready.";
    static constexpr auto fields =
        std::tuple{Field{"gather_kernel", &SessionOptions::gather_kernel, "a GatherKernel or its name"},
                   Field{"bvh_quality", &SessionOptions::bvh_quality, "a BvhQuality or its name"}};
};

template <>
struct FieldsOf<IrradianceSettings> {
    static constexpr const char* name = "IrradianceSettings";
    static constexpr const char* text = "How Session.irradiance() estimates the light at points.";
    static constexpr auto fields =
        std::tuple{Field{"direct_samples", &IrradianceSettings::direct_samples,
                         "samples of each point, towards area lights and the environment"},
                   Field{"paths", &IrradianceSettings::paths,
                         "short paths from each point, which bring back what the clamp radius takes away"}};
};

template <>
struct FieldsOf<AnimationOptions> {
    static constexpr const char* name = "AnimationOptions";
    static constexpr const char* text = "How the frames of an animation are made.";
    static constexpr auto fields = std::tuple{
        Field{"fps", &AnimationOptions::fps, "frames per second: frame N shows the time N / fps"},
        Field{"animations", &AnimationOptions::animations,
              "names or numbers, from 1, of those to play; []: all but those that move what an earlier one "
              "moves"},
        Field{"vpl_keys", &AnimationOptions::vpl_keys,
              "where only the camera moves, VPLs are made every so many frames; 0: for each; None: as fps"}};
};

template <>
struct FieldsOf<LoadOptions> {
    static constexpr const char* name = "LoadOptions";
    static constexpr const char* text = "How to load a scene.";
    static constexpr auto fields = std::tuple{
        Field{"definitions", &LoadOptions::definitions, "values of $NAME in a Mitsuba scene, by name"},
        Field{"strict", &LoadOptions::strict, "whether an approximation is an error"},
        Field{"clear_glass", &LoadOptions::clear_glass, "whether light passes glass bodies straight"},
        Field{"camera", &LoadOptions::camera, "a camera's name, or its number from 1; '': the first one",
              true},
        Field{"origin", &LoadOptions::origin, "where the camera stands, m; None: as the file says"},
        Field{"target", &LoadOptions::target, "what the camera looks at, m"},
        Field{"up", &LoadOptions::up, "what points upwards in the picture"},
        Field{"fov_x_degrees", &LoadOptions::fov_x_degrees, "horizontal, degrees"},
        Field{"environment", &LoadOptions::environment,
              "an image file, 'sky', or a colour as 'R,G,B', '0.5' for grey, or '#rrggbb'; '': the scene's "
              "own"},
        Field{"environment_rotation", &LoadOptions::environment_rotation, "degrees about +Y"},
        Field{"environment_scale", &LoadOptions::environment_scale, "multiplies the environment's light"},
        Field{"sun", &LoadOptions::sun, "a SunPosition, where to add a sun"},
        Field{"light_scale", &LoadOptions::light_scale, "multiplies all light"}};
};

template <>
struct FieldsOf<SunPosition> {
    static constexpr const char* name = "SunPosition";
    static constexpr const char* text = "Where the sun stands.";
    static constexpr auto fields =
        std::tuple{Field{"azimuth", &SunPosition::azimuth, "degrees from +Z towards +X"},
                   Field{"elevation", &SunPosition::elevation, "degrees above the horizon, 0 to 90"}};
};

template <>
struct FieldsOf<WriteOptions> {
    static constexpr const char* name = "WriteOptions";
    static constexpr const char* text = "How to write a picture.";
    static constexpr auto fields = std::tuple{
        Field{"exposure", &WriteOptions::exposure, "stops, for PNG: one more doubles the brightness"},
        Field{"tone_curve", &WriteOptions::tone_curve, "a ToneCurve or its name, for PNG"}};
};

template <>
struct FieldsOf<DeviceOptions> {
    static constexpr const char* name = "DeviceOptions";
    static constexpr const char* text = "Where devices take kernels from and where they keep compiled ones.";
    static constexpr auto fields = std::tuple{
        Field{"kernel_dir", &DeviceOptions::kernel_dir, "a folder of kernels; '': those in the library"},
        Field{"cache_dir", &DeviceOptions::cache_dir,
              "a folder; '': the user's cache; 'none': nothing is kept"}};
};

/// Calls `action` with each field of the struct.
template <typename Settings, typename Action>
void for_each_field(Action&& action) {
    std::apply([&](const auto&... field) { (action(field), ...); }, FieldsOf<Settings>::fields);
}

}  // namespace nearlight::python
