// SPDX-License-Identifier: Apache-2.0
// The entry that libFuzzer calls. NEARLIGHT_FUZZ_TARGET is the function of targets.h that the program is for.
#include <cstddef>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    nearlight::core::fuzz::NEARLIGHT_FUZZ_TARGET({data, size});
    return 0;
}
