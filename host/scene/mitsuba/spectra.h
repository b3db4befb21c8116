// SPDX-License-Identifier: Apache-2.0
// Spectra as the colours that Mitsuba's RGB variants make of them.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

struct SpectrumSample {
    double wavelength;  ///< nm
    double value;
};

/// The colour of a spectrum that is linear between samples (in order of wavelength) and zero outside: as a
/// reflectance under D65, as a light by itself. A light whose spectrum is 1 everywhere has the luminance 1.
Color spectrum_color(std::span<const SpectrumSample> samples);
/// The colour of a spectrum that has one value at every wavelength.
Color uniform_color(double value);
/// The colour of a black body's radiance (Planck's law) between two wavelengths. Temperature in kelvin.
Color blackbody_color(double temperature, double min_wavelength, double max_wavelength);

/// The colour of a spectrum: one number, or pairs "wavelength:value".
Color parse_spectrum(const std::string& text, const Location& where);
/// Reads a spectrum from lines of "wavelength value"; '#' begins a comment.
Color read_spectrum(const std::filesystem::path& file, const Location& where);

/// The colour of an object that is a spectrum of its own (types blackbody, d65, irregular, rawconstant,
/// regular, srgb, uniform); empty for other objects, and for a d65 with a nested texture.
std::optional<Color> spectrum_object_color(const Object& object);

}  // namespace nearlight::core::mitsuba
