// SPDX-License-Identifier: Apache-2.0
#include "host/cli/document_command.h"

#include <filesystem>

#include "host/base/files.h"
#include "host/cli/completions.h"
#include "host/cli/man_pages.h"

namespace nearlight::core {
namespace {

ExitCode run_document(const std::filesystem::path& folder, const CommandFacts& program) {
    make_folder(folder / "man");
    for (const ManPage& page : man_pages(program, NEARLIGHT_VERSION)) {
        write_text(folder / "man" / page.file, page.text);
    }
    write_text(folder / "nearlight.bash", bash_completion(program));
    write_text(folder / "_nearlight", zsh_completion(program));
    write_text(folder / "nearlight.fish", fish_completion(program));
    return ExitCode::done;
}

}  // namespace

void add_document_command(CommandLine& line) {
    auto folder = std::make_shared<std::filesystem::path>();
    CLI::App& command = line.add_command(
        "document", "Write man pages and completions of all commands",
        [folder, &line](const GlobalOptions&) { return run_document(*folder, line.facts()); });
    command.group("");
    command.add_option("DIR", *folder, "Folder to write to, which is created")->required();
}

}  // namespace nearlight::core
