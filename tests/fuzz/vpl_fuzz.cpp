// SPDX-License-Identifier: Apache-2.0
// Sets of VPLs.
#include "host/session/vpl_file.h"
#include "nearlight/error.h"
#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {

void fuzz_vpls(Bytes bytes) {
    try {
        static_cast<void>(read_vpl_file(put("vpls.ply", bytes)));
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
