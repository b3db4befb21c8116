// SPDX-License-Identifier: Apache-2.0
// Walks through the scene, compiled as one program on CPUs; see kernels/README.md.
#include "bounce_tracer.cl"
#include "light_tracer.cl"
