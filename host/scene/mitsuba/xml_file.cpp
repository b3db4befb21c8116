// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/xml_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "host/scene/file_text.h"
#include "host/scene/mitsuba/values.h"

namespace nearlight::core::mitsuba {
namespace {

/// The parameter with the longest name that `word` begins with: "$sizepx" may be "$size" and "px".
Definitions::const_iterator longest_beginning(const Definitions& definitions, const std::string& word) {
    for (std::size_t length = word.size(); length > 0; --length) {
        if (const auto found = definitions.find(word.substr(0, length)); found != definitions.end()) {
            return found;
        }
    }
    return definitions.end();
}

}  // namespace

XmlFile::XmlFile(const std::filesystem::path& file, bool is_includer_old)
    : file_(std::make_shared<const std::filesystem::path>(file)), line_starts_{0} {
    const std::string text = read_file_text(file);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\n') {
            line_starts_.push_back(static_cast<std::ptrdiff_t>(i) + 1);
        }
    }
    // Encodings are not converted, so that offsets are those of the file.
    const pugi::xml_parse_result result =
        document_.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result) {
        fail(location(result.offset), std::string("broken XML: ") + result.description());
    }
    const pugi::xml_attribute version = document_.child("scene").attribute("version");
    is_old_ = version.empty() ? is_includer_old : version.as_int() == 0;
}

Location XmlFile::location(std::ptrdiff_t offset) const {
    const auto next =
        std::upper_bound(line_starts_.begin(), line_starts_.end(), std::max<std::ptrdiff_t>(offset, 0));
    return {file_, static_cast<int>(next - line_starts_.begin())};
}

std::string Element::text(const char* attribute) const {
    const std::string written = node.attribute(attribute).value();
    std::string value;
    for (std::size_t at = 0; at < written.size();) {
        if (written.compare(at, 2, "\\$") == 0) {
            value += '$';
            at += 2;
        } else if (written[at] == '$') {
            const auto definition = definition_at(written, at + 1);
            value += definition->second.value;
            at += 1 + definition->first.size();
        } else {
            value += written[at++];
        }
    }
    return value;
}

Definitions::const_iterator Element::definition_at(const std::string& line, std::size_t begin) const {
    std::size_t end = begin;
    while (end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) || line[end] == '_')) {
        ++end;
    }
    const std::string word = line.substr(begin, end - begin);
    const auto found = longest_beginning(definitions, word);
    if (found == definitions.end()) {
        fail(where, "parameter '$" + word + "' has no value; give it one with -D " + word +
                        "=VALUE, or with a <default>; write \\$ for a dollar");
    }
    found->second.is_used = true;
    return found;
}

std::string Element::required(const char* attribute) const {
    if (!has(attribute)) {
        fail(where, std::string("<") + node.name() + "> needs an attribute '" + attribute + "'");
    }
    return text(attribute);
}

double Element::number(const char* attribute, double fallback) const {
    return has(attribute) ? parse_number(text(attribute), where) : fallback;
}

Triple Element::triple(const char* list, double fallback) const {
    if (!has(list)) {
        return {number("x", fallback), number("y", fallback), number("z", fallback)};
    }
    const std::vector<double> numbers = parse_numbers(text(list), where);
    if (numbers.size() == 1 && list == std::string_view("value")) {
        return {numbers[0], numbers[0], numbers[0]};
    }
    if (numbers.size() != 3) {
        fail(where, "'" + text(list) + "' should be three numbers");
    }
    return {numbers[0], numbers[1], numbers[2]};
}

namespace {

Mat4 read_matrix(const Element& element) {
    const std::vector<double> numbers = parse_numbers(element.required("value"), element.where);
    const int size = numbers.size() == 16 ? 4 : 3;
    if (numbers.size() != 16 && numbers.size() != 9) {
        fail(element.where, "a matrix should have 16 or 9 numbers, not " + std::to_string(numbers.size()));
    }
    Mat4 matrix;
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            matrix(row, column) = numbers[static_cast<std::size_t>(row * size + column)];
        }
    }
    return matrix;
}

Vec3 vec3_of(const Triple& t) {
    return {static_cast<float>(t[0]), static_cast<float>(t[1]), static_cast<float>(t[2])};
}

/// What is up where a lookat does not say it: an axis across the line of sight, which each version of Mitsuba
/// chooses in its own way.
Vec3 axis_across(Vec3 forward, bool is_old) {
    if (!is_old) {
        return orthonormal_basis(normalize(forward))[0];
    }
    const bool is_more_x = std::abs(forward.x) > std::abs(forward.y);
    const Vec3 side = is_more_x ? Vec3{forward.z, 0, -forward.x} : Vec3{0, forward.z, -forward.y};
    return cross(side, forward);
}

Mat4 read_lookat(const Element& element) {
    const Triple origin = element.triple("origin", 0.0);
    const Triple target = element.triple("target", 0.0);
    const Vec3 forward = vec3_of({target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]});
    if (is_zero(forward)) {
        fail(element.where, "the origin and the target of lookat are the same");
    }
    const Triple up = element.text("up").empty() ? Triple{} : element.triple("up", 0.0);
    if (up == Triple{}) {
        const Vec3 axis = axis_across(forward, element.is_old);
        return look_at(origin, target, {axis.x, axis.y, axis.z});
    }
    if (length(cross(vec3_of(up), forward)) <= 1e-7f * length(forward)) {
        fail(element.where, "the up vector of lookat is parallel to the line of sight");
    }
    return look_at(origin, target, up);
}

// Mitsuba 0.5 and 0.6 turn about an axis of any length. Mitsuba 2 and 3 put it into Rodrigues' formula as it
// stands, so that the same element also stretches if the axis is not of length 1.
Mat4 read_rotation(const Element& element) {
    const Triple axis = element.triple("value", 0.0);
    const double angle = element.number("angle", 0.0);
    if (axis == Triple{0, 0, 0}) {
        if (angle == 0.0) {
            return Mat4{};  // as exporters write it that turn nothing
        }
        fail(element.where, "rotate needs an axis that is not zero");
    }
    return element.is_old ? rotation(axis[0], axis[1], axis[2], angle)
                          : rodrigues(axis[0], axis[1], axis[2], angle);
}

Mat4 read_operation(const Element& element) {
    const std::string name = element.node.name();
    if (name == "matrix") {
        return read_matrix(element);
    }
    if (name == "lookat" || name == "lookAt" || name == "look_at") {
        return read_lookat(element);
    }
    if (name == "translate") {
        const Triple t = element.triple("value", 0.0);
        return translation(t[0], t[1], t[2]);
    }
    if (name == "scale") {
        const Triple s = element.triple("value", 1.0);
        return scaling(s[0], s[1], s[2]);
    }
    if (name == "rotate") {
        return read_rotation(element);
    }
    fail(element.where,
         "unknown transform <" + name + ">; known ones are matrix, lookat, translate, rotate, scale");
}

}  // namespace

Mat4 read_transform(const XmlFile& file, const Element& element) {
    Mat4 transform;
    for (const pugi::xml_node& node : element.node.children()) {
        if (node.type() == pugi::node_element) {
            transform =
                read_operation({node, file.location(node), element.definitions, element.is_old}) * transform;
        }
    }
    return transform;
}

}  // namespace nearlight::core::mitsuba
