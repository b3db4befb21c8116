// SPDX-License-Identifier: Apache-2.0
#include "host/cli/output.h"

#include <iostream>

#include "host/base/printable.h"
#include "nearlight/error.h"

namespace nearlight::core {

void print_json(const nlohmann::ordered_json& result) {
    // File names may contain bytes that are not UTF-8, and JSON must not.
    std::cout << result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

void print(std::string_view text) {
    std::cout << printable(text) << std::flush;
}

void check_standard_output() {
    if (!std::cout.flush()) {
        throw Error(ErrorKind::failure, "cannot write to standard output");
    }
}

}  // namespace nearlight::core
