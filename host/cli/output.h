// SPDX-License-Identifier: Apache-2.0
// Standard output: results only.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace nearlight::core {

/// The result of a command under --json: one object. Numbers that JSON cannot hold become null.
void print_json(const nlohmann::ordered_json& result);
/// A piece of text for people.
void print(std::string_view text);
/// Throws Error(ErrorKind::failure) if something did not arrive, say on a full disk.
void check_standard_output();

}  // namespace nearlight::core
