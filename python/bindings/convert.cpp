// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/convert.h"

namespace nearlight::python {
namespace {

bool is_boolean(py::handle value) {
    return PyBool_Check(value.ptr()) != 0 ||
           std::string(Py_TYPE(value.ptr())->tp_name).starts_with("numpy.bool");
}

bool is_text(py::handle value) {
    return PyUnicode_Check(value.ptr()) != 0 || PyBytes_Check(value.ptr()) != 0;
}

bool is_name_or_number(py::handle value) {
    return !is_boolean(value) && (py::isinstance<py::str>(value) || PyIndex_Check(value.ptr()) != 0);
}

}  // namespace

std::string shown(py::handle object) {
    return encoded(py::repr(object));
}

py::str decoded(std::string_view text) {
    return py::reinterpret_steal<py::str>(PyUnicode_DecodeUTF8(text.data(), std::ssize(text), "replace"));
}

std::string encoded(py::handle text) {
    const auto bytes = py::reinterpret_steal<py::bytes>(PyUnicode_EncodeFSDefault(text.ptr()));
    if (!bytes) {
        throw py::error_already_set();
    }
    return bytes.cast<std::string>();
}

py::object to_python(const std::string& text) {
    return py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefaultAndSize(text.data(), std::ssize(text)));
}

void fail_type(const char* name, const std::string& wanted, py::handle value) {
    throw py::type_error(name + (" must be " + wanted + ", not " + shown(value)));
}

bool to_bool(const char* name, py::handle value) {
    if (!is_boolean(value)) {
        fail_type(name, "True or False", value);
    }
    return PyObject_IsTrue(value.ptr()) == 1;
}

std::int64_t to_integer(const char* name, py::handle value, std::int64_t min, std::int64_t max) {
    if (is_boolean(value) || PyIndex_Check(value.ptr()) == 0) {
        fail_type(name, "a whole number", value);
    }
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if (!index) {
        throw py::error_already_set();
    }
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow != 0 || number < min || number > max) {
        throw Error(ErrorKind::invalid_argument,
                    name + (" is " + shown(index)) + "; it must be from " + std::to_string(min) + " to " +
                        std::to_string(max),
                    name);
    }
    return number;
}

double to_double(const char* name, py::handle value) {
    const bool is_number =
        PyFloat_Check(value.ptr()) != 0 || PyIndex_Check(value.ptr()) != 0 || py::hasattr(value, "__float__");
    if (is_boolean(value) || is_text(value) || !is_number) {
        fail_type(name, "a number", value);
    }
    const double number = PyFloat_AsDouble(value.ptr());
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
        throw py::error_already_set();
    }
    return number;
}

Vec3 to_vector(const char* name, py::handle value) {
    if (is_text(value) || PySequence_Check(value.ptr()) == 0 || py::len(value) != 3) {
        fail_type(name, "three numbers", value);
    }
    const auto component = [&](int i) { return static_cast<float>(to_double(name, value[py::int_(i)])); };
    return {component(0), component(1), component(2)};
}

std::filesystem::path to_path(py::handle value) {
    PyObject* bytes = nullptr;
    if (PyUnicode_FSConverter(value.ptr(), &bytes) == 0) {
        throw py::error_already_set();
    }
    return {py::reinterpret_steal<py::bytes>(bytes).cast<std::string>()};
}

std::string to_name(const char* name, py::handle value) {
    if (!is_name_or_number(value)) {
        fail_type(name, "a name or a number", value);
    }
    return encoded(py::str(value));
}

py::object enumeration(const char* type) {
    return py::module_::import("nearlight._core").attr(type);
}

std::size_t to_member(const char* name, const char* type, py::handle value) {
    const py::object chosen = enumeration(type);
    const py::list members(chosen.attr("__members__"));
    const bool is_member = py::isinstance(value, chosen);
    const std::string names = encoded(py::str(", ").attr("join")(members));
    if (!is_member && PyUnicode_Check(value.ptr()) == 0) {
        fail_type(name, "one of " + names, value);
    }
    const py::object wanted = is_member ? value.attr("name") : py::reinterpret_borrow<py::object>(value);
    if (!members.contains(wanted)) {
        throw Error(ErrorKind::invalid_argument,
                    std::string("unknown ") + name + " " + shown(value) + "; choose one of: " + names, name);
    }
    return members.attr("index")(wanted).cast<std::size_t>();
}

std::vector<std::uint32_t> Convert<std::vector<std::uint32_t>>::from(const char* name, py::handle value) {
    if (is_text(value) || PySequence_Check(value.ptr()) == 0) {
        fail_type(name, "a sequence of whole numbers", value);
    }
    std::vector<std::uint32_t> numbers;
    for (const py::handle item : value) {
        numbers.push_back(Convert<std::uint32_t>::from(name, item));
    }
    return numbers;
}

std::vector<std::string> Convert<std::vector<std::string>>::from(const char* name, py::handle value) {
    if (is_text(value) || PySequence_Check(value.ptr()) == 0) {
        fail_type(name, "a sequence of names or numbers", value);
    }
    std::vector<std::string> texts;
    for (const py::handle item : value) {
        if (!is_name_or_number(item)) {
            fail_type(name, "a sequence of names or numbers", value);
        }
        texts.push_back(encoded(py::str(item)));
    }
    return texts;
}

std::map<std::string, std::string> Convert<std::map<std::string, std::string>>::from(const char* name,
                                                                                     py::handle value) {
    const py::object mapping = py::module_::import("collections.abc").attr("Mapping");
    if (!py::isinstance(value, mapping)) {
        fail_type(name, "a mapping of names to str or numbers", value);
    }
    std::map<std::string, std::string> result;
    for (const py::handle item : value.attr("items")()) {
        const auto [key, content] = item.cast<std::pair<py::object, py::object>>();
        const bool is_number = PyFloat_Check(content.ptr()) != 0 || PyIndex_Check(content.ptr()) != 0;
        if (!py::isinstance<py::str>(key) || is_boolean(content) ||
            (!py::isinstance<py::str>(content) && !is_number)) {
            fail_type(name, "a mapping of names to str or numbers", value);
        }
        result[encoded(key)] = encoded(py::str(content));
    }
    return result;
}

std::string Convert<std::string>::from(const char* name, py::handle value) {
    if (!py::isinstance<py::str>(value)) {
        fail_type(name, "a str", value);
    }
    return encoded(value);
}

}  // namespace nearlight::python
