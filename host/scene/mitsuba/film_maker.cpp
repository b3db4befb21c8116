// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/film_maker.h"

#include <cmath>
#include <sstream>

#include "host/base/words.h"
#include "host/scene/mitsuba/values.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr int kMaxSide = 1 << 16;
constexpr double kMaxFilterRadius = 16.0;

void apply_size(const Object& film, const FilmSize& size, SceneCamera& camera) {
    camera.width = whole_number(film, "crop_width", size.width, 1, kMaxSide);
    camera.height = whole_number(film, "crop_height", size.height, 1, kMaxSide);
    const int x = whole_number(film, "crop_offset_x", 0, 0, kMaxSide);
    const int y = whole_number(film, "crop_offset_y", 0, 0, kMaxSide);
    if (x + camera.width > size.width || y + camera.height > size.height) {
        fail(film.where, "the film's crop reaches beyond its " + std::to_string(size.width) + "x" +
                             std::to_string(size.height) + " pixels");
    }
    camera.film_part = static_cast<double>(camera.width) / size.width;
    camera.center_x = (x + 0.5 * camera.width - 0.5 * size.width) / size.width;
    camera.center_y = (y + 0.5 * camera.height - 0.5 * size.height) / size.width;
}

void apply_pixel_format(const Object& film, SceneCamera& camera) {
    const std::string format = lower_case(film.string("pixel_format", "rgb"));
    camera.is_monochrome = format == "luminance" || format == "luminance_alpha" || format == "luminancealpha";
    if (!camera.is_monochrome && format != "rgb" && format != "rgba") {
        fail(film.find("pixel_format")->where, "the pixel_format '" + format +
                                                   "' is not supported; known ones are luminance, "
                                                   "luminance_alpha, rgb, rgba");
    }
}

double filter_number(const Object& filter, const char* name, double fallback, double max_value) {
    const double value = filter.number(name, fallback);
    if (!(value > 0.0 && value <= max_value)) {
        fail(filter.find(name)->where,
             std::string("'") + name + "' should be greater than 0 and at most " + std::to_string(max_value));
    }
    return value;
}

PixelFilter make_filter(const Object& object, NoteSink& notes) {
    const std::optional<FilterKind> kind = filter_kind(object.type);
    if (!kind) {
        fail_unknown_type(object, filter_names());
    }
    PixelFilter filter = default_filter(*kind);
    switch (*kind) {
        case FilterKind::box:
        case FilterKind::tent:
            filter.radius = filter_number(object, "radius", filter.radius, kMaxFilterRadius);
            break;
        case FilterKind::gaussian:
            filter.radius =
                4.0 * filter_number(object, "stddev", filter.radius / 4.0, kMaxFilterRadius / 4.0);
            break;
        case FilterKind::mitchell:
            filter.b = object.number("b", filter.b);
            filter.c = object.number("c", filter.c);
            break;
        case FilterKind::catmull_rom:
            break;
        case FilterKind::lanczos:
            filter.radius = whole_number(object, "lobes", 3, 1, static_cast<int>(kMaxFilterRadius));
            break;
    }
    object.report_unused(notes);
    return filter;
}

/// Notes what an ldrfilm of Mitsuba 0.5 and 0.6 does to the numbers of its pictures beside sRGB.
void note_look(const Object& film, NoteSink& notes) {
    const auto leave_out = [&](const char* name, const std::string& value, const std::string& advice) {
        note(notes, film.find(name)->where,
             "the film's " + std::string(name) + " '" + value + "' is left out; " + advice);
    };
    const auto text_of = [](double number) {
        std::ostringstream text;
        text << number;
        return text.str();
    };
    const double exposure = film.number("exposure", 0.0);
    if (const std::string method = lower_case(film.string("tonemap_method", "gamma")); method != "gamma") {
        leave_out("tonemap_method", method, "--exposure and --tonemap choose the look of PNG pictures");
    } else if (exposure != 0.0) {
        leave_out("exposure", text_of(exposure), "PNG pictures have it with --exposure " + text_of(exposure));
    }
    // Nobody sees the difference between a gamma of 2.2 and sRGB, which −1 stands for.
    const double gamma = film.number("gamma", -1.0);
    if (gamma != -1.0 && std::abs(gamma - 2.2) > 0.01) {
        leave_out("gamma", text_of(gamma), "PNG pictures are sRGB; --tonemap chooses their tone curve");
    }
}

}  // namespace

int whole_number(const Object& object, const char* name, int fallback, int low, int high) {
    const double value = object.number(name, fallback);
    if (!(value >= low && value <= high)) {
        fail(object.find(name)->where, std::string("'") + name + "' should be from " + std::to_string(low) +
                                           " to " + std::to_string(high));
    }
    return static_cast<int>(value);
}

FilmSize apply_film(const Object& film, SceneCamera& camera, NoteSink& notes) {
    if (film.type != "hdrfilm" && film.type != "ldrfilm" && film.type != "tiledhdrfilm") {
        fail_unknown_type(film, "hdrfilm, ldrfilm, tiledhdrfilm");
    }
    const FilmSize size{whole_number(film, "width", 768, 1, kMaxSide),
                        whole_number(film, "height", 576, 1, kMaxSide)};
    apply_size(film, size, camera);
    apply_pixel_format(film, camera);
    camera.sample_border = film.boolean("sample_border", false) || film.boolean("high_quality_edges", false);
    const std::vector<const Object*> filters = film.nested("rfilter");
    if (filters.size() > 1) {
        fail(filters[1]->where, "a film has only one reconstruction filter");
    }
    if (!filters.empty()) {
        camera.filter = make_filter(*filters.front(), notes);
    }
    if (film.type == "ldrfilm") {
        note_look(film, notes);
    }
    // These say how Mitsuba writes its files.
    film.ignore({"file_format", "component_format", "banner", "compensate", "attach_log", "gamma", "exposure",
                 "key", "burn", "tonemap_method"});
    film.report_unused(notes);
    return size;
}

}  // namespace nearlight::core::mitsuba
