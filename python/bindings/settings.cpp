// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/settings.h"

#include <pybind11/stl.h>

#include <string>

namespace nearlight::python {
namespace {

/// The value as Python's source spells it.
template <typename Value>
std::string literal(const Value& value) {
    if constexpr (std::is_enum_v<Value>) {
        return shown(py::str(name_of(value)));
    } else {
        return shown(to_python(value));
    }
}

template <HasFields Settings>
std::string settings_text(const Settings& settings) {
    std::string text;
    for_each_field<Settings>([&](const auto& field) {
        text += (text.empty() ? "" : ", ") + std::string(field.name) + "=" + literal(settings.*field.member);
    });
    return FieldsOf<Settings>::name + ("(" + text + ")");
}

template <HasFields Settings>
bool are_equal(const Settings& a, const Settings& b) {
    bool equal = true;
    for_each_field<Settings>([&](const auto& field) {
        equal = equal && to_python(a.*field.member).equal(to_python(b.*field.member));
    });
    return equal;
}

template <HasFields Settings>
std::string class_doc() {
    std::string text = std::string(FieldsOf<Settings>::text) + "\n";
    for_each_field<Settings>(
        [&](const auto& field) { text += "\n" + std::string(field.name) + ": " + field.text; });
    return text;
}

/// The documentation of a constructor, in the form that inspect.signature() and help() take signatures from.
template <HasFields Settings>
std::string init_doc() {
    const Settings defaults{};
    std::string signature;
    for_each_field<Settings>([&](const auto& field) {
        using Value = std::remove_cvref_t<decltype(defaults.*field.member)>;
        signature += ", " + std::string(field.name) + "=";
        // Only literals can stand in a signature.
        signature += HasFields<Value> ? "None" : literal(defaults.*field.member);
    });
    const bool takes_more = std::same_as<Settings, RenderSettings>;
    return "__init__(self, *" + signature + (takes_more ? ", **fields" : "") + ")\n--\n\n" +
           (takes_more ? "fields: those of ViewSettings, SamplingSettings and GatherSettings." : "");
}

/// Members that are settings themselves are handed out by reference, so that settings.view.width = 64 works.
template <typename Class, typename Settings, typename Value>
void add_property(Class& cls, const Field<Settings, Value>& field) {
    const auto set = [field](Settings& settings, py::handle value) {
        settings.*field.member = value_of(field, value);
    };
    if constexpr (HasFields<Value>) {
        cls.def_property(
            field.name, [field](Settings& settings) -> Value& { return settings.*field.member; }, set,
            py::return_value_policy::reference_internal, field.text);
    } else {
        cls.def_property(
            field.name, [field](const Settings& settings) { return to_python(settings.*field.member); }, set,
            field.text);
    }
}

template <HasFields Settings>
void add_class(py::module_& module) {
    const char* const name = FieldsOf<Settings>::name;
    py::class_<Settings> cls(module, name, class_doc<Settings>().c_str());
    cls.def(py::init([name](const py::kwargs& keywords) {
                return settings_of<Settings>(name, "settings", py::none(), keywords);
            }),
            init_doc<Settings>().c_str());
    for_each_field<Settings>([&](const auto& field) { add_property(cls, field); });
    cls.def("__repr__", &settings_text<Settings>);
    cls.def("__eq__", [](const Settings& self, const py::object& other) -> py::object {
        return py::isinstance<Settings>(other) ? py::bool_(are_equal(self, other.cast<const Settings&>()))
                                               : py::reinterpret_borrow<py::object>(Py_NotImplemented);
    });
    cls.attr("__hash__") = py::none();
    cls.def("__copy__", [](const Settings& self) { return self; });
    cls.def("__deepcopy__", [](const Settings& self, const py::object&) { return self; });
}

/// A class of Python's module enum, whose members have their names as values, so that the class makes a
/// member of its name.
template <typename Enumeration>
void add_enumeration(py::module_& module) {
    using Table = MembersOf<Enumeration>;
    std::string text = std::string(Table::text) + "\n";
    py::dict values;
    for (const Member& member : Table::members) {
        text += "\n" + std::string(member.name) + ": " + member.text;
        values[member.name] = member.name;
    }
    const py::object make = py::module_::import("enum").attr("Enum");
    py::object type = make(Table::name, values, py::arg("module") = "nearlight");
    type.attr("__doc__") = text;
    module.attr(Table::name) = type;
}

}  // namespace

void fail_keyword(const std::string& what, const std::string& name, const py::list& names) {
    const py::list near = py::module_::import("difflib").attr("get_close_matches")(name, names, 1);
    std::string text = what + "() got an unexpected keyword argument '" + name + "'";
    if (py::len(near) > 0) {
        text += ", did you mean '" + near[0].cast<std::string>() + "'?";
    } else {
        text += "; it takes: " + py::str(", ").attr("join")(names).cast<std::string>();
    }
    throw py::type_error(text);
}

void add_settings(py::module_& module) {
    add_enumeration<SamplerKind>(module);
    add_enumeration<Policy>(module);
    add_enumeration<GatherKernel>(module);
    add_enumeration<BvhQuality>(module);
    add_enumeration<ToneCurve>(module);
    add_class<CameraPose>(module);
    add_class<ViewSettings>(module);
    add_class<SamplingSettings>(module);
    add_class<PixelWindow>(module);
    add_class<GatherSettings>(module);
    add_class<RenderSettings>(module);
    add_class<SessionOptions>(module);
    add_class<IrradianceSettings>(module);
    add_class<AnimationOptions>(module);
    add_class<SunPosition>(module);
    add_class<LoadOptions>(module);
    add_class<DeviceOptions>(module);
    add_class<WriteOptions>(module);
}

}  // namespace nearlight::python
