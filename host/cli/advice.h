// SPDX-License-Identifier: Apache-2.0
// The library says what failed in terms of its own; here those become options of the program.
#pragma once

#include <string>

#include "nearlight/error.h"

namespace nearlight::core {

/// What the error says and, where an option helps, which one: "…; check --kernel-dir".
std::string with_advice(const Error& error);

}  // namespace nearlight::core
