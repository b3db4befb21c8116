// SPDX-License-Identifier: Apache-2.0
// The stages that follow light and paths through the scene, compiled as one program on CPUs; see
// kernels/README.md.
#include "light_tracer.cl"
