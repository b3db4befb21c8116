// SPDX-License-Identifier: Apache-2.0
// What a helping rank says when it is ready.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/session/remote_devices.h"
#include "nearlight/error.h"

namespace nearlight::core {

struct Hello {
    std::string host;
    std::string facts;  ///< by which the leading rank knows whether this rank has the same picture to make
    std::vector<RemoteDevice> devices;
    std::optional<Error> failure{};  ///< why it is not ready
};

std::string to_text(const Hello& hello);
Hello parse_hello(const std::string& text);

}  // namespace nearlight::core
