// SPDX-License-Identifier: Apache-2.0
#include "host/session/planned_picture.h"

#include <algorithm>
#include <utility>

namespace nearlight::core {

void NextPicture::prepare_by(BandWorker& worker, std::function<std::shared_ptr<PlannedPicture>()> make) {
    worker.start = [this, start = std::move(worker.start), make = std::move(make)] {
        std::shared_ptr<PlannedPicture> picture = make();
        {
            const std::lock_guard lock(mutex_);
            picture_ = std::move(picture);
        }
        return start();
    };
}

void NextPicture::begin_band(const RemoteDevices& remote, std::size_t device) {
    const std::lock_guard lock(mutex_);
    if (picture_ && picture_->begun.size() < picture_->task.plan.band_count()) {
        remote.order(*picture_->shown, device, static_cast<uint>(picture_->begun.size()));
        picture_->begun.push_back(device);
    }
}

void add_remote_workers(const RemoteDevices& remote, const PlannedPicture& picture, NextPicture& next,
                        std::vector<BandWorker>& workers) {
    for (const RemoteDevice& device : remote.devices) {
        BandWorker worker{.name = device.name,
                          .start = [&remote, number = *picture.shown, device = device.number]() -> BandMaker {
                              return [&remote, number, device](uint band, const WorkProgress& progress) {
                                  return remote.fetch(number, device, band, progress);
                              };
                          }};
        const auto begun = std::ranges::find(picture.begun, device.number);
        if (begun != picture.begun.end()) {
            worker.first_band = static_cast<uint>(begun - picture.begun.begin());
        }
        worker.wait = [&remote, &next, device = device.number] { next.begin_band(remote, device); };
        workers.push_back(std::move(worker));
    }
}

}  // namespace nearlight::core
