// SPDX-License-Identifier: Apache-2.0
#include "host/compare/inline_svg.h"

#include <regex>

#include "host/compare/html_writer.h"

namespace nearlight::core {

std::string inline_svg(const std::string& file, const std::string& description, const std::string& name) {
    const std::size_t begin = file.find("<svg");
    const std::size_t end = file.rfind("</svg>");
    if (begin == std::string::npos || end == std::string::npos || end < begin) {
        return "";
    }
    std::string svg = file.substr(begin, end - begin) + "</svg>\n";
    const auto replace = [&svg](const char* pattern, const std::string& replacement) {
        svg = std::regex_replace(svg, std::regex(pattern), replacement);
    };
    replace(R"re(<(title|desc)>[^<]*</(title|desc)>\s*)re", "");
    replace(R"re(\s+xmlns(:xlink)?="[^"]*")re", "");  // pages in HTML do not need them
    replace(R"re((<g id="gnuplot_canvas">\s*<rect [^>]*fill=)"[^"]*")re", "$1\"none\"");
    replace(R"re((\bid=["']|href=["']#|url\(["']?#))re", "$1" + name + "-");
    replace(R"re((["'])(black|rgb\(\s*0,\s*0,\s*0\))(["']))re", "$1currentColor$3");
    return "<svg role=\"img\" aria-label=\"" + escaped(description) + "\"" + svg.substr(4);
}

}  // namespace nearlight::core
