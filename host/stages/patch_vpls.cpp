// SPDX-License-Identifier: Apache-2.0
#include "host/stages/patch_vpls.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {

PatchVpls::PatchVpls(Device& device)
    : program_(device, "patch_vpls.cl", kVplsProgram), patch_vpls_(program_, "patch_vpls") {}

void PatchVpls::run(const DeviceScene& scene, const Buffer<SurfaceSample>& samples, std::size_t sample_count,
                    const CloseRegion& region, float area_per_sample, Buffer<Vpl>& vpls,
                    Buffer<uint>& flags) {
    patch_vpls_.launch_items(2 * sample_count, scene, samples, static_cast<uint>(sample_count), region.range,
                             region.whole_triangles ? 1u : 0u, area_per_sample, vpls, flags);
}

}  // namespace nearlight::core
