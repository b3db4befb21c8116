// SPDX-License-Identifier: Apache-2.0
// Values of settings from Python objects, with errors that name the setting, what is wrong and what it takes.
#pragma once

#include <pybind11/pybind11.h>

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nearlight/nearlight.h"
#include "python/bindings/enumerations.h"

namespace nearlight::python {

namespace py = pybind11;

/// repr() of an object, for messages.
std::string shown(py::handle object);
/// Text for people. What is no UTF-8, such as the name of a file, is replaced by question marks.
py::str decoded(std::string_view text);
/// The bytes of a str, which may be the name of a file that is no UTF-8 (os.fsencode()).
std::string encoded(py::handle text);
/// Throws Python's TypeError: "NAME must be WANTED, not VALUE".
[[noreturn]] void fail_type(const char* name, const std::string& wanted, py::handle value);

bool to_bool(const char* name, py::handle value);
/// Takes whole numbers of any Python or NumPy type in [min, max]; others throw
/// Error(ErrorKind::invalid_argument).
std::int64_t to_integer(const char* name, py::handle value, std::int64_t min, std::int64_t max);
double to_double(const char* name, py::handle value);
Vec3 to_vector(const char* name, py::handle value);
/// Takes str, bytes or os.PathLike, as Python's own functions do.
std::filesystem::path to_path(py::handle value);
/// Takes a name, or a whole number that stands for one.
std::string to_name(const char* name, py::handle value);
/// Takes a member of the module's enumeration `type` or the name of one; returns its place.
std::size_t to_member(const char* name, const char* type, py::handle value);

/// The class of the module with that name.
py::object enumeration(const char* type);

/// Converts a value of a setting; one specialisation a type.
template <typename T>
struct Convert {
    static T from(const char* name, py::handle value) {
        if constexpr (std::same_as<T, bool>) {
            return to_bool(name, value);
        } else if constexpr (std::integral<T>) {
            return static_cast<T>(
                to_integer(name, value, std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
        } else if constexpr (std::floating_point<T>) {
            return static_cast<T>(to_double(name, value));
        } else if constexpr (std::is_enum_v<T>) {
            return static_cast<T>(to_member(name, MembersOf<T>::name, value));
        } else {
            if (!py::isinstance<T>(value)) {
                fail_type(name, "a " + py::type::of<T>().attr("__name__").template cast<std::string>(),
                          value);
            }
            return value.cast<T>();
        }
    }
};

template <>
struct Convert<Vec3> {
    static Vec3 from(const char* name, py::handle value) { return to_vector(name, value); }
};

template <typename T>
struct Convert<std::optional<T>> {
    static std::optional<T> from(const char* name, py::handle value) {
        return value.is_none() ? std::nullopt : std::optional<T>(Convert<T>::from(name, value));
    }
};

template <>
struct Convert<std::vector<std::uint32_t>> {
    static std::vector<std::uint32_t> from(const char* name, py::handle value);
};

/// Numbers may stand for names, as those of animations do.
template <>
struct Convert<std::vector<std::string>> {
    static std::vector<std::string> from(const char* name, py::handle value);
};

template <>
struct Convert<std::map<std::string, std::string>> {
    static std::map<std::string, std::string> from(const char* name, py::handle value);
};
template <>
struct Convert<std::string> {
    static std::string from(const char* name, py::handle value);
};
template <>
struct Convert<std::filesystem::path> {
    static std::filesystem::path from(const char*, py::handle value) { return to_path(value); }
};

/// The seed that functions take beside their settings.
inline std::uint32_t to_seed(py::handle value) {
    return Convert<std::uint32_t>::from("seed", value);
}

/// A value of a setting for Python.
template <typename T>
py::object to_python(const T& value) {
    if constexpr (std::is_enum_v<T>) {
        return enumeration(MembersOf<T>::name)(name_of(value));
    } else {
        return py::cast(value);
    }
}
inline py::object to_python(Vec3 value) {
    return py::make_tuple(value.x, value.y, value.z);
}
template <typename T>
py::object to_python(const std::optional<T>& value) {
    return value ? to_python(*value) : py::none();
}
inline py::object to_python(const std::vector<std::uint32_t>& values) {
    py::list list;
    for (const std::uint32_t value : values) {
        list.append(value);
    }
    return list;
}

/// The str that encoded() makes this text of (os.fsdecode()).
py::object to_python(const std::string& text);
inline py::object to_python(const std::vector<std::string>& texts) {
    py::list list;
    for (const std::string& text : texts) {
        list.append(to_python(text));
    }
    return list;
}
inline py::object to_python(const std::filesystem::path& path) {
    return to_python(path.string());
}
inline py::object to_python(const std::map<std::string, std::string>& values) {
    py::dict dict;
    for (const auto& [name, value] : values) {
        dict[to_python(name)] = to_python(value);
    }
    return dict;
}

}  // namespace nearlight::python
