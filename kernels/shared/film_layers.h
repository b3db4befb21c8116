// SPDX-License-Identifier: Apache-2.0
// The table of the picture's layers, compiled by host and kernels. The kernel of the film, the average of
// passes, the EXR files and the help text of --layers come from it; CONTRIBUTING.md says how to add a row.
//
// A row is LAYER(constant, name, channels, samples, passes, files, storage).
//   constant   is what NEARLIGHT_LAYER_… and NEARLIGHT_SUM_… end in.
//   name       stands before the channel in files, as in "direct.R"; the beauty's channels have no prefix.
//   channels   is one letter for each channel. A layer whose name is its only letter has no prefix.
//   samples    says how the samples of a pixel become the layer:
//     mean       their mean;
//     direction  the unit vector along their sum;
//     first      the value of the first sample that met something on the pixel's own square, or, if there is
//                none, anywhere, because positions and depths cannot be averaged across an edge;
//     depth      the same for a distance, whose sum is negative while it is not of the pixel's own square;
//     light      the sum of the layers direct and indirect, for which nothing is added up separately;
//     spread     the variance of the pixel's light, judged by how far apart the means of the first and of the
//                second half of the samples lie; 0 for a single sample.
//   Where samples count in the pixels around theirs, too, beauty, direct, indirect, variance and A are
//   those of all samples that reach the pixel, with the filter's weights (host/session/splat_rows.h).
//   passes     says how several passes become one picture: `mean` averages them, `first` keeps the first,
//              and `variance` is the variance of the mean, judged by the passes' own variances and by how
//              far apart the passes lie (host/session/pass_average.h).
//   files      says which EXR files get the layer: `always`, unless --layers names others, or `asked`, if
//              --layers names it.
//   storage    says what numbers EXR files have unless --exr-precision asks for more: `half`, which are
//              16-bit floats of 11 significant bits, or `full`, which are 32-bit floats.
// Albedo, N, P and closerange are those of the first surface with a Lambertian part, behind mirrors and glass
// too, and 0 where a sample meets none or one of too little weight for a receiver (CameraLimits); depth is
// that of the first surface of all.
// The order of the rows is the order of the channels in a picture and in its files.
#ifndef NEARLIGHT_SHARED_FILM_LAYERS_H
#define NEARLIGHT_SHARED_FILM_LAYERS_H

#define NEARLIGHT_FILM_LAYERS(LAYER)                                \
    LAYER(BEAUTY, "beauty", RGB, light, mean, always, half)         \
    LAYER(DIRECT, "direct", RGB, mean, mean, always, half)          \
    LAYER(INDIRECT, "indirect", RGB, mean, mean, always, half)      \
    LAYER(ALBEDO, "albedo", RGB, mean, first, always, half)         \
    LAYER(NORMAL, "N", XYZ, direction, first, always, half)         \
    LAYER(POSITION, "P", XYZ, first, first, always, full)           \
    LAYER(DEPTH, "depth", Z, depth, first, always, full)            \
    LAYER(CLOSE_RANGE, "closerange", Y, mean, first, always, half)  \
    LAYER(VARIANCE, "variance", RGB, spread, variance, asked, full) \
    LAYER(ALPHA, "A", A, mean, mean, asked, half)

/// The halves of a pixel's samples are not drawn one by one but complement each other: they ask different
/// strata of the VPLs and lie in each other's gaps in the pixel. So the variance of their mean is this part
/// of what their difference would tell of independent halves (bench/log/error.md).
#define NEARLIGHT_HALVES_TO_WHOLE 0.72f

// How many channels each word of the column `channels` stands for.
#define NEARLIGHT_CHANNELS_RGB 3
#define NEARLIGHT_CHANNELS_XYZ 3
#define NEARLIGHT_CHANNELS_A 1
#define NEARLIGHT_CHANNELS_Y 1
#define NEARLIGHT_CHANNELS_Z 1

// How many floats a pixel needs to add up samples for a layer of `count` channels.
#define NEARLIGHT_SUMS_mean(count) count
#define NEARLIGHT_SUMS_direction(count) count
#define NEARLIGHT_SUMS_first(count) count
#define NEARLIGHT_SUMS_depth(count) count
#define NEARLIGHT_SUMS_light(count) 0
#define NEARLIGHT_SUMS_spread(count) count

#define NEARLIGHT_LAYER_SIZE(constant, name, channels, samples, passes, files, storage) \
    +NEARLIGHT_CHANNELS_##channels
#define NEARLIGHT_SUM_SIZE(constant, name, channels, samples, passes, files, storage) \
    +NEARLIGHT_SUMS_##samples(NEARLIGHT_CHANNELS_##channels)

/// The number of channels of a finished picture.
#define NEARLIGHT_LAYER_CHANNELS (0 NEARLIGHT_FILM_LAYERS(NEARLIGHT_LAYER_SIZE))
/// The number of floats in which a pixel adds up its samples.
#define NEARLIGHT_FILM_CHANNELS (0 NEARLIGHT_FILM_LAYERS(NEARLIGHT_SUM_SIZE))

#ifdef __cplusplus
namespace nearlight::core {
#endif

// Each row names its first and its last channel, so that the enumerator after them is the first channel of
// the next row.
#define NEARLIGHT_LAYER_PLACE(constant, name, channels, samples, passes, files, storage) \
    NEARLIGHT_LAYER_##constant,                                                          \
        NEARLIGHT_LAYER_##constant##_LAST = NEARLIGHT_LAYER_##constant + NEARLIGHT_CHANNELS_##channels - 1,
#define NEARLIGHT_SUM_PLACE(constant, name, channels, samples, passes, files, storage) \
    NEARLIGHT_SUM_##constant,                                                          \
        NEARLIGHT_SUM_##constant##_LAST =                                              \
            NEARLIGHT_SUM_##constant + NEARLIGHT_SUMS_##samples(NEARLIGHT_CHANNELS_##channels) - 1,

/// NEARLIGHT_LAYER_DIRECT is the first channel of the layer "direct" in a finished picture, and so on.
enum { NEARLIGHT_FILM_LAYERS(NEARLIGHT_LAYER_PLACE) };
/// NEARLIGHT_SUM_DIRECT is the first of the floats in which a pixel adds up the samples of the layer
/// "direct", and so on. A layer for which nothing is added up has no place of its own.
enum { NEARLIGHT_FILM_LAYERS(NEARLIGHT_SUM_PLACE) };

#ifdef __cplusplus
}  // namespace nearlight::core
#endif

#endif
