// SPDX-License-Identifier: Apache-2.0
// The Python classes of settings, and settings from the arguments of functions.
#pragma once

#include <pybind11/pybind11.h>

#include <concepts>
#include <string>
#include <type_traits>

#include "python/bindings/convert.h"
#include "python/bindings/settings_fields.h"

namespace nearlight::python {

/// Makes the classes of the module that have tables in settings_fields.h.
void add_settings(py::module_& module);

/// Throws Python's TypeError for the keyword `name`, which `what` does not take, with the nearest of `names`.
[[noreturn]] void fail_keyword(const std::string& what, const std::string& name, const py::list& names);

template <typename T>
concept HasFields = requires {
    FieldsOf<T>::fields;
};

/// Whether keyword arguments may name the fields of a member directly, as in render(width=64).
template <typename Owner, typename T>
inline constexpr bool kIsFlat = std::same_as<Owner, RenderSettings>&& HasFields<T>;

/// What a field becomes that is set to `value`.
template <typename Settings, typename Value>
Value value_of(const Field<Settings, Value>& field, py::handle value) {
    if constexpr (std::same_as<Value, std::string>) {
        if (field.takes_numbers) {
            return to_name(field.name, value);
        }
    }
    return Convert<Value>::from(field.name, value);
}

template <HasFields Settings>
void add_names(py::list& names) {
    for_each_field<Settings>([&](const auto& field) {
        names.append(field.name);
        using Value = std::remove_cvref_t<decltype(std::declval<Settings>().*field.member)>;
        if constexpr (kIsFlat<Settings, Value>) {
            add_names<Value>(names);
        }
    });
}

/// Sets the field of that name, also in a flat member. Returns whether there is one.
template <HasFields Settings>
bool assign(Settings& settings, const std::string& name, py::handle value) {
    bool found = false;
    for_each_field<Settings>([&](const auto& field) {
        using Value = std::remove_cvref_t<decltype(settings.*field.member)>;
        if (name == field.name) {
            settings.*field.member = value_of(field, value);
            found = true;
        } else if constexpr (kIsFlat<Settings, Value>) {
            found = found || assign(settings.*field.member, name, value);
        }
    });
    return found;
}

/// The settings of a call of `what`: those of the argument of that name, or the defaults if it is None, with
/// the fields that keywords name. Whole members are set before single fields of them.
template <HasFields Settings>
Settings settings_of(const std::string& what, const char* argument, py::handle settings,
                     const py::kwargs& keywords) {
    Settings result = settings.is_none() ? Settings{} : Convert<Settings>::from(argument, settings);
    for (const bool whole : {true, false}) {
        for (const auto& [key, value] : keywords) {
            const auto name = py::cast<std::string>(key);
            bool names_member = false;
            for_each_field<Settings>([&](const auto& field) {
                using Value = std::remove_cvref_t<decltype(result.*field.member)>;
                names_member = names_member || (kIsFlat<Settings, Value> && name == field.name);
            });
            if (names_member == whole && !assign(result, name, value)) {
                py::list names;
                add_names<Settings>(names);
                fail_keyword(what, name, names);
            }
        }
    }
    return result;
}

}  // namespace nearlight::python
