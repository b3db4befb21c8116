// SPDX-License-Identifier: Apache-2.0
// Parallel primitives against the standard library.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight {

/// Sizes and offsets of the shared structs; a case is a fact.
void check_layout(Device& device, CheckResult& result);
/// Prefix sums of 32 and 64 bits, at awkward sizes; a case is a sum.
void check_scan(Device& device, CheckResult& result);
/// A case is an index of a set flag.
void check_compaction(Device& device, CheckResult& result);
/// A case is a pair in its place.
void check_sort(Device& device, CheckResult& result);
/// A case is the code of a point: the cell that it lies in, or its neighbour where rounding decides.
void check_morton(Device& device, CheckResult& result);

}  // namespace nearlight
