// SPDX-License-Identifier: Apache-2.0
// Adds the program's options to the library's messages, which know only settings.
#pragma once

#include <string>

#include "nearlight/error.h"

namespace nearlight::core {

/// The error's message, with advice if an option helps: "…; check --kernel-dir".
std::string with_advice(const Error& error);

}  // namespace nearlight::core
