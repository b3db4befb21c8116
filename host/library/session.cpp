// SPDX-License-Identifier: Apache-2.0
#include "nearlight/session.h"

#include <algorithm>
#include <new>
#include <utility>

#include "host/library/checks.h"
#include "host/library/parts.h"
#include "host/library/states.h"
#include "host/scene/camera.h"
#include "host/session/picture_window.h"
#include "host/stages/film_layers.h"
#include "nearlight/error.h"

namespace nearlight {
namespace {

constexpr std::size_t kChannels = NEARLIGHT_LAYER_CHANNELS;

VirtualPointLight public_light(const core::Vpl& vpl) {
    return {.position = {vpl.position.x, vpl.position.y, vpl.position.z},
            .normal = {vpl.normal.x, vpl.normal.y, vpl.normal.z},
            .power = {vpl.power.x, vpl.power.y, vpl.power.z},
            .depth = vpl.depth,
            .close = (vpl.flags & NEARLIGHT_VPL_CLOSE) != 0};
}

std::vector<core::Vec3> core_vectors(std::span<const Vec3> vectors) {
    std::vector<core::Vec3> result;
    result.reserve(vectors.size());
    for (const Vec3 v : vectors) {
        result.push_back({v.x, v.y, v.z});
    }
    return result;
}

/// Makes a picture of zeros, which ImageFiller fills from the top.
Image blank_picture(int width, int height) {
    try {
        Image image{.width = width, .height = height, .channels = picture_channels()};
        image.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kChannels);
        return image;
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {}
    throw Error(ErrorKind::out_of_memory, "a picture of " + std::to_string(width) + "x" +
                                              std::to_string(height) + " pixels does not fit in memory");
}

/// Copies rows into an image, from top to bottom.
class ImageFiller {
  public:
    explicit ImageFiller(Image& image) : image_(image) {}
    void operator()(std::span<const float> rows) {
        std::copy(rows.begin(), rows.end(), image_.values.begin() + static_cast<std::ptrdiff_t>(end_));
        end_ += rows.size();
    }

