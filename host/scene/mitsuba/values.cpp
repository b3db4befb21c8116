// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/values.h"

#include <cctype>
#include <charconv>
#include <sstream>

#include "host/scene/file_text.h"
#include "host/scene/texture.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr const char* kSeparators = ", \t\r\n";

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = text.find_first_not_of(kSeparators); begin != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(kSeparators, end);
    }
    return words;
}

// One lobe of a fit: a Gaussian with a different width on each side.
double lobe(double x, double center, double left, double right) {
    const double t = (x - center) * (x < center ? left : right);
    return std::exp(-0.5 * t * t);
}

// The CIE 1931 colour matching functions [Wyman et al., Simple Analytic Approximations to the CIE XYZ Color
// Matching Functions, JCGT 2013], as linear sRGB.
std::array<double, 3> matching_rgb(double w) {
    const double x = 0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
                     0.065 * lobe(w, 501.1, 0.0490, 0.0382);
    const double y = 0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322);
    const double z = 1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
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

// The colour of the equal-energy light E in linear sRGB, with luminance 1.
constexpr Vec3 kEqualEnergy{1.20479f, 0.94829f, 0.90892f};

}  // namespace

std::string snake_case(const std::string& name) {
    std::string snake;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        if (std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]))) {
            snake += '_';
        }
        snake += static_cast<char>(std::tolower(c));
    }
    return snake;
}

std::string lower_case(std::string text) {
    for (char& c : text) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return text;
}

double parse_number(const std::string& text, const Location& where) {
    const std::size_t first = text.find_first_not_of(" \t\r\n+");
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    double value = 0.0;
    if (first != std::string::npos) {
        const char* end = text.data() + last + 1;
        const auto [stop, error] = std::from_chars(text.data() + first, end, value);
        if (error == std::errc() && stop == end && std::isfinite(value)) {
            return value;
        }
        if (error == std::errc::result_out_of_range && stop == end &&
            text.find_first_of("eE") != std::string::npos &&
            text.find("-", text.find_first_of("eE")) != std::string::npos) {
            return 0.0;  // too small for a double
        }
    }
    fail(where, "'" + text + "' is not a finite number");
}

std::vector<double> parse_numbers(const std::string& text, const Location& where) {
    std::vector<double> numbers;
    for (const std::string& word : split(text)) {
        numbers.push_back(parse_number(word, where));
    }
    return numbers;
}

Color parse_rgb(const std::string& text, const Location& where) {
    const std::vector<std::string> words = split(text);
    if (words.size() == 1 && words[0].size() == 7 && words[0][0] == '#') {
        std::uint32_t code = 0;
        const char* end = words[0].data() + 7;
        if (std::from_chars(words[0].data() + 1, end, code, 16).ptr == end) {
            const std::uint32_t texel = (code >> 16) | (code & 0xff00u) | ((code & 0xffu) << 16);
            const Vec3 rgb = decode_texel(texel);
            return {rgb, rgb};
        }
    }
    const std::vector<double> n = parse_numbers(text, where);
    if (n.size() != 1 && n.size() != 3) {
        fail(where, "'" + text + "' is not a colour: one or three numbers, or #rrggbb");
    }
    const Vec3 rgb{static_cast<float>(n[0]), static_cast<float>(n[n.size() / 2]),
                   static_cast<float>(n.back())};
    return {rgb, rgb};
}

Color uniform_color(double value) {
    const auto v = static_cast<float>(value);
    return {{v, v, v}, kEqualEnergy * v};
}

Color spectrum_color(std::span<const SpectrumSample> samples) {
    std::array<double, 3> sum{};
    std::array<double, 3> white{};
    for (double wavelength = 360.5; wavelength < 830.0; wavelength += 1.0) {
        const std::array<double, 3> rgb = matching_rgb(wavelength);
        const double value = value_at(samples, wavelength);
        for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += rgb[c] * value;
            white[c] += rgb[c];
        }
    }
    const auto relative = [&](std::size_t c) { return static_cast<float>(std::max(0.0, sum[c] / white[c])); };
    const Vec3 reflectance{relative(0), relative(1), relative(2)};
    return {reflectance, reflectance * kEqualEnergy};
}

Color parse_spectrum(const std::string& text, const Location& where, NoteSink& notes) {
    if (text.find(':') == std::string::npos) {
        return uniform_color(parse_number(text, where));
    }
    std::vector<SpectrumSample> samples;
    for (const std::string& word : split(text)) {
        const std::size_t colon = word.find(':');
        if (colon == std::string::npos) {
            fail(where, "'" + word + "' is not a pair wavelength:value");
        }
        samples.push_back(
            {parse_number(word.substr(0, colon), where), parse_number(word.substr(colon + 1), where)});
    }
    note(notes, where, "spectra are reduced to three colours");
    return spectrum_color(samples);
}

Color read_spectrum(const std::filesystem::path& file, const Location& where, NoteSink& notes) {
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
    note(notes, where, "spectra are reduced to three colours");
    return spectrum_color(samples);
}

}  // namespace nearlight::core::mitsuba
