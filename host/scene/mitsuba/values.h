// SPDX-License-Identifier: Apache-2.0
// Numbers, colours and spectra as Mitsuba files write them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// "toWorld" → "to_world", "intIOR" → "int_ior".
std::string snake_case(const std::string& name);
/// The whole text must be a number; fail() otherwise.
double parse_number(const std::string& text, const Location& where);
/// Numbers separated by commas or white space.
std::vector<double> parse_numbers(const std::string& text, const Location& where);
/// One or three numbers, or #rrggbb (sRGB).
Color parse_rgb(const std::string& text, const Location& where);

struct SpectrumSample {
    double wavelength;  ///< nm
    double value;
};
/// Piecewise linear between samples (in order of wavelength), zero outside.
Color spectrum_color(std::span<const SpectrumSample> samples);
/// One value at every wavelength.
Color uniform_color(double value);
/// A number, or pairs "wavelength:value".
Color parse_spectrum(const std::string& text, const Location& where, NoteSink& notes);
/// Lines of "wavelength value"; '#' begins a comment.
Color read_spectrum(const std::filesystem::path& file, const Location& where, NoteSink& notes);

}  // namespace nearlight::core::mitsuba
