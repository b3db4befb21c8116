// SPDX-License-Identifier: Apache-2.0
// A scene on devices, and the three steps of a picture: look, sample and gather. Each step returns its
// product.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nearlight/device.h"
#include "nearlight/export.h"
#include "nearlight/image.h"
#include "nearlight/light_share.h"
#include "nearlight/scene.h"
#include "nearlight/settings.h"
#include "nearlight/vec3.h"

namespace nearlight {

/// A virtual point light (VPL): sends the flux `power` into the hemisphere of `normal`, with the radiant
/// intensity power/π · cosθ in W/sr.
struct VirtualPointLight {
    Vec3 position;  ///< in metres, a tiny distance above its surface
    Vec3 normal;    ///< unit vector
    Vec3 power;     ///< in W of red, green and blue, after reflection at the surface
    /// 1: lit by an emitter, 2: after one more bounce, …; 0: lit by light of all depths.
    std::uint32_t depth;
    bool close;  ///< lies in the close range
};

/// A place in a picture.
struct PicturePlace {
    double x = 0.0;         ///< in pixels from the left edge
    double y = 0.0;         ///< in pixels from the top edge
    double distance = 0.0;  ///< from the camera, in metres
};

/// A view of a scene whose settings Session::look() has decided. Copies share one state. Accessors may be
/// called from any thread.
class NEARLIGHT_API View {
  public:
    [[nodiscard]] int width() const;   ///< pixels
    [[nodiscard]] int height() const;  ///< pixels
    /// The distance in metres from the camera at which the close range ends.
    [[nodiscard]] float range() const;
    /// R of the bounded geometry term, in metres: VPLs nearer to a point than R light it as if they were at
    /// the distance R. Where the settings left R open, a set of VPLs has a radius of its own, which a pilot
    /// chose, and which counts if rays bring back what it takes away.
    [[nodiscard]] float clamp_radius() const;
    /// The length of the longest light path, as Mitsuba counts: 1 is emission, 2 is direct light.
    [[nodiscard]] std::uint32_t max_depth() const;
    /// Where the camera sees a point, whether or not something is in between; empty if the point is not
    /// before the camera. The place may lie beyond the border of the picture.
    [[nodiscard]] std::optional<PicturePlace> place_of(Vec3 point) const;

  private:
    friend class Session;
    friend class VplSet;
    struct State;
    explicit View(std::shared_ptr<const State> state);
    std::shared_ptr<const State> state_;
};

/// The VPLs that Session::sample() made for a View. They stay in the memory of a device. Copies share one
/// set, which keeps its session's devices and scene alive.
class NEARLIGHT_API VplSet {
  public:
    /// How many VPLs there are.
    [[nodiscard]] std::size_t size() const;
    /// How many of the VPLs count as those of the close range: the patches there, and, with the policy
    /// `complete`, also what light walks left there. 0 for all samplers but `close_range`.
    [[nodiscard]] std::size_t close_count() const;
    /// Copies the VPLs to the host: size() lights in an order in which neighbours in space are close to each
    /// other. For the thread that uses the session. Throws Error: ErrorKind::failure if the device fails.
    [[nodiscard]] std::vector<VirtualPointLight> lights() const;

