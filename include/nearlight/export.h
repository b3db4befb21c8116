// SPDX-License-Identifier: Apache-2.0
// What the shared library shows.
#pragma once

#if defined(__GNUC__)
#define NEARLIGHT_API __attribute__((visibility("default")))
#else
#define NEARLIGHT_API
#endif
