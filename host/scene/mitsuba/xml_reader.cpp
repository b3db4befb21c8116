// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/xml_reader.h"

#include <algorithm>

#include "host/base/words.h"
#include "host/scene/mitsuba/file_search.h"
#include "host/scene/mitsuba/spectra.h"
#include "host/scene/mitsuba/values.h"
#include "host/scene/mitsuba/xml_file.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

// More levels than any real scene has. The bound protects the stack from hostile files.
constexpr int kMaxXmlDepth = 64;

constexpr const char* kObjectTags[] = {"scene",  "shape",  "bsdf",    "texture",   "emitter",
                                       "sensor", "film",   "sampler", "rfilter",   "integrator",
                                       "medium", "volume", "phase",   "subsurface"};

bool is_object(const std::string& tag) {
    return std::find(std::begin(kObjectTags), std::end(kObjectTags), tag) != std::end(kObjectTags);
}

bool parse_boolean(const std::string& text, const Location& where) {
    const std::string word = lower_case(text);
    if (word == "true" || word == "1") {
        return true;
    }
    if (word == "false" || word == "0") {
        return false;
    }
    fail(where, "'" + text + "' should be true or false");
}

/// Mitsuba 3 writes spectra with a type as textures, and 0.5 has an element for black bodies.
bool is_spectrum_object(const Element& element, const std::string& tag) {
    return (tag == "spectrum" && element.has("type")) || tag == "blackbody";
}

class Reader {
  public:
    Reader(const std::filesystem::path& scene, const std::map<std::string, std::string>& values,
           NoteSink& notes)
        : files_(scene), notes_(notes) {
        for (const auto& [name, value] : values) {
            definitions_.emplace(name, Definition{value});
        }
    }

    Document read_scene(const std::filesystem::path& path) {
        const XmlFile file(path);
        std::error_code ignored;
        open_files_ = {std::filesystem::weakly_canonical(path, ignored)};
        if (file.root().name() != std::string("scene")) {
            fail(file.location(file.root()), "not a Mitsuba scene: the outermost element should be <scene>");
        }
        document_.scene = read_object(file, file.root(), 0);
        check_definitions(path);
        for (const auto& object : document_.objects) {
            resolve(*object);
            find_file(*object);
        }
        // Nested objects stand behind their owners.
        for (auto object = document_.objects.rbegin(); object != document_.objects.rend(); ++object) {
            take_spectra(**object);
        }
        return std::move(document_);
    }

  private:
    const Object* read_object(const XmlFile& file, const pugi::xml_node& node, int depth) {
        const Element element{node, file.location(node), definitions_, file.is_old()};
        if (depth > kMaxXmlDepth) {
            fail(element.where, "elements are nested too deeply");
        }
        Object* object = document_.objects.emplace_back(std::make_unique<Object>()).get();
        object->tag = node.name();
        if (is_spectrum_object(element, object->tag)) {
            object->tag = "texture";
        }
        object->where = element.where;
        object->id = element.text("id");
        object->is_old = element.is_old;
        if (object->tag == "texture" && element.node.name() == std::string("blackbody")) {
            read_old_blackbody(element, *object);
        } else {
            object->type = object->tag == "scene" ? "scene" : element.required("type");
        }
        read_children(file, node, *object, depth);
        if (!object->id.empty() && !by_id_.emplace(object->id, object).second) {
            fail(element.where, "id '" + object->id + "' is used twice");
        }
        return object;
    }

    /// <blackbody temperature="5000K" scale="2"/> of Mitsuba 0.5.
    static void read_old_blackbody(const Element& element, Object& object) {
        object.type = "blackbody";
        object.properties.emplace("temperature", Property{element.required("temperature"), element.where});
        if (element.has("scale")) {
            object.properties.emplace(
                "scale", Property{parse_number(element.text("scale"), element.where), element.where});
        }
    }

    void read_children(const XmlFile& file, const pugi::xml_node& parent, Object& object, int depth) {
        for (const pugi::xml_node& node : parent.children()) {
            if (node.type() == pugi::node_element) {
                read_child(file, {node, file.location(node), definitions_, file.is_old()}, object, depth);
            }
        }
    }

    void read_child(const XmlFile& file, const Element& element, Object& parent, int depth) {
        const std::string tag = element.node.name();
        if (tag == "default") {
            definitions_.emplace(element.required("name"), Definition{element.required("value")})
                .first->second.is_used = true;
        } else if (tag == "include") {
            include(files_.find(element.required("filename"), element.where), element, parent, depth);
        } else if (tag == "path") {
            add_folder(element, parent);
        } else if (tag == "alias") {
            add_alias(element);
        } else if (tag == "ref") {
            parent.children.push_back(
                {snake_case(element.text("name")), nullptr, element.required("id"), element.where});
        } else if (is_object(tag) || is_spectrum_object(element, tag)) {
            const Object* child = read_object(file, element.node, depth + 1);
            parent.children.push_back({snake_case(element.text("name")), child, "", element.where});
        } else {
            Property property{read_value(file, element, tag), element.where};
            const std::string name = snake_case(element.required("name"));
            if (parent.properties.contains(name)) {
                if (!element.is_old) {
                    fail(element.where, "property '" + name + "' is given twice");
                }
                note(notes_, element.where, "property '" + name + "' is given twice; this one counts");
            }
            parent.properties.insert_or_assign(name, std::move(property));
        }
    }

