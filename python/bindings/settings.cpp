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
        return shown(to_python(value).attr("name"));
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
        settings.*field.member = Convert<Value>::from(field.name, value);
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
                return settings_of<Settings>(name, py::none(), keywords);
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

void add_enumerations(py::module_& module) {
    py::enum_<SamplerKind>(module, "SamplerKind", "How virtual point lights (VPLs) are chosen.")
        .value("close_range", SamplerKind::close_range,
               "patches close to the camera, sparse light walks elsewhere")
        .value("instant_radiosity", SamplerKind::instant_radiosity, "light walks over the whole scene")
        .value("rejection", SamplerKind::rejection, "light walks; VPLs that bring little are rejected")
        .value("metropolis", SamplerKind::metropolis,
               "Markov chains of light paths towards what the camera needs")
        .value("bidirectional", SamplerKind::bidirectional, "light walks, and rays from what the camera sees")
        .value("local", SamplerKind::local, "light walks with a wide clamp, and local lights per tile");
    py::enum_<Policy>(module, "Policy", "The rule for deposits of light walks in the close range.")
        .value("complete", Policy::complete, "patches carry light of all depths: unbiased")
        .value("paper", Policy::paper, "deposits of all depths are dropped: loses light of several bounces")
        .value("partition", Policy::partition, "deposits of depth 2 and more are kept: unbiased");
    py::enum_<GatherKernel>(module, "GatherKernel", "Which kernel gathers. Both compute the same sum.")
        .value("automatic", GatherKernel::automatic, "packets on CPUs, rays elsewhere")
        .value("packets", GatherKernel::packets, "a work-item takes up to 256 receivers")
        .value("rays", GatherKernel::rays, "a work-item takes one receiver");
    py::enum_<BvhQuality>(module, "BvhQuality", "How much time the tree for rays is worth.")
        .value("fast", BvhQuality::fast, "every triangle is in exactly one leaf")
        .value("quality", BvhQuality::quality, "fewer steps per ray, twice the time to build");
    py::enum_<ToneCurve>(module, "ToneCurve", "From linear light to what a screen shows.")
        .value("linear", ToneCurve::linear, "as it is; what is above 1 is clipped")
        .value("neutral", ToneCurve::neutral, "colours as they are up to 0.76, softly limited above")
        .value("agx", ToneCurve::agx, "a photograph's contrast, where bright colours fade to white")
        .value("filmic", ToneCurve::filmic, "strong contrast of film");
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
    add_enumerations(module);
    add_class<CameraPose>(module);
    add_class<ViewSettings>(module);
    add_class<SamplingSettings>(module);
    add_class<PixelWindow>(module);
    add_class<GatherSettings>(module);
    add_class<RenderSettings>(module);
    add_class<SessionOptions>(module);
    add_class<IrradianceSettings>(module);
    add_class<SunPosition>(module);
    add_class<LoadOptions>(module);
    add_class<DeviceOptions>(module);
    add_class<WriteOptions>(module);
}

}  // namespace nearlight::python
