// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/selection_checks.h"

#include <cmath>
#include <numeric>

#include "host/reference/gather_workload.h"
#include "host/reference/synthetic_scene.h"
#include "host/stages/vpl_order.h"

namespace nearlight::core {

SelectionCase make_selection_case(Device& device, uint vpl_count) {
    const Scene scene = make_sphere_room(3000);
    const Bvh bvh = build_scene_bvh(scene);
    SelectionCase data;
    std::vector<Vpl> vpls = make_traced_vpls(scene, bvh, vpl_count);
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        vpls[i].power = Vec3{0.5f, 1.0f, 2.0f} * (1.0f + static_cast<float>(i % 7));
    }
    data.vpls = VplOrder(device).sort(vpls).download();
    data.receivers = make_camera_receivers(scene, bvh, 40, 24);
    data.tree = upload_tree(device, bvh);
    data.vpl_buffer = {device, data.vpls};
    data.receiver_buffer = {device, data.receivers};
    return data;
}

SelectionMean::SelectionMean(Device& device, const SelectionCase& data)
    : data_(data),
      gatherer_(device),
      sums_(device, data.receivers.size()),
      full_(gather(nullptr)),
      deviation_(full_.size()),
      squares_(full_.size()) {}

std::vector<double> SelectionMean::gather(const VplSelection* selection) {
    gatherer_.gather(data_.input(selection), sums_);
    std::vector<double> light;
    for (const IrradiancePacket& packet : sums_.light.download()) {
        light.push_back(std::accumulate(packet.r, packet.r + 3 * NEARLIGHT_PACKET_SIZE, 0.0));
    }
    return light;
}

void SelectionMean::add(const VplSelection& selection) {
    const std::vector<double> some = gather(&selection);
    for (std::size_t i = 0; i < deviation_.size(); ++i) {
        const double difference = some[i] - full_[i];
        deviation_[i] += difference;
        squares_[i] += difference * difference;
    }
    ++count_;
}

void SelectionMean::check(double max_errors, CheckResult& result) const {
    for (std::size_t i = 0; i < deviation_.size(); ++i) {
        const double mean = deviation_[i] / count_;
        const double error = std::sqrt((squares_[i] / count_ - mean * mean) / (count_ - 1));
        result.expect(std::abs(mean) <= max_errors * error + 1e-6 * full_[i]);
    }
}

}  // namespace nearlight::core
