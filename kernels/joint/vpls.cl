// SPDX-License-Identifier: Apache-2.0
// The small stages that all samplers use, compiled as one program on CPUs; see kernels/README.md.
#include "compaction.cl"
#include "morton_sort.cl"
#include "patch_vpls.cl"
#include "triangle_classifier.cl"
#include "vpl_contribution.cl"
#include "vpl_light.cl"
#include "vpl_placement.cl"
