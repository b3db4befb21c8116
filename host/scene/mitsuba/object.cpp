// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/object.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

template <typename T>
const T& get(const Property& property, const std::string& name, const char* kind) {
    property.used = true;
    const T* value = std::get_if<T>(&property.value);
    if (value == nullptr) {
        fail(property.where, "property '" + name + "' should be a " + kind);
    }
    return *value;
}

}  // namespace

void fail(const Location& where, const std::string& what) {
    throw Error(ErrorKind::file, to_string(Note{*where.file, where.line, what}));
}

void visit_all(const std::vector<const Object*>& objects, const std::function<void(const Object&)>& visit) {
    std::set<const Object*> seen;
    std::vector<const Object*> coming(objects.rbegin(), objects.rend());
    while (!coming.empty()) {
        const Object* const object = coming.back();
        coming.pop_back();
        if (object == nullptr || !seen.insert(object).second) {
            continue;
        }
        visit(*object);
        for (auto child = object->children.rbegin(); child != object->children.rend(); ++child) {
            coming.push_back(child->object);
        }
    }
}

void fail_unknown_type(const Object& object, const std::string& known) {
    fail(object.where, "unknown " + object.tag + " '" + object.type + "'; known ones are " + known);
}

void note(NoteSink& notes, const Location& where, const std::string& text) {
    notes.approximation(*where.file, where.line, text);
}

const Property* Object::find(const std::string& name) const {
    const auto found = properties.find(name);
    return found == properties.end() ? nullptr : &found->second;
}

double Object::number(const std::string& name, double fallback) const {
    const Property* property = find(name);
    return property == nullptr ? fallback : get<double>(*property, name, "number");
}

bool Object::boolean(const std::string& name, bool fallback) const {
    const Property* property = find(name);
    return property == nullptr ? fallback : get<bool>(*property, name, "boolean");
}

std::string Object::string(const std::string& name, const std::string& fallback) const {
    const Property* property = find(name);
    return property == nullptr ? fallback : get<std::string>(*property, name, "string");
}

std::string Object::required_string(const std::string& name) const {
    if (!has(name)) {
        fail(where, tag + " '" + type + "' needs a string '" + name + "'");
    }
    return string(name, "");
}

std::filesystem::path Object::required_file() const {
    const std::filesystem::path file = required_string("filename");
    if (file.empty()) {
        fail(find("filename")->where, "the 'filename' of " + tag + " '" + type + "' is empty");
    }
    return file;
}

Triple Object::triple(const std::string& name, const Triple& fallback) const {
    const Property* property = find(name);
    return property == nullptr ? fallback : get<Triple>(*property, name, "point or vector");
}

Mat4 Object::transform(const std::string& name) const {
    const Property* property = find(name);
    return property == nullptr ? Mat4{} : get<Mat4>(*property, name, "transform");
}

std::optional<Color> Object::color(const std::string& name) const {
    const Property* property = find(name);
    if (property == nullptr) {
        return std::nullopt;
    }
    if (const double* grey = std::get_if<double>(&property->value)) {
        property->used = true;
        const Vec3 rgb = Vec3{1, 1, 1} * static_cast<float>(*grey);
        return Color{rgb, rgb};
    }
    return get<Color>(*property, name, "colour");
}

void Object::ignore(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
        if (const Property* property = find(name)) {
            property->used = true;
        }
    }
}

const Object* Object::texture(const std::string& name) const {
    for (const Child& child : children) {
        if (child.name == name && child.object->tag == "texture") {
            child.used = true;
            return child.object;
        }
    }
    return nullptr;
}

std::vector<const Child*> Object::children_of(const std::string& wanted) const {
    std::vector<const Child*> found;
    for (const Child& child : children) {
        if (child.object->tag == wanted) {
            child.used = true;
            found.push_back(&child);
        }
    }
    return found;
}

std::vector<const Object*> Object::nested(const std::string& wanted) const {
    std::vector<const Object*> found;
    std::ranges::transform(children_of(wanted), std::back_inserter(found), &Child::object);
    return found;
}

void Object::report_unused(NoteSink& notes) const {
    for (const auto& [name, property] : properties) {
        if (!property.used) {
            note(notes, property.where,
                 "unknown property '" + name + "' of " + tag + " '" + type + "' is ignored");
        }
    }
    for (const Child& child : children) {
        if (!child.used) {
            note(notes, child.where,
                 "unexpected " + child.object->tag + (child.name.empty() ? "" : " '" + child.name + "'") +
                     " in " + tag + " '" + type + "' is ignored");
        }
    }
}

}  // namespace nearlight::core::mitsuba
