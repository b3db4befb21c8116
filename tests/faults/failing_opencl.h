// SPDX-License-Identifier: Apache-2.0
// What a program says to failing_opencl.cpp if it is linked to it rather than loaded with it.
#pragma once

extern "C" {
/// Begins to count calls, of which number `call`, counted from 1, fails with the OpenCL error `code`; none
/// fails if it is 0.
__attribute__((visibility("default"))) void nearlight_fault(long call, int code);
/// The number of calls since nearlight_fault().
__attribute__((visibility("default"))) long nearlight_fault_calls();
}
