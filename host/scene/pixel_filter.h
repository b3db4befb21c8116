// SPDX-License-Identifier: Apache-2.0
// Reconstruction filters: how much light a pixel takes from each place of the film. They are those of
// Mitsuba, in one dimension; a pixel's filter is the product of that in x and that in y.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace nearlight::core {

enum class FilterKind { box, tent, gaussian, mitchell, catmull_rom, lanczos };
/// Mitsuba's filter where a file says nothing, and that of formats that know no filters. Its pictures have
/// about a third of a box's variance, because each sample counts in all pixels that the filter reaches.
inline constexpr FilterKind kUsualFilter = FilterKind::gaussian;

/// A filter with its parameters. Two filters whose relevant parameters are equal are the same.
struct PixelFilter {
    FilterKind kind = FilterKind::box;
    double radius = 0.5;  ///< support on each side, pixels; for a Gaussian, 4 standard deviations
    double b = 0.0;       ///< B and C of [Mitchell & Netravali 1988], for mitchell
    double c = 0.0;

    bool operator==(const PixelFilter&) const = default;
};

/// The filter of this kind with Mitsuba's default parameters.
PixelFilter default_filter(FilterKind kind);
/// Where the pixel's own square is all that the filter takes light from, evenly.
bool is_pixel_box(const PixelFilter& filter);
/// The value at x pixels from the middle, up to a constant factor.
double filter_value(const PixelFilter& filter, double x);

/// The name as in Mitsuba's files, such as "catmullrom".
std::string to_string(FilterKind kind);
/// The kind of this name; empty for an unknown one.
std::optional<FilterKind> filter_kind(const std::string& name);
/// All names, separated by commas.
std::string filter_names();

/// Fills tables of a filter's integrals from 0 to i · radius / (size − 1), of its absolute value and of
/// itself. Both have the same size.
void fill_filter_tables(const PixelFilter& filter, std::span<float> absolute, std::span<float> with_sign);

}  // namespace nearlight::core
