// SPDX-License-Identifier: Apache-2.0
// Oclgrind's own search for reads of what was never written, mended (uninitialized.patch), as a plugin that
// an installed Oclgrind loads. scripts/oclgrind compiles it within Oclgrind's sources.
// clang-format off
#include "core/common.h"
#include "core/Context.h"
#include "plugins/Uninitialized.h"
// clang-format on

extern "C" void initializePlugins(oclgrind::Context* context) {
    context->registerPlugin(new oclgrind::Uninitialized(context));
}

extern "C" void releasePlugins(oclgrind::Context* /*context*/) {}
