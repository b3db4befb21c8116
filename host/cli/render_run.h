// SPDX-License-Identifier: Apache-2.0
// Makes the files of one picture: what `nearlight render` does once, or for each frame.
#pragma once

#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/cli/checkpoint_options.h"
#include "host/cli/device_options.h"
#include "host/cli/frame_options.h"
#include "host/cli/method_options.h"
#include "host/cli/mpi_options.h"
#include "host/cli/pass_options.h"
#include "host/cli/picture_files.h"
#include "host/cli/render_output.h"
#include "host/cli/rendered_picture.h"
#include "host/cli/scene_options.h"
#include "host/cli/tev_picture.h"
#include "host/cli/vpl_options.h"
#include "host/session/picture_window.h"
#include "host/session/render.h"

namespace nearlight::core {

struct RenderOptions {
    SceneOptions scene;
    PictureOptions picture;
    DeviceChoice device;
    RenderSettings settings;
    SessionOptions session;
    ImageSize size;
    MethodTexts method;
    PassOptions passes;
    VplFiles vpl_files;
    CheckpointOptions checkpoint;
    FrameOptions frames;
    std::string tev;
    std::string splat;  ///< "on", "off", or empty: on unless the picture is denoised or has mattes
    MpiUse mpi = MpiUse::automatic;
    int threads = 0;  ///< 0: one per core
};

/// The settings that the options come to.
RenderSettings settled(const RenderOptions& options);

/// A frame among others.
struct FrameFacts {
    int frame = 0;
    std::string vpl_keys{};  ///< the frames with key views and their weights; empty: it has VPLs of its own
};

/// What is there before the first rows come.
struct RenderRun {
    RenderOptions options;
    const GlobalOptions& global;
    RenderSettings settings;
    std::optional<FrameFacts> frame{};  ///< empty if the picture is the only one
    std::unique_ptr<Scene> scene{};     ///< must not change before `hash` is there
    double load_seconds = 0.0;
    std::shared_future<std::uint64_t> hash{};  ///< of the scene
    std::vector<std::unique_ptr<Device>> devices{};

    [[nodiscard]] std::vector<Device*> plain_devices() const;
    [[nodiscard]] ScreenLook look() const { return screen_look(options.picture.screen, *scene); }
    [[nodiscard]] std::vector<MatteLayer> mattes() const { return matte_layers(options.picture.layers); }
    [[nodiscard]] Metadata metadata(const RenderReport& report, const View& view) const;
    /// The part of the picture that is rendered.
    [[nodiscard]] PixelWindow window() const;
    /// What checkpoints say of the picture; nothing if there are none.
    [[nodiscard]] CheckpointFacts facts() const;
    /// Computes the hash of the scene in the background, for metadata and checkpoints.
    void begin_hash();
};

/// Reads the scene while devices start and kernels compile. Errors of the scene are reported first.
RenderRun get_ready(const RenderOptions& options, const GlobalOptions& global, const DeviceChoice& choice);

/// Where finished rows go, and when the first of them came.
struct RowSinks {
    RenderedPicture picture;
    TevPicture tev;
    FirstRows first_rows{};
    bool has_rows = false;  ///< whether the files of the present picture have rows
    Camera camera{};        ///< of the picture

    /// Whether the files get anything: without any row, files that are there are better than black ones.
    [[nodiscard]] bool are_written(const RenderReport& report) const {
        return has_rows || !report.interrupted;
    }

    explicit RowSinks(const RenderOptions& options);
    void open(const RenderRun& run, const RenderReport& report, const View& view);
    void add_rows(std::span<const float> rows, const Stopwatch& since_begin);
};

/// What a picture begins with.
struct PictureStart {
    CheckpointFacts facts{};
    PassStart passes{};
    VplMaker vpls{};  ///< empty: a sampler makes them
};

struct MadePicture {
    RenderReport report;
    nlohmann::ordered_json json;
};

/// Renders the picture into the sinks, writes its files, and logs what became of it. Frames that were
/// interrupted are not written.
MadePicture make_picture(Session& session, const RenderRun& run, PictureStart start, RowSinks& sinks,
                         const Stopwatch& since_begin);

}  // namespace nearlight::core
