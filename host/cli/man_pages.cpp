// SPDX-License-Identifier: Apache-2.0
#include "host/cli/man_pages.h"
#include "host/base/words.h"

#include <algorithm>
#include <cctype>

namespace nearlight::core {
namespace {

constexpr const char* kEnvironment = R"(.SH ENVIRONMENT
.TP
.B NEARLIGHT_DEVICE
The devices to use where \fB\-\-device\fR is not given.
.TP
.B NEARLIGHT_CACHE_DIR
The folder for compiled kernels, trees and tunables where \fB\-\-cache\-dir\fR is not given.
.TP
.B NEARLIGHT_OIDN
The library file of Open Image Denoise, for \fB\-\-denoise\fR.
.TP
.B NEARLIGHT_RANK_SILENCE
Seconds after which a rank that says nothing counts as lost, in a job of MPI; 30 if not given.
)";

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
success
.TP
.B 1
failure
.TP
.B 2
wrong usage
.TP
.B 3
a scene or image file is missing, broken or cannot be written
.TP
.B 4
no OpenCL device
.TP
.B 5
a kernel does not compile
.TP
.B 6
out of memory
.TP
.B 130
interrupted; what a render had made of its picture was saved
)";

/// Text without characters that have a meaning in man(7). A dash becomes one that can be copied to a shell.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    }
    const bool is_control = !result.empty() && (result.front() == '.' || result.front() == '\'');
    return (is_control ? "\\&" : "") + result;
}

std::string page_name(const CommandFacts& command) {
    std::string name = command.full_name;
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

std::string synopsis(const CommandFacts& command) {
    std::string text = ".B " + escaped(command.full_name) + "\n[\\fIOPTION\\fR]...\n";
    if (!command.parts.empty()) {
        return text + "\\fICOMMAND\\fR ...\n";
    }
    for (const OptionFacts& option : command.options) {
        if (option.is_positional) {
            text += "\\fI" + escaped(option.value) + "\\fR\n";
        } else if (option.is_required) {
            text += "\\fB" + escaped(option.names.front()) + "\\fR \\fI" + escaped(option.value) + "\\fR\n";
        }
    }
    return text;
}

std::string option_entry(const OptionFacts& option) {
    const auto marked = [&](const std::string& name) {
        return (option.is_positional ? "\\fI" : "\\fB") + escaped(name) + "\\fR";
    };
    const bool shows_value = !option.is_positional && !option.value.empty();
    std::string text = ".TP\n" + joined(option.names, ", ", marked) +
                       (shows_value ? " \\fI" + escaped(option.value) + "\\fR" : "") + "\n" +
                       escaped(option.description);
    if (!option.default_value.empty() && option.description.find("(default") == std::string::npos) {
        text += " (default: " + escaped(option.default_value) + ")";
    }
    return text + "\n";
}

std::string option_sections(const CommandFacts& command) {
    std::vector<std::string> groups;
    for (const OptionFacts& option : command.options) {
        const std::string group = option.is_positional ? "Arguments" : option.group;
        if (std::ranges::find(groups, group) == groups.end()) {
            groups.push_back(group);
        }
    }
    // What all commands share comes last.
    std::stable_partition(groups.begin(), groups.end(),
                          [](const std::string& group) { return group != "Common options"; });
    std::string text;
    for (const std::string& group : groups) {
        std::string heading = group;
        std::ranges::transform(heading, heading.begin(), [](unsigned char c) { return std::toupper(c); });
        text += ".SH " + heading + "\n";
        for (const OptionFacts& option : command.options) {
            if ((option.is_positional ? "Arguments" : option.group) == group) {
                text += option_entry(option);
            }
        }
    }
    return text;
}

std::string part_section(const CommandFacts& command) {
    std::string text = command.parts.empty() ? "" : ".SH COMMANDS\n";
    for (const CommandFacts& part : command.parts) {
        text += ".TP\n.BR " + escaped(page_name(part)) + " (1)\n" + escaped(part.description) + "\n";
    }
    return text;
}

void add_pages(const CommandFacts& command, const CommandFacts* parent, const std::string& version,
               std::vector<ManPage>& pages) {
    std::string title = page_name(command);
    std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
    std::string text = ".\\\" Made from the options of the program.\n.TH " + escaped(title) +
                       " 1 \"\" \"nearlight " + version + "\" \"nearlight\"\n.SH NAME\n" +
                       escaped(page_name(command)) + " \\- " + escaped(command.description) +
                       "\n.SH SYNOPSIS\n" + synopsis(command) + part_section(command) +
                       option_sections(command);
    if (parent == nullptr) {
        text += kEnvironment;
        text += kExitStatus;
    } else {
        text += ".SH SEE ALSO\n.BR " + escaped(page_name(*parent)) + " (1)\n";
    }
    pages.push_back({page_name(command) + ".1", text});
    for (const CommandFacts& part : command.parts) {
        add_pages(part, &command, version, pages);
    }
}

}  // namespace

std::vector<ManPage> man_pages(const CommandFacts& program, const std::string& version) {
    std::vector<ManPage> pages;
    add_pages(program, nullptr, version, pages);
    return pages;
}

}  // namespace nearlight::core
