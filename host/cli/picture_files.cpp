// SPDX-License-Identifier: Apache-2.0
#include "host/cli/picture_files.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

#include "host/base/files.h"
#include "host/base/words.h"
#include "host/cli/log.h"
#include "host/cli/matte_layers.h"
#include "host/scene/camera.h"

namespace nearlight::core {
namespace {

/// The names of the layers with the rule `files`, or of all if there is none.
std::vector<std::string> names_of(std::span<const FilmLayer> layers,
                                  std::optional<FileRule> files = std::nullopt) {
    std::vector<std::string> names;
    for (const FilmLayer& layer : layers) {
        if (!files || layer.files == *files) {
            names.emplace_back(layer.name);
        }
    }
    return names;
}

/// The names, and those of layers of mattes if the options offer them.
std::vector<std::string> with_mattes(std::vector<std::string> names, const PictureOptions& options) {
    for (const MatteLayer& layer : kMatteLayers) {
        if (options.offers_mattes) {
            names.emplace_back(layer.name);
        }
    }
    return names;
}

/// The layers of the rows that are written, without mattes, in their order.
std::vector<FilmLayer> layers_of(const PictureOptions& options) {
    std::vector<FilmLayer> layers(kFilmLayers.begin(), kFilmLayers.end());
    if (options.denoise) {
        layers.push_back(kRawLayer);
    }
    return layers;
}

/// The number of channels of the rows before those of mattes.
std::size_t first_matte_channel(const PictureOptions& options) {
    return NEARLIGHT_LAYER_CHANNELS + (options.denoise ? kRawLayer.channel_count : 0);
}

std::size_t channel_count(const PictureOptions& options) {
    return first_matte_channel(options) + kMatteChannels * matte_layers(options.layers).size();
}

/// The layers besides the beauty, which every picture has.
constexpr std::span<const FilmLayer> optional_layers() {
    static_assert(kFilmLayers.front().is_beauty());
    return std::span(kFilmLayers).subspan(1);
}

bool has_outputs(const PictureOptions& options, std::string_view extension) {
    return std::ranges::any_of(
        options.outputs, [&](const std::string& file) { return lower_case_extension(file) == extension; });
}

/// Names options that change none of the files.
void warn_of_idle_options(const PictureOptions& options) {
    const bool has_exr = has_outputs(options, ".exr");
    const bool has_png = has_outputs(options, ".png");
    const bool names_exr = options.is_full_precision || options.compression != ExrCompression::zip;
    const bool names_look = !options.screen.exposure.empty() || options.screen.curve;
    if (!has_exr && names_exr) {
        spdlog::warn("--exr-precision and --exr-compression change nothing: no output is an EXR file");
    }
    if (!has_png && names_look) {
        spdlog::warn("--exposure and --tonemap change nothing: no output is a PNG file");
    }
}

/// The layers that a file gets, in the order of the rows.
std::vector<FilmLayer> layers_for(const PictureOptions& options, const std::string& file) {
    const bool takes_more = lower_case_extension(file) == ".exr";
    std::vector<FilmLayer> chosen;
    for (const FilmLayer& layer : layers_of(options)) {
        const bool wanted = options.layers.empty()
                                ? layer.files == FileRule::always
                                : std::ranges::find(options.layers, layer.name) != options.layers.end();
        if (layer.is_beauty() || (takes_more && wanted)) {
            chosen.push_back(layer);
        }
    }
    if (takes_more) {
        std::ranges::move(parts_of(matte_layers(options.layers), first_matte_channel(options)),
                          std::back_inserter(chosen));
    }
    return chosen;
}

void check_output(const std::string& file) {
    if (lower_case_extension(file) != ".exr" && lower_case_extension(file) != ".png") {
        throw Error(ErrorKind::invalid_argument,
                    "cannot write '" + file + "': the names of pictures end in .exr or .png");
    }
    check_writable(file);
}

std::vector<float> transposed(const Mat4& m) {
    std::vector<float> values;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            values.push_back(static_cast<float>(m(row, column)));
        }
    }
    return values;
}

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
    command
        .add_option("-o,--output", options.outputs,
                    "Picture to write: .exr (all layers) or .png (tone-mapped); may be given several times "
                    "(default: SCENE-render.png in this folder)")
        ->type_name("OUT")
        ->allow_extra_args(false);
    command
        .add_option(
            "--layers,--aov", options.layers,
            fmt::format("Layers of EXR pictures besides beauty, comma-separated (default: {}); on "
                        "request: {}; with --denoise also raw",
                        joined(names_of(optional_layers(), FileRule::always), ", "),
                        joined(with_mattes(names_of(optional_layers(), FileRule::asked), options), ", ")))
        ->type_name("LIST")
        ->delimiter(',')
        ->allow_extra_args(false);
    add_screen_options(command, options.screen);
    add_words(
        command, "--exr-precision", {"half", "float"},
        [&options](const std::string& word) { options.is_full_precision = word == "float"; },
        "half: colours and normals of EXR pictures are 16-bit floats, up to 65504, and positions, depths "
        "and variances are 32-bit floats; float: all are 32-bit floats")
        ->default_str("half");
    add_choice<ExrCompression>(
        command, "--exr-compression", options.compression, {kExrCompressions.begin(), kExrCompressions.end()},
        "Compression of EXR pictures: none, zip, piz (best for noise), or dwaa (lossy)")
        ->default_str("zip");
    command.add_flag(
        "--denoise", options.denoise,
        "Denoise the picture with Open Image Denoise (`scripts/setup --denoise` installs it); the layer "
        "raw is the picture as it was rendered");
}

