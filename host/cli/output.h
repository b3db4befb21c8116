// SPDX-License-Identifier: Apache-2.0
// Writes results to standard output.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace nearlight::core {

/// Prints the result of a command under --json. NaN and infinity become null.
void print_json(const nlohmann::ordered_json& result);
/// Prints text for people, at once, so that they see the rows of a long table as they are made.
void print(std::string_view text);
/// Throws Error(ErrorKind::failure) if output could not be written, for example because a disk is full.
void check_standard_output();

}  // namespace nearlight::core