  private:
    friend class Session;
    struct State;
    explicit VplSet(std::shared_ptr<const State> state);
    std::shared_ptr<const State> state_;
};

/// A finished picture.
struct Picture {
    /// The pixels, with the channels of picture_channels(). Rows that were not reached are 0.
    Image image{};
    std::uint32_t passes = 1;   ///< number of passes that were begun; it is the mean of those
    std::size_t vpl_count = 0;  ///< number of VPLs in all passes together
    bool interrupted = false;   ///< the callback stopped it before the end
    /// The samples per pixel of each of these passes; empty for the picture of a gather. Where the callback
    /// stopped the last pass, rows that it did not reach are the mean of the others.
    std::vector<std::uint32_t> pass_samples{};
    std::optional<double> error{};  ///< the relative error, if RenderSettings::error asked for it
};

/// Takes how far a piece of work is, from 0 to 1, and returns false to stop it. It is called in the thread
/// that asked for the work, several times a second while rows are gathered and not while the VPLs of a pass
/// are made, and must not throw.
using Progress = std::function<bool(double fraction)>;

/// Takes the next finished rows, from top to bottom: a multiple of width · picture_channels().size() floats.
/// The span is valid during the call only. It is called in the thread that asked for the work, and must not
/// throw.
using RowSink = std::function<void(std::span<const float> rows)>;

/// The names of the channels of every picture, in order. R, G and B are the radiance in W/(m² sr) that the
/// camera receives; direct.* and indirect.* are its two parts. The other layers describe what is seen:
/// albedo.*, the unit normal N.*, the position P.* and the distance depth.Z in metres, and closerange.Y, the
/// share of the pixel that lies in the close range. The distance is that of the first surface; the others
/// belong to the first one with a Lambertian part, behind mirrors and glass too, and are 0 where there is
/// none. variance.* is the estimated variance of R, G and B; it is 0 if the picture has a single sample per
/// pixel. A is the part of the pixel that surfaces cover.
NEARLIGHT_API std::vector<std::string> picture_channels();

/// A scene on devices, ready from construction on for any number of views, sets of VPLs and pictures. Equal
/// seeds and settings give equal bits on devices of one type, however many there are. A device that fails is
/// left out from then on, with a message (message.h), and the others do its part; when no device is left, its
/// error is thrown.
///
/// A session, its products and other sessions on the same devices are for one thread at a time. All functions
/// throw Error: ErrorKind::invalid_argument for a setting out of range (setting() names it) and for a View or
/// VplSet of another session, ErrorKind::kernel_build, ErrorKind::out_of_memory, and ErrorKind::failure for
/// any other failure of a device. After ErrorKind::invalid_argument and ErrorKind::out_of_memory the session
/// can be used as before.
class NEARLIGHT_API Session {
  public:
    /// Builds the tree of the scene or takes it from the cache, uploads everything, and begins to compile
    /// kernels. The session shares devices and scene with the caller.
    Session(const Devices& devices, const Scene& scene, const SessionOptions& options = {});
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    /// Decides what the settings leave open, by a pilot view of about a thousand receivers.
    View look(const ViewSettings& settings = {}, std::uint32_t seed = 0);

    /// Places about settings.vpl_count VPLs for the view, or takes those of settings.file. Throws Error:
    /// ErrorKind::file if that file is broken, or if its VPLs were made for another scene or maximum depth.
    VplSet sample(const View& view, const SamplingSettings& settings = {}, std::uint32_t seed = 0);

    /// Writes a set to a PLY file (docs/vpl-files.md), from which sample() takes it again in any later
    /// session of the same scene. Throws Error: ErrorKind::file if the file cannot be written;
    /// ErrorKind::invalid_argument for a set of SamplerKind::local, which belongs to its view.
    void save_vpls(const VplSet& vpls, const std::filesystem::path& file);

    /// Renders the view with these VPLs, which may have been made for another view of the session. The image
    /// takes 96 bytes per pixel, a float for each channel.
    Picture gather(const View& view, const VplSet& vpls, const GatherSettings& settings = {},
                   std::uint32_t seed = 0, const Progress& progress = {});

    /// Renders as gather() does, but passes the picture to `rows` in pieces, so that it need not be in memory
    /// as a whole. Returns false if `progress` stopped it; rows are then missing at the bottom.
    bool gather_rows(const View& view, const VplSet& vpls, const GatherSettings& settings, std::uint32_t seed,
                     const RowSink& rows, const Progress& progress = {});

    /// The irradiance (W/m² of red, green and blue) at each of the points, on the side of its normal.
    /// `points` are in metres, `normals` have length 1, and there must be as many normals as points. The
    /// result is the sum of direct light, the light of `vpls`, and the light that their clamp radius (their
    /// view's, or what a pilot chose in its place) takes away. If the sampler is unbiased, its expectation is
    /// all light up to that view's depth. Points are moved along their normals by a tiny part of the scene's
    /// size, so they may lie on surfaces.
    std::vector<Vec3> irradiance(std::span<const Vec3> points, std::span<const Vec3> normals,
                                 const VplSet& vpls, const IrradianceSettings& settings = {},
                                 std::uint32_t seed = 0);

    /// What each VPL and each emitter brings to a point, in metres, on the side of its normal, which has
    /// length 1: one share for each VPL, in the order of VplSet::lights(), and then one for each emitter.
    /// Area lights and the environment are sampled by some thousand rays, images that lights send out count
    /// by their mean, and light that falls obliquely through a coat counts as if there were none. May be
    /// called for pictures with the sampler `local`, but knows nothing of its local lights.
    std::vector<LightShare> light_shares(Vec3 point, Vec3 normal, const VplSet& vpls, std::uint32_t seed = 0);

    /// Makes a picture in one call: looks, samples and gathers, and averages several such passes if
    /// `settings` asks for them.
    Picture render(const RenderSettings& settings = {}, const Progress& progress = {});

  private:
    friend class View;
    friend class VplSet;
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace nearlight
