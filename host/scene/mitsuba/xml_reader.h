// SPDX-License-Identifier: Apache-2.0
// Makes the tree of objects from XML text, through pugixml, which only xml_file and xml_reader know.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// Reads the scene as objects. The values of $names in `definitions` win over <default>. Throws
/// Error(ErrorKind::file) with file and line for anything missing, broken or unknown.
Document read_xml(const std::filesystem::path& file, const std::map<std::string, std::string>& definitions,
                  NoteSink& notes);

}  // namespace nearlight::core::mitsuba
