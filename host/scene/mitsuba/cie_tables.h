// SPDX-License-Identifier: Apache-2.0
// The CIE 1931 standard observer and the CIE standard illuminant D65.
#pragma once

#include <array>

namespace nearlight::core::mitsuba {

inline constexpr double kMinWavelength = 360.0;  ///< nm, the range of the tables
inline constexpr double kMaxWavelength = 830.0;

/// The colour matching functions of the 2° observer at a wavelength in nm, linear between multiples of 5 nm.
std::array<double, 3> cie_xyz(double wavelength);
/// Relative spectral power of D65, scaled so that light of this spectrum has the luminance 1.
double cie_d65(double wavelength);

}  // namespace nearlight::core::mitsuba