bool has_screen_pictures(const PictureOptions& options) {
    return has_outputs(options, ".png");
}

std::string default_output(const std::filesystem::path& scene) {
    return scene.stem().string() + "-render.png";
}

void check_writable(const std::string& file) {
    namespace fs = std::filesystem;
    const fs::path parent = fs::path(file).parent_path();
    const fs::path folder = parent.empty() ? fs::path(".") : parent;
    if (const std::string missing = missing_folder_text(file); !missing.empty()) {
        throw Error(ErrorKind::file, "cannot write '" + file + "': " + missing);
    }
    std::error_code error;
    if (fs::is_directory(file, error)) {
        throw Error(ErrorKind::file, "cannot write '" + file + "': it is a folder; give a file");
    }
    if (fs::exists(file, error) && access(file.c_str(), W_OK) != 0) {
        throw Error(ErrorKind::file,
                    "cannot write '" + file + "': it exists and is read-only; give another file");
    }
    if (access(folder.c_str(), W_OK) != 0) {
        throw Error(ErrorKind::file, "cannot write '" + file + "': the folder '" + folder.string() +
                                         "' is not writable; give another folder");
    }
}

void check_is_no_output(const std::string& option, const std::filesystem::path& file,
                        const std::vector<std::string>& outputs) {
    const auto whole = [](const std::filesystem::path& path) {
        return std::filesystem::absolute(path).lexically_normal();
    };
    const bool is_output =
        std::ranges::any_of(outputs, [&](const std::string& output) { return whole(output) == whole(file); });
    if (is_output) {
        throw Error(ErrorKind::invalid_argument,
                    option + " '" + file.string() + "' is the picture's file too; give another one");
    }
}

void check_outputs(const PictureOptions& options) {
    const std::vector<std::string> known = with_mattes(names_of(layers_of(options)), options);
    for (const std::string& layer : options.layers) {
        if (std::ranges::find(known, layer) == known.end()) {
            throw Error(ErrorKind::invalid_argument,
                        "unknown layer '" + layer + "'; choose from: " + joined(known, ", ") +
                            (options.denoise ? "" : "; with --denoise also raw"));
        }
    }
    if (!options.layers.empty() && !has_outputs(options, ".exr")) {
        throw Error(ErrorKind::invalid_argument,
                    "--layers asks for layers of EXR pictures, but no output is one; give -o FILE.exr");
    }
    if (const std::vector<MatteLayer> mattes = matte_layers(options.layers);
        !mattes.empty() && options.compression == ExrCompression::dwaa) {
        throw Error(ErrorKind::invalid_argument,
                    fmt::format("the layer {} would not survive the compression dwaa; use zip or piz",
                                mattes.front().name));
    }
    check_screen_options(options.screen);
    for (const std::string& file : options.outputs) {
        check_output(file);
    }
    warn_of_idle_options(options);
}

