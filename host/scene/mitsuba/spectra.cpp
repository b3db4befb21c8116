// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/spectra.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "host/scene/file_text.h"
#include "host/scene/mitsuba/cie_tables.h"
#include "host/scene/mitsuba/values.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

// Mitsuba's integral of y, which makes a spectrum of 1 a luminance of 1.
constexpr double kLuminanceIntegral = 106.7502593994140625;
constexpr int kSteps = 1000;

Vec3 xyz_to_rgb(const std::array<double, 3>& xyz) {
    const auto channel = [&](double x, double y, double z) {
        return static_cast<float>(x * xyz[0] + y * xyz[1] + z * xyz[2]);
    };
    return {channel(3.240479, -1.537150, -0.498535), channel(-0.969256, 1.875991, 0.041556),
            channel(0.055648, -0.204043, 1.057311)};
}

/// The colour of a spectrum under D65 and of the spectrum as a light, without negative components. The sum
/// runs over the points that Mitsuba takes, so that narrow lines have the same colour.
Color integrate(const std::function<double(double)>& value) {
    std::array<double, 3> under_d65{};
    std::array<double, 3> alone{};
    const double range = kMaxWavelength - kMinWavelength;
    for (int i = 0; i < kSteps; ++i) {
        const double wavelength = kMinWavelength + range * i / (kSteps - 1);
        const std::array<double, 3> xyz = cie_xyz(wavelength);
        const double here = value(wavelength) * range / kSteps / kLuminanceIntegral;
        const double lit = here * cie_d65(wavelength);
        for (std::size_t c = 0; c < 3; ++c) {
            alone[c] += xyz[c] * here;
            under_d65[c] += xyz[c] * lit;
        }
    }
    return {max(xyz_to_rgb(under_d65), {0, 0, 0}), max(xyz_to_rgb(alone), {0, 0, 0})};
}

double value_at(std::span<const SpectrumSample> samples, double wavelength) {
    if (samples.empty() || wavelength < samples.front().wavelength ||
        wavelength > samples.back().wavelength) {
        return 0.0;
    }
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const SpectrumSample& a = samples[i - 1];
        const SpectrumSample& b = samples[i];
        if (wavelength <= b.wavelength && b.wavelength > a.wavelength) {
            const double t = (wavelength - a.wavelength) / (b.wavelength - a.wavelength);
            return a.value + t * (b.value - a.value);
        }
    }
    return samples.back().value;
}

void check_order(const std::vector<SpectrumSample>& samples, const Location& where) {
    if (samples.size() < 2) {
        fail(where, "a spectrum needs at least two wavelengths");
    }
    for (std::size_t i = 1; i < samples.size(); ++i) {
        if (!(samples[i - 1].wavelength < samples[i].wavelength)) {
            fail(where, "the wavelengths of a spectrum should increase");
        }
    }
}

Color grey(double value) {
    const Vec3 rgb = Vec3{1, 1, 1} * static_cast<float>(value);
    return {rgb, rgb};
}

/// The property as a colour; a number is a grey, three numbers are linear RGB.
Color color_property(const Object& object, const std::string& name) {
    const Property* property = object.find(name);
    if (property == nullptr) {
        fail(object.where, object.tag + " '" + object.type + "' needs '" + name + "'");
    }
    if (std::holds_alternative<Triple>(property->value)) {
        const Triple t = object.triple(name, {});
        const Vec3 rgb{static_cast<float>(t[0]), static_cast<float>(t[1]), static_cast<float>(t[2])};
        return {rgb, rgb};
    }
    if (std::holds_alternative<std::string>(property->value)) {
        return parse_spectrum(object.string(name, ""), object.where);
    }
    return *object.color(name);
}

Color d65_color(const Object& object) {
    const Color color = object.has("color") ? color_property(object, "color") : grey(1.0);
    const auto scale = static_cast<float>(object.number("scale", 1.0));
    return {color.reflectance * scale, color.light * scale};
}

/// Values at equal steps from wavelength_min to wavelength_max, or at `wavelengths`.
Color sampled_color(const Object& object, bool is_regular) {
    if (object.has("value")) {
        return color_property(object, "value");
    }
    const std::vector<double> values = parse_numbers(object.required_string("values"), object.where);
    std::vector<SpectrumSample> samples;
    if (is_regular) {
        const double first = object.number("wavelength_min", kMinWavelength);
        const double last = object.number("wavelength_max", kMaxWavelength);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double t = static_cast<double>(i) / std::max<double>(1.0, double(values.size()) - 1.0);
            samples.push_back({first + t * (last - first), values[i]});
        }
    } else {
        const std::vector<double> wavelengths =
            parse_numbers(object.required_string("wavelengths"), object.where);
        if (wavelengths.size() != values.size()) {
            fail(object.where, "there should be as many 'values' as 'wavelengths'");
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            samples.push_back({wavelengths[i], values[i]});
        }
    }
    check_order(samples, object.where);
    return spectrum_color(samples);
}

