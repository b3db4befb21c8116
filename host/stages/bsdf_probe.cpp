// SPDX-License-Identifier: Apache-2.0
#include "host/stages/bsdf_probe.h"

namespace nearlight::core {

BsdfProbe::BsdfProbe(Device& device)
    : device_(&device), kernel_(Program(device, "bsdf_probe.cl"), "bsdf_probe") {}

std::vector<BsdfAnswer> BsdfProbe::ask(const BsdfScene& scene, std::span<const BsdfQuery> queries) {
    const auto upload = [&]<typename T>(const std::vector<T>& values) {
        return Buffer<T>(*device_, std::span<const T>(values));
    };
    const Buffer<SceneInfo> info(*device_, std::span(&scene.info, 1));
    const Buffer<BsdfQuery> on_device(*device_, queries);
    Buffer<BsdfAnswer> answers(*device_, queries.size());
    kernel_.launch_items(queries.size(), upload(scene.vertices), upload(scene.triangles),
                         upload(scene.materials), upload(scene.textures), upload(scene.texels),
                         upload(scene.curves), upload(scene.vertex_colors), upload(scene.second_uvs), info,
                         on_device, answers, static_cast<uint>(queries.size()));
    return answers.download();
}

}  // namespace nearlight::core
