// SPDX-License-Identifier: Apache-2.0
// The function that the module exports, and the loop of the window.
#include "viewer/viewer.h"

#include <algorithm>

#include "nearlight/error.h"
#include "nearlight/message.h"
#include "viewer/application.h"
#include "viewer/measure.h"
#include "viewer/window.h"

namespace nearlight::viewer {
namespace {

// The panel of settings fits into the smallest window. Larger pictures are shown smaller than they are.
constexpr int kMinWindowHeight = 820;
constexpr int kMaxWindowHeight = 1000;
constexpr int kMaxPictureWidth = 1280;

/// Messages go to the caller while this lives.
class MessageScope {
  public:
    explicit MessageScope(const MessageSink& sink) { set_message_sink(sink); }
    ~MessageScope() { set_message_sink({}); }
    MessageScope(const MessageScope&) = delete;
    MessageScope& operator=(const MessageScope&) = delete;
};

ViewerReport show(const ViewerTask& task) {
    const int width = std::min(task.settings.view.width.value_or(kDefaultWidth), kMaxPictureWidth);
    const int height = task.settings.view.height.value_or(kDefaultHeight);
    Window window("nearlight - " + task.scene.filename().string(), static_cast<int>(kPanelWidth) + width,
                  std::clamp(height, kMinWindowHeight, kMaxWindowHeight));
    Application application(task, window);
    while (!window.is_closed() && !application.has_ended() &&
           !(task.is_interrupted && task.is_interrupted())) {
        window.wait(application.patience());
        application.draw();
    }
    return {};
}

}  // namespace

extern "C" __attribute__((visibility("default"))) ViewerReport nearlight_run_viewer(const ViewerTask& task) {
    const MessageScope messages(task.messages);
    return task.measures ? measure(task) : show(task);
}

}  // namespace nearlight::viewer
