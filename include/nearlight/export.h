// SPDX-License-Identifier: Apache-2.0
// The macro for declarations that the shared library exports.
#pragma once

#if defined(__GNUC__)
#define NEARLIGHT_API __attribute__((visibility("default")))
#else
#define NEARLIGHT_API
#endif