Metadata camera_metadata(const SceneCamera& camera) {
    const Mat4 world_to_camera = inverse(camera.to_world);
    const PictureWindow window = picture_window(camera, camera.width, camera.height);
    const double x = window.pixel * camera.width;
    const double y = window.pixel * camera.height;
    // In NDC, x and y are in [0, 1] from the top left corner after division by w, which is z, or 1 for an
    // orthographic camera. The camera's +X points left.
    const Mat4 projection =
        camera.kind == CameraKind::orthographic
            ? Mat4{{-1 / x, 0, 0, -window.left / x, 0, -1 / y, 0, -window.top / y, 0, 0, 1, 0, 0, 0, 0, 1}}
            : Mat4{{-1 / x, 0, -window.left / x, 0, 0, -1 / y, -window.top / y, 0, 0, 0, 1, 0, 0, 0, 1, 0}};
    // OpenEXR's camera space is left-handed, with +X to the right.
    constexpr Mat4 kMirrorX{{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    return {{"worldToCamera", transposed(kMirrorX * world_to_camera)},
            {"worldToNDC", transposed(projection * world_to_camera)}};
}

bool PictureFiles::waits_for_exposure(const std::string& file) const {
    return lower_case_extension(file) == ".png" && !look_.exposure;
}

/// How an EXR file with these layers is written.
ImageWriterOptions PictureFiles::exr_options(std::span<const FilmLayer> layers) const {
    ImageWriterOptions options{.metadata = metadata_, .compression = options_.compression, .place = place_};
    if (options_.is_full_precision) {
        return options;
    }
    for (const FilmLayer& layer : layers) {
        options.half.resize(options.half.size() + layer.channel_count, layer.storage == Storage::half);
    }
    return options;
}

void PictureFiles::open(int width, int height, const Metadata& metadata, const ScreenLook& look,
                        const std::optional<ImagePlace>& place) {
    width_ = width;
    height_ = height;
    metadata_ = metadata;
    metadata_["renderTimeSeconds"] = 0.0f;
    look_ = look;
    place_ = place;
    files_.clear();
    has_waiting_ = false;
    waiting_.clear();
    meter_ = {};
    for (const std::string& file : options_.outputs) {
        if (waits_for_exposure(file)) {
            has_waiting_ = true;
            waiting_.reserve(NEARLIGHT_CHANNELS_RGB * static_cast<std::size_t>(width) *
                             static_cast<std::size_t>(height));
            continue;
        }
        std::vector<FilmLayer> layers = layers_for(options_, file);
        std::vector<std::string> names;
        for (const FilmLayer& layer : layers) {
            std::ranges::move(channel_names(layer), std::back_inserter(names));
        }
        const bool is_screen = lower_case_extension(file) == ".png";
        const ImageWriterOptions writer_options =
            is_screen ? screen_writer_options(look_, *look_.exposure, without_matte_attributes(metadata_))
                      : exr_options(layers);
        files_.push_back(
            {file, ImageWriter(file, width, height, std::move(names), writer_options), std::move(layers)});
    }
}

void PictureFiles::set_text(const std::string& name, const std::string& text) {
    metadata_[name] = text;
    for (File& file : files_) {
        file.writer.set_text(name, text);
    }
}

/// Writes the files that waited for the exposure.
void PictureFiles::write_waiting(bool quiet) {
    if (!has_waiting_) {
        return;
    }
    const float exposure = meter_.exposure();
    tell_automatic_exposure(look_, exposure, quiet);
    for (const std::string& file : options_.outputs) {
        if (waits_for_exposure(file)) {
            ImageWriter writer(file, width_, height_, {"R", "G", "B"},
                               screen_writer_options(look_, exposure, without_matte_attributes(metadata_)));
            writer.write_rows(waiting_);
            writer.commit();
        }
    }
}

/// Keeps the beauty of rows for the files that wait for the exposure, and meters them.
void PictureFiles::keep_for_exposure(std::span<const float> rows) {
    const std::size_t stride = channel_count(options_);
    for (std::size_t first = 0; first < rows.size(); first += stride) {
        const std::span<const float> pixel = rows.subspan(first, stride);
        const auto color_at = [&](std::size_t channel) {
            return Vec3{pixel[channel], pixel[channel + 1], pixel[channel + 2]};
        };
        const Vec3 beauty = color_at(NEARLIGHT_LAYER_BEAUTY);
        waiting_.insert(waiting_.end(), {beauty.x, beauty.y, beauty.z});
        meter_.add(beauty, pixel[NEARLIGHT_LAYER_DEPTH], color_at(NEARLIGHT_LAYER_ALBEDO));
    }
}

void PictureFiles::write_rows(std::span<const float> rows) {
    const std::size_t stride = channel_count(options_);
    if (has_waiting_) {
        keep_for_exposure(rows);
    }
    for (File& file : files_) {
        selected_.clear();
        for (std::size_t first = 0; first < rows.size(); first += stride) {
            const std::span<const float> pixel = rows.subspan(first, stride);
            for (const FilmLayer& layer : file.layers) {
                const std::span<const float> channels =
                    pixel.subspan(layer.first_channel, layer.channel_count);
                selected_.insert(selected_.end(), channels.begin(), channels.end());
            }
        }
        file.writer.write_rows(selected_);
    }
}

void PictureFiles::commit(double render_seconds, bool quiet) {
    for (File& file : files_) {
        file.writer.commit({{"renderTimeSeconds", static_cast<float>(render_seconds)}});
        if (file.writer.limited_count() > 0 && !quiet) {
            spdlog::warn("{}: {} values above 65504 count as that; --exr-precision float keeps them",
                         file.name, file.writer.limited_count());
        }
    }
    write_waiting(quiet);
}

}  // namespace nearlight::core