/// A number of kelvins, after which old files write the unit.
double read_temperature(const Object& object) {
    const Property* property = object.find("temperature");
    if (property == nullptr) {
        fail(object.where, "a blackbody needs a 'temperature'");
    }
    double temperature = 0.0;
    if (std::holds_alternative<std::string>(property->value)) {
        std::string text = object.string("temperature", "");
        text.erase(std::find_if(text.begin(), text.end(), [](char c) { return c == 'k' || c == 'K'; }),
                   text.end());
        temperature = parse_number(text, object.where);
    } else {
        temperature = object.number("temperature", 0.0);
    }
    if (!(temperature > 0.0)) {
        fail(object.where, "the temperature of a blackbody should be greater than 0");
    }
    return temperature;
}

Color blackbody_object(const Object& object) {
    const Color color =
        blackbody_color(read_temperature(object), object.number("wavelength_min", kMinWavelength),
                        object.number("wavelength_max", kMaxWavelength));
    const auto scale = static_cast<float>(object.number("scale", 1.0));
    return {color.reflectance * scale, color.light * scale};
}

}  // namespace

Color uniform_color(double value) {
    const auto v = static_cast<float>(value);
    return {{v, v, v}, xyz_to_rgb({1.0, 1.0, 1.0}) * v};
}

Color spectrum_color(std::span<const SpectrumSample> samples) {
    return integrate([&](double wavelength) { return value_at(samples, wavelength); });
}

Color blackbody_color(double temperature, double min_wavelength, double max_wavelength) {
    constexpr double kLightSpeed = 2.99792458e8;
    constexpr double kPlanck = 6.62607015e-34;
    constexpr double kBoltzmann = 1.380649e-23;
    return integrate([&](double nanometres) {
        if (nanometres < min_wavelength || nanometres > max_wavelength) {
            return 0.0;
        }
        const double wavelength = nanometres * 1e-9;
        const double exponent = kPlanck * kLightSpeed / (wavelength * kBoltzmann * temperature);
        const double per_metre =
            2.0 * kPlanck * kLightSpeed * kLightSpeed / (std::pow(wavelength, 5.0) * std::expm1(exponent));
        return per_metre * 1e-9;
    });
}

Color parse_spectrum(const std::string& text, const Location& where) {
    if (text.find(':') == std::string::npos) {
        return uniform_color(parse_number(text, where));
    }
    std::vector<SpectrumSample> samples;
    for (const std::string& word : split_words(text)) {
        const std::size_t colon = word.find(':');
        if (colon == std::string::npos) {
            fail(where, "'" + word + "' is not a pair wavelength:value");
        }
        samples.push_back(
            {parse_number(word.substr(0, colon), where), parse_number(word.substr(colon + 1), where)});
    }
    check_order(samples, where);
    return spectrum_color(samples);
}

Color read_spectrum(const std::filesystem::path& file, const Location& where) {
    std::string text;
    try {
        text = read_file_text(file);
    } catch (const Error& error) {
        fail(where, error.what());
    }
    std::istringstream stream(text);
    std::vector<SpectrumSample> samples;
    for (std::string line; std::getline(stream, line);) {
        const std::vector<double> numbers = parse_numbers(line.substr(0, line.find('#')), where);
        if (numbers.size() >= 2) {
            samples.push_back({numbers[0], numbers[1]});
        }
    }
    check_order(samples, where);
    return spectrum_color(samples);
}

std::optional<Color> spectrum_object_color(const Object& object) {
    if (object.type == "blackbody") {
        return blackbody_object(object);
    }
    if (object.type == "d65" && object.nested("texture").empty()) {
        return d65_color(object);
    }
    if (object.type == "srgb") {
        object.ignore({"unbounded"});
        return color_property(object, "color");
    }
    if (object.type == "uniform") {
        object.ignore({"wavelength_min", "wavelength_max"});
        return grey(object.number("value", 1.0));
    }
    if (object.type == "rawconstant") {
        return color_property(object, "value");
    }
    if (object.type == "regular" || object.type == "irregular") {
        return sampled_color(object, object.type == "regular");
    }
    return std::nullopt;
}

}  // namespace nearlight::core::mitsuba
