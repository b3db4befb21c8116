// SPDX-License-Identifier: Apache-2.0
// A scene on devices, and the three steps of a picture: look, sample and gather. Each step returns its
// product.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "host/samplers/sampler.h"
#include "host/session/device_pool.h"
#include "host/session/mattes.h"
#include "host/session/planned_picture.h"
#include "host/session/view.h"
#include "nearlight/light_share.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// The seconds that it took to get a scene ready.
struct SessionSeconds {
    double build_bvh = 0;
    double upload = 0;  ///< upload of scene and trees
    double total = 0;
};

/// Takes finished rows, from top to bottom: a multiple of width · NEARLIGHT_LAYER_CHANNELS floats, with the
/// channels of layer_channels(). The width is that of the part of the picture that is rendered.
using RowSink = std::function<void(std::span<const float> rows)>;

struct GatherOutcome {
    std::vector<BandShare> shares;  ///< the part that each device had in the picture
    std::size_t local_lights = 0;   ///< number of local lights in all tiles
    bool interrupted = false;       ///< `progress` stopped it: rows are missing at the bottom
};

/// What a picture of these VPLs is gathered with: what the settings say, and for the rest the pilot's choice.
/// Its clamp radius counts only if rays bring back what it takes away.
RayBudget budget_of(const View& view, const VplSet& vpls, const GatherSettings& settings);

/// A set of VPLs, and its weight in the mean of several sets.
struct VplPart {
    const VplSet* set = nullptr;
    float weight = 1.0f;
};

/// A scene on devices. After construction the tree is built and everything is uploaded; kernels compile until
/// they are first launched. Views and VPLs are made on the first device, rows on all of them. Several devices
/// of one type give the same bits as each of them alone. A device that fails is left out from then on, with a
/// warning; when no device is left, its error is thrown. For one thread at a time.
class Session {
  public:
    /// Keeps references to `devices` (one or more) and `scene`, which must outlive the session. Of the scene
    /// only the camera may change meanwhile, which look() asks for. Throws Error(ErrorKind::out_of_memory)
    /// before it builds the tree if there is not enough memory, see host/session/scene_memory.h.
    Session(std::span<Device* const> devices, const Scene& scene, const SessionOptions& options = {});
    Session(Device& device, const Scene& scene, const SessionOptions& options = {});
    Session(std::span<Device* const> devices, const Scene&& scene,
            const SessionOptions& options = {}) = delete;
    Session(Device& device, const Scene&& scene, const SessionOptions& options = {}) = delete;

    /// Decides what the settings leave open, by a pilot view of about a thousand receivers.
    View look(const ViewSettings& settings, uint seed) { return look(scene_.camera, settings, seed); }
    /// Looks with another camera than the scene's.
    View look(const SceneCamera& camera, const ViewSettings& settings, uint seed);

    /// Makes VPLs for the view, on the leading device, or reads them from the file that the settings name,
    /// and then throws as read_vpl_file() and check_vpls() do.
    VplSet sample(const View& view, const SamplingSettings& settings, uint seed);

    /// Joins sets of VPLs of this scene and depth into one. The power of each VPL is multiplied by the weight
    /// of its part, and weights add up to 1, so the set has the weighted mean of their light. No set may have
    /// local lights.
    VplSet join(std::span<const VplPart> parts);

    /// Writes VPLs that were made for the view to a file, from which sample() can take them. Throws as
    /// write_vpl_file() and vpl_file_of() do.
    void save_vpls(const View& view, const VplSet& vpls, const std::filesystem::path& file);

    /// Makes a picture: camera pass, direct light, light of the VPLs, film. `sink` gets the rows in order, in
    /// the caller's thread. Throws Error(ErrorKind::invalid_argument) for a window that is not in the
    /// picture, and for Russian roulette over VPLs that are asked by cuts.
    GatherOutcome gather(const View& view, const VplSet& vpls, const GatherSettings& settings, uint seed,
                         const RowSink& sink, const WorkProgress& progress,
                         const PictureSequence& order = {});