  private:
    Image& image_;
    std::size_t end_ = 0;
};

void refuse_stranger(bool is_own, const char* what) {
    if (!is_own) {
        throw Error(ErrorKind::invalid_argument,
                    std::string(what) + " of another session was given; make it with this one");
    }
}

}  // namespace

std::vector<std::string> picture_channels() {
    return core::layer_channels();
}

View::View(std::shared_ptr<const State> state) : state_(std::move(state)) {}

int View::width() const {
    return static_cast<int>(state_->view.camera.width);
}

int View::height() const {
    return static_cast<int>(state_->view.camera.height);
}

float View::range() const {
    return state_->view.close_range.range;
}

float View::clamp_radius() const {
    return state_->view.clamp_radius;
}

std::uint32_t View::max_depth() const {
    return state_->view.max_depth;
}

std::optional<PicturePlace> View::place_of(Vec3 point) const {
    const auto found = core::film_position(state_->view.scene_camera, {point.x, point.y, point.z});
    return found ? std::optional<PicturePlace>({found->x, found->y, found->distance}) : std::nullopt;
}

VplSet::VplSet(std::shared_ptr<const State> state) : state_(std::move(state)) {}

std::size_t VplSet::size() const {
    return state_->set.vpls.count();
}

std::size_t VplSet::close_count() const {
    return state_->set.close_count;
}

std::vector<VirtualPointLight> VplSet::lights() const {
    const std::vector<core::Vpl> vpls = state_->set.vpls.download();
    std::vector<VirtualPointLight> lights(vpls.size());
    std::ranges::transform(vpls, lights.begin(), public_light);
    return lights;
}

Session::Session(const Devices& devices, const Scene& scene, const SessionOptions& options)
    : state_(std::make_shared<State>(devices.state_, scene.state_, options)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

View Session::look(const ViewSettings& settings, std::uint32_t seed) {
    check(settings);
    return View(std::make_shared<const View::State>(
        View::State{.owner = state_, .view = state_->session.look(settings, seed)}));
}

VplSet Session::sample(const View& view, const SamplingSettings& settings, std::uint32_t seed) {
    refuse_stranger(view.state_->owner == state_, "a view");
    check(settings);
    return VplSet(std::make_shared<const VplSet::State>(VplSet::State{
        .view = view.state_, .set = state_->session.sample(view.state_->view, settings, seed)}));
}

void Session::save_vpls(const VplSet& vpls, const std::filesystem::path& file) {
    refuse_stranger(vpls.state_->view->owner == state_, "a set of VPLs");
    state_->session.save_vpls(vpls.state_->view->view, vpls.state_->set, file);
}

Picture Session::gather(const View& view, const VplSet& vpls, const GatherSettings& settings,
                        std::uint32_t seed, const Progress& progress) {
    const PixelWindow window = core::window_of(view.state_->view, settings);
    Picture picture{.image = blank_picture(static_cast<int>(window.width), static_cast<int>(window.height)),
                    .vpl_count = vpls.size()};
    picture.interrupted = !gather_rows(view, vpls, settings, seed, ImageFiller(picture.image), progress);
    return picture;
}

bool Session::gather_rows(const View& view, const VplSet& vpls, const GatherSettings& settings,
                          std::uint32_t seed, const RowSink& rows, const Progress& progress) {
    refuse_stranger(view.state_->owner == state_, "a view");
    refuse_stranger(vpls.state_->view->owner == state_, "a set of VPLs");
    check(settings);
    const auto go_on = [&](double fraction) { return !progress || progress(fraction); };
    return !state_->session.gather(view.state_->view, vpls.state_->set, settings, seed, rows, go_on)
                .interrupted;
}

std::vector<Vec3> Session::irradiance(std::span<const Vec3> points, std::span<const Vec3> normals,
                                      const VplSet& vpls, const IrradianceSettings& settings,
                                      std::uint32_t seed) {
    refuse_stranger(vpls.state_->view->owner == state_, "a set of VPLs");
    check(settings);
    check_points(points, normals);
    std::vector<Vec3> result;
    if (points.empty()) {
        return result;
    }
    for (const core::Vec3 value :
         state_->session.irradiance(core_vectors(points), core_vectors(normals), vpls.state_->view->view,
                                    vpls.state_->set, settings, seed)) {
        result.push_back({value.x, value.y, value.z});
    }
    return result;
}

std::vector<LightShare> Session::light_shares(Vec3 point, Vec3 normal, const VplSet& vpls,
                                              std::uint32_t seed) {
    refuse_stranger(vpls.state_->view->owner == state_, "a set of VPLs");
    check_points({&point, 1}, {&normal, 1});
    return state_->session.light_shares({point.x, point.y, point.z}, {normal.x, normal.y, normal.z},
                                        vpls.state_->view->view, vpls.state_->set, seed);
}

Picture Session::render(const RenderSettings& settings, const Progress& progress) {
    check(settings);
    return render_picture(state_->session, settings, progress);
}

Picture render_picture(core::Session& session, const RenderSettings& settings, const Progress& progress,
                       const core::VplMaker& vpls) {
    Picture picture;
    ImageFiller fill(picture.image);
    core::RenderHooks hooks{.vpls = vpls};
    hooks.open = [&](const core::RenderReport& started, const core::View&, const core::VplSet&) {
        picture.image = blank_picture(started.width, started.height);
    };
    hooks.rows = [&](std::span<const float> rows) { fill(rows); };
    hooks.progress = [&](double fraction) { return !progress || progress(fraction); };
    const core::RenderReport report = core::render(session, settings, hooks);
    picture.passes = report.passes;
    picture.vpl_count = report.totals.close_vpls + report.totals.distant_vpls;
    picture.interrupted = report.interrupted;
    picture.pass_samples = report.pass_samples;
    picture.error = report.error;
    return picture;
}

}  // namespace nearlight
