// SPDX-License-Identifier: Apache-2.0
// The stages between a camera and a picture, compiled as one program on CPUs; see kernels/README.md.
#include "camera_lights.cl"
#include "camera_pass.cl"
#include "film.cl"
#include "receiver_paths.cl"
#include "shared_lights.cl"
#include "splats.cl"
