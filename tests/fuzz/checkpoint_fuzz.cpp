// SPDX-License-Identifier: Apache-2.0
// The sums of long renders.
#include <cstring>
#include <string>

#include "host/cli/checkpoint_file.h"
#include "nearlight/error.h"
#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {

void fuzz_checkpoint(Bytes bytes) {
    if (bytes.empty()) {
        return;
    }
    const bool is_raw = bytes[0] % 2 == 1;
    const std::string rest(bytes.begin() + 1, bytes.end());
    const std::uint64_t length = rest.size();
    std::string frame = "NLSUMS01" + std::string(sizeof length, '\0');
    std::memcpy(frame.data() + frame.size() - sizeof length, &length, sizeof length);
    try {
        static_cast<void>(CheckpointReader(put("checkpoint", is_raw ? rest : frame + rest)).read_sums());
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
