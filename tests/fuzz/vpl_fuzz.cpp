// SPDX-License-Identifier: Apache-2.0
// Sets of VPLs, and the bench's files of segments between them and receivers.
#include "host/bench/segment_file.h"
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

void fuzz_segments(Bytes bytes) {
    try {
        static_cast<void>(read_segments(put("room.segments", bytes)));
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