    void include(const std::filesystem::path& path, const Element& element, Object& parent, int depth) {
        if (depth > kMaxXmlDepth) {
            fail(element.where, "files include one another too deeply");
        }
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored)) {
            fail(element.where, "included file '" + path.string() + "' cannot be read");
        }
        const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, ignored);
        if (std::ranges::find(open_files_, canonical) != open_files_.end()) {
            fail(element.where, "'" + path.string() + "' includes itself");
        }
        open_files_.push_back(canonical);
        const XmlFile file(path, element.is_old);
        if (file.root().name() == std::string("scene")) {
            read_children(file, file.root(), parent, depth + 1);
        } else {
            read_child(file, {file.root(), file.location(file.root()), definitions_, file.is_old()}, parent,
                       depth + 1);
        }
        open_files_.pop_back();
    }

    void add_folder(const Element& element, const Object& parent) {
        if (parent.tag != "scene") {
            fail(element.where, "<path> should stand directly in <scene>");
        }
        files_.add_folder(element.required("value"), element.where);
    }

    void add_alias(const Element& element) {
        const auto found = by_id_.find(element.required("id"));
        if (found == by_id_.end()) {
            fail(element.where, "this is an alias of the unknown id '" + element.text("id") + "'");
        }
        by_id_.emplace(element.required("as"), found->second);
    }

    Value read_value(const XmlFile& file, const Element& element, const std::string& tag) {
        if (tag == "float" || tag == "integer") {
            return parse_number(element.required("value"), element.where);
        }
        if (tag == "boolean") {
            return parse_boolean(element.required("value"), element.where);
        }
        if (tag == "string") {
            return element.required("value");
        }
        if (tag == "rgb") {
            return parse_rgb(element.required("value"), element.where, {.is_hex_srgb = !element.is_old});
        }
        if (tag == "srgb") {
            return parse_rgb(element.required("value"), element.where, {.are_numbers_srgb = true});
        }
        if (tag == "spectrum") {
            return read_spectrum_value(element);
        }
        if (tag == "point" || tag == "vector") {
            return element.triple("value", 0.0);
        }
        if (tag == "transform") {
            return read_transform(file, element);
        }
        fail(element.where, "unknown element <" + tag + ">");
    }

    Color read_spectrum_value(const Element& element) {
        if (element.has("filename")) {
            if (element.text("filename").empty()) {
                fail(element.where, "the 'filename' of this spectrum is empty");
            }
            return read_spectrum(files_.find(element.text("filename"), element.where), element.where);
        }
        const std::string text = element.required("value");
        // Mitsuba 0.5 took three numbers, or a colour code, for linear sRGB, and one number for white light.
        const bool is_curve = text.find(':') != std::string::npos;
        const bool is_color = split_words(text).size() > 1 || text.find('#') != std::string::npos;
        if (!is_curve && (is_color || element.is_old)) {
            return parse_rgb(text, element.where);
        }
        return parse_spectrum(text, element.where);
    }

    void resolve(Object& object) const {
        for (Child& child : object.children) {
            if (child.object != nullptr) {
                continue;
            }
            const auto found = by_id_.find(child.reference);
            if (found == by_id_.end()) {
                fail(child.where, "nothing has the id '" + child.reference + "'");
            }
            child.object = found->second;
        }
    }

    /// Replaces the name of the object's file by its path. A <path> counts for the whole scene, wherever it
    /// stands. An empty name stays, and is an error only if something asks for the file.
    void find_file(Object& object) const {
        if (const auto found = object.properties.find("filename"); found != object.properties.end()) {
            if (auto* name = std::get_if<std::string>(&found->second.value);
                name != nullptr && !name->empty()) {
                *name = files_.find(*name, found->second.where).string();
            }
        }
    }

    void take_spectra(Object& object) const {
        for (Child& child : object.children) {
            take_spectrum(object, child);
        }
        std::erase_if(object.children, [](const Child& child) { return child.object == nullptr; });
    }

    /// Turns a nested spectrum into a property of its owner. A d65 that multiplies a texture is the texture
    /// in RGB.
    void take_spectrum(Object& owner, Child& child) const {
        if (child.object->tag != "texture" || owner.tag == "scene") {
            return;
        }
        if (child.object->type == "d65") {
            if (const auto nested = child.object->nested("texture"); !nested.empty()) {
                if (child.object->number("scale", 1.0) != 1.0) {
                    note(notes_, child.where,
                         "the 'scale' of a d65 around a texture is left out, as Mitsuba does in RGB");
                }
                child.object->report_unused(notes_);
                child.object = nested.front();
            }
        }
        const std::optional<Color> color = spectrum_object_color(*child.object);
        if (!color) {
            return;
        }
        child.object->report_unused(notes_);
        if (!owner.properties.emplace(child.name, Property{*color, child.where}).second) {
            fail(child.where, "property '" + child.name + "' is given twice");
        }
        child.object = nullptr;
    }

    /// A name that the file does not have is misspelt.
    void check_definitions(const std::filesystem::path& path) const {
        std::vector<std::string> known;
        for (const auto& [name, definition] : definitions_) {
            if (definition.is_used) {
                known.push_back(name);
            }
        }
        for (const auto& [name, definition] : definitions_) {
            if (!definition.is_used) {
                throw Error(ErrorKind::invalid_argument,
                            path.string() + ": has no parameter '" + name + "'; " +
                                (known.empty() ? "it has none" : "it has: " + joined(known, ", ")));
            }
        }
    }

    FileSearch files_;
    std::vector<std::filesystem::path> open_files_;  // the scene's file, and those that include one another
    Definitions definitions_;
    NoteSink& notes_;
    Document document_;
    std::map<std::string, const Object*> by_id_;
};

}  // namespace

Document read_xml(const std::filesystem::path& file, const std::map<std::string, std::string>& definitions,
                  NoteSink& notes) {
    return Reader(file, definitions, notes).read_scene(file);
}

}  // namespace nearlight::core::mitsuba