    /// Plans a picture for PictureSequence::present, and shows it to remote devices. Throws as gather() does.
    std::shared_ptr<PlannedPicture> plan(const View& view, const VplSet& vpls, const GatherSettings& settings,
                                         uint seed);

    /// Has remote devices make bands from now on. One that fails is left out as the session's own are.
    void enlist(RemoteDevices remote) { remote_ = std::move(remote); }
    /// Whether PictureSequence::next is of use. With several devices of its own the session cannot tell which
    /// of them will lead by then.
    [[nodiscard]] bool looks_ahead() const { return !remote_.devices.empty() && pool_.size() == 1; }
    /// The session's own devices, as another session sees them.
    [[nodiscard]] std::vector<RemoteDevice> own_devices() const;
    /// Makes bands of another session's picture on device `number` of own_devices(). Each device may be used
    /// by a thread of its own. Keeps references to the picture and the VPLs.
    [[nodiscard]] BandMaker helper(std::size_t number, const PictureTask& picture,
                                   const VplBuffer& vpls) const;

    /// The irradiance (W/m²) at points (m), on the side of their unit normals: direct light, the light of
    /// `vpls` with their clamp radius (the view's, unless a pilot chose another for them and paths are
    /// traced), and, by short paths, the light that this radius takes away. If `vpls` come from an unbiased
    /// sampler, the expectation is all light up to the view's depth. Returns one value per point. Throws
    /// Error(ErrorKind::invalid_argument) unless `points` and `normals` have the same length.
    std::vector<Vec3> irradiance(std::span<const Vec3> points, std::span<const Vec3> normals,
                                 const View& view, const VplSet& vpls, const IrradianceSettings& settings,
                                 uint seed);

    /// What each of `vpls` and each emitter brings to a point, see host/session/light_shares.h.
    std::vector<LightShare> light_shares(Vec3 point, Vec3 normal, const View& view, const VplSet& vpls,
                                         uint seed);

    /// Counts what the camera sees first, straight and through the holes of masks: which part of each pixel
    /// each object or material covers, in the window, or in the whole picture if it is empty. The samples are
    /// those of all passes. Works on the leading device. If `progress` stops it, `sink` does not get the rows
    /// that are missing at the bottom.
    void mattes(const Camera& camera, const std::optional<PixelWindow>& window,
                std::span<const MattePass> passes, std::span<const NamedKind> kinds, const MatteSink& sink,
                const WorkProgress& progress);

    /// The seconds of getting ready. A second call returns zeros, so that only one picture counts them.
    [[nodiscard]] SessionSeconds take_seconds() { return std::exchange(seconds_, {}); }
    /// The seconds in which anything was compiled or loaded, since the last call or else since the device was
    /// opened. Other work goes on meanwhile.
    [[nodiscard]] double new_compile_seconds();
    /// The peak allocation in bytes, all devices together.
    [[nodiscard]] std::size_t peak_bytes() const { return pool_.peak_bytes(); }
    /// The scene in the leading device's memory, for callers that run single stages.
    [[nodiscard]] const DeviceScene& device_scene() const { return pool_.leader().scene; }

  private:
    std::vector<uint> see_first(const Camera& camera, const SampleBlock& block, uint seed);
    VplSet read_vpls(const View& view, const std::filesystem::path& file);
    [[nodiscard]] bool is_alone() const { return pool_.size() == 1 && remote_.devices.empty(); }
    void drop_failed(std::span<const BandShare> shares);

    const Scene& scene_;
    DevicePool pool_;
    RemoteDevices remote_;
    SessionSeconds seconds_;
    double told_compile_seconds_ = 0;
    bool is_width_told_ = false;  ///< whether a warning of the scene's width was given
};

/// Begins to compile the programs that a render with these settings needs, so that they compile while the
/// scene is loaded. A Session on the same devices uses these programs and waits for unfinished ones. A device
/// that fails here gets a debug message only, because the Session will find out too.
void begin_compiling(std::span<Device* const> devices, const SessionOptions& options,
                     const SamplingSettings& settings);

}  // namespace nearlight::core
