// SPDX-License-Identifier: Apache-2.0
// The states that the handles in include/nearlight/ share.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "host/cl/device.h"
#include "host/scene/scene.h"
#include "host/session/session.h"
#include "nearlight/device.h"
#include "nearlight/scene.h"
#include "nearlight/session.h"

namespace nearlight {

struct Scene::State {
    core::Scene scene;
};

struct Devices::State {
    std::vector<std::unique_ptr<core::Device>> devices;
    std::vector<DeviceInfo> infos;

    [[nodiscard]] std::vector<core::Device*> plain() const;
};

struct Session::State {
    State(std::shared_ptr<Devices::State> on_devices, std::shared_ptr<const Scene::State> of_scene,
          const SessionOptions& options)
        : devices(std::move(on_devices)),
          scene(std::move(of_scene)),
          session(devices->plain(), scene->scene, options) {}

    std::shared_ptr<Devices::State> devices;
    std::shared_ptr<const Scene::State> scene;
    core::Session session;  ///< declared last, because it refers to the others
};

/// A view and the session that made it. The view's device memory is released before the session.
struct View::State {
    std::shared_ptr<Session::State> owner;
    core::View view;
};

struct VplSet::State {
    std::shared_ptr<const View::State> view;  ///< the view that they were made for
    core::VplSet set;
};

}  // namespace nearlight
