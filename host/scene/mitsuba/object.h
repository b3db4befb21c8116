// SPDX-License-Identifier: Apache-2.0
// A Mitsuba scene file as a tree of plugin objects with typed properties: defaults filled in, names in
// snake_case, includes read, references resolved, and the files that are named found.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host/base/math.h"
#include "host/scene/note_sink.h"

namespace nearlight::core::mitsuba {

struct Location {
    std::shared_ptr<const std::filesystem::path> file;
    int line = 0;
};
/// Throws Error(ErrorKind::file) with "file:line: what".
[[noreturn]] void fail(const Location& where, const std::string& what);

/// A colour as a reflectance and as a light. A `<spectrum>` of equal energy is white (1, 1, 1) as a
/// reflectance, but reddish as a light.
struct Color {
    Vec3 reflectance{};
    Vec3 light{};
};
using Triple = std::array<double, 3>;
using Value = std::variant<bool, double, std::string, Color, Triple, Mat4>;

struct Property {
    Value value;
    Location where;
    mutable bool used = false;
};

struct Object;
/// An object nested in another, or a reference to one by id.
struct Child {
    std::string name;
    const Object* object = nullptr;  ///< owned by the Document
    std::string reference;           ///< id of `object`, which is filled in once the whole file is read
    Location where;
    mutable bool used = false;
};

struct Object {
    std::string tag;   ///< "shape", "bsdf", …
    std::string type;  ///< "obj", "diffuse", …
    std::string id;
    Location where;
    bool is_old = false;                         ///< the file is one of Mitsuba 0.5 or 0.6
    std::map<std::string, Property> properties;  ///< "filename" is the path at which the file was found
    std::vector<Child> children;
    mutable bool is_on_shape = false;  ///< a shape of the picture has this emitter

    /// The property as a number, or `fallback` if there is none. This and the next functions call fail() if
    /// it has another type.
    [[nodiscard]] double number(const std::string& name, double fallback) const;
    [[nodiscard]] bool boolean(const std::string& name, bool fallback) const;
    [[nodiscard]] std::string string(const std::string& name, const std::string& fallback) const;
    /// The property as a string. Calls fail() if there is none.
    [[nodiscard]] std::string required_string(const std::string& name) const;
    /// The path that the property "filename" has. Calls fail() if there is none, or if the name is empty.
    [[nodiscard]] std::filesystem::path required_file() const;
    [[nodiscard]] Triple triple(const std::string& name, const Triple& fallback) const;
    [[nodiscard]] Mat4 transform(const std::string& name) const;
    /// The property as a colour, where a number is a grey; empty if there is none.
    [[nodiscard]] std::optional<Color> color(const std::string& name) const;
    [[nodiscard]] const Property* find(const std::string& name) const;
    [[nodiscard]] bool has(const std::string& name) const { return properties.contains(name); }
    /// Marks properties as known, although nothing uses them.
    void ignore(std::initializer_list<const char*> names) const;

    /// The nested texture called `name`, or null.
    [[nodiscard]] const Object* texture(const std::string& name) const;
    /// All nested objects with the tag, in order.
    [[nodiscard]] std::vector<const Object*> nested(const std::string& tag) const;

    /// The same with their names, which are "" where the file gives none.
    [[nodiscard]] std::vector<const Child*> children_of(const std::string& tag) const;

    /// Marks all nested objects with the tag as known.
    void ignore_nested(const std::string& wanted) const { static_cast<void>(nested(wanted)); }

    /// Adds a note for each property or nested object that nothing has asked for.
    void report_unused(NoteSink& notes) const;
};

/// Owns every object of a scene.
struct Document {
    std::vector<std::unique_ptr<Object>> objects;
    const Object* scene = nullptr;
};

/// Calls `visit` once for each of these objects and for all that lies within them, in their order, also where
/// they contain themselves. Asks for none of their properties.
void visit_all(const std::vector<const Object*>& objects, const std::function<void(const Object&)>& visit);

/// Calls fail() with the list of the known types.
[[noreturn]] void fail_unknown_type(const Object& object, const std::string& known);

/// The note about media of shapes, sensors and scenes. Mitsuba's integrators of surfaces leave them out, too.
inline constexpr const char* kMediaAreLeftOut =
    "participating media are left out; light passes through them as through a vacuum";

/// Notes an approximation at the place `where`.
void note(NoteSink& notes, const Location& where, const std::string& text);

}  // namespace nearlight::core::mitsuba
