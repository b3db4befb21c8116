// SPDX-License-Identifier: Apache-2.0
// The stages between a camera and a picture, compiled as one program on CPUs; see kernels/README.md.
#include "camera_pass.cl"
#include "direct_light.cl"
#include "film.cl"
