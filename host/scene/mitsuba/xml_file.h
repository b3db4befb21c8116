// SPDX-License-Identifier: Apache-2.0
// One parsed XML file with line numbers.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

class XmlFile {
  public:
    /// Reads a file. Where it is not a scene that states a version, it has that of the file which includes
    /// it. Throws Error(ErrorKind::file) if it is missing or not well-formed.
    explicit XmlFile(const std::filesystem::path& file, bool is_includer_old = false);

    [[nodiscard]] pugi::xml_node root() const { return document_.document_element(); }
    /// Whether the file is one of Mitsuba 0.5 or 0.6. A scene that states no version is not.
    [[nodiscard]] bool is_old() const { return is_old_; }
    [[nodiscard]] Location location(const pugi::xml_node& node) const {
        return location(node.offset_debug());
    }

  private:
    [[nodiscard]] Location location(std::ptrdiff_t offset) const;

    std::shared_ptr<const std::filesystem::path> file_;
    pugi::xml_document document_;
    std::vector<std::ptrdiff_t> line_starts_;
    bool is_old_ = false;
};

/// What a $name stands for.
struct Definition {
    std::string value;
    mutable bool is_used = false;  ///< the file has the $name, or a <default> for it
};
/// Definitions by their names, without the dollar.
using Definitions = std::map<std::string, Definition>;

/// An element whose attributes are read with $names replaced.
struct Element {
    pugi::xml_node node;
    Location where;
    const Definitions& definitions;
    bool is_old = false;  ///< the file is one of Mitsuba 0.5 or 0.6

    [[nodiscard]] bool has(const char* attribute) const { return !node.attribute(attribute).empty(); }
    /// The text of an attribute, where \$ stands for a dollar; "" if there is no such attribute. Calls fail()
    /// for an undefined $name.
    [[nodiscard]] std::string text(const char* attribute) const;
    [[nodiscard]] std::string required(const char* attribute) const;
    [[nodiscard]] double number(const char* attribute, double fallback) const;
    /// Three numbers: "x,y,z" in the attribute called `list`, or the attributes x, y and z. In an attribute
    /// "value", one number stands for all three.
    [[nodiscard]] Triple triple(const char* list, double fallback) const;

  private:
    /// The parameter whose name begins there, after its dollar.
    [[nodiscard]] Definitions::const_iterator definition_at(const std::string& line, std::size_t begin) const;
};

/// Reads a <transform>. Its operations apply in order of appearance: each is multiplied from the left.
Mat4 read_transform(const XmlFile& file, const Element& element);

}  // namespace nearlight::core::mitsuba
