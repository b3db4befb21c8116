// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace nearlight::core {

/// Writes the text of --help within 100 columns: names of options on the left, and what they do on the right.
class HelpFormatter : public CLI::Formatter {
  public:
    HelpFormatter() { label("SUBCOMMAND", "COMMAND"); }
    std::string make_option(const CLI::Option* option, bool is_positional) const override;
    std::string make_option_opts(const CLI::Option* option) const override;
    std::string make_subcommand(const CLI::App* command) const override;
    std::string make_description(const CLI::App* app) const override;
};

}  // namespace nearlight::core
