// SPDX-License-Identifier: Apache-2.0
// Numbers, colours and spectra as Mitsuba files write them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// Turns "toWorld" into "to_world", and "intIOR" into "int_ior".
std::string snake_case(const std::string& name);
/// The text with small letters, as in names of choices, which Mitsuba compares so.
std::string lower_case(std::string text);
/// The number that the whole text is. Calls fail() for any other text.
double parse_number(const std::string& text, const Location& where);
/// Numbers that commas or white space separate.
std::vector<double> parse_numbers(const std::string& text, const Location& where);
/// The colour that one or three numbers, or #rrggbb (sRGB), stand for.
Color parse_rgb(const std::string& text, const Location& where);

struct SpectrumSample {
    double wavelength;  ///< nm
    double value;
};
/// The colour of a spectrum that is linear between samples (in order of wavelength) and zero outside.
Color spectrum_color(std::span<const SpectrumSample> samples);
/// The colour of a spectrum that has one value at every wavelength.
Color uniform_color(double value);
/// The colour of a spectrum: one number, or pairs "wavelength:value".
Color parse_spectrum(const std::string& text, const Location& where, NoteSink& notes);
/// Reads a spectrum from lines of "wavelength value"; '#' begins a comment.
Color read_spectrum(const std::filesystem::path& file, const Location& where, NoteSink& notes);

}  // namespace nearlight::core::mitsuba
