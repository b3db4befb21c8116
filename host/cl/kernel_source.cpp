// SPDX-License-Identifier: Apache-2.0
#include "host/cl/kernel_source.h"

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "host/base/hash.h"
#include "kernels/embedded.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

std::string read_kernel(const std::string& name, const std::filesystem::path& kernel_dir,
                        const std::string& includer) {
    if (kernel_dir.empty()) {
        if (const auto text = embedded_kernel(name)) {
            return std::string(*text);
        }
    } else if (std::ifstream file(kernel_dir / name); file) {
        std::ostringstream text;
        text << file.rdbuf();
        return text.str();
    }
    const std::string where =
        kernel_dir.empty() ? "in this binary" : "in " + kernel_dir.string() + ", which must hold all of them";
    throw Error(ErrorKind::kernel_build,
                "no kernel file '" + name + "' " + where +
                    (includer.empty() ? "" : " (included by " + includer + ")"),
                kernel_dir.empty() ? "" : "kernel_dir");
}

void expand(const std::string& name, const std::filesystem::path& kernel_dir, const std::string& includer,
            std::set<std::string>& seen, std::ostringstream& out) {
    if (!seen.insert(name).second) {
        return;
    }
    static const std::regex include_line(R"re(^\s*#\s*include\s+"([^"]+)".*$)re");
    std::istringstream lines(read_kernel(name, kernel_dir, includer));
    out << "#line 1 \"" << name << "\"\n";
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (line.find("include") != std::string::npos && std::regex_match(line, match, include_line)) {
            expand(match[1].str(), kernel_dir, name, seen, out);
            out << "#line " << number + 1 << " \"" << name << "\"\n";
        } else {
            out << line << '\n';
        }
    }
}

}  // namespace

std::string expand_kernel_source(const std::string& name, const std::filesystem::path& kernel_dir) {
    std::set<std::string> seen;
    std::ostringstream out;
    expand(name, kernel_dir, "", seen, out);
    return out.str();
}

std::uint64_t kernels_hash(const std::filesystem::path& kernel_dir) {
    Hasher hasher;
    for (const std::string_view name : embedded_kernel_names()) {
        hasher.add_text(name);
        try {
            hasher.add_text(expand_kernel_source(std::string(name), kernel_dir));
        } catch (const Error&) {
            hasher.add_text("");
        }
    }
    return hasher.hash64();
}

}  // namespace nearlight::core
