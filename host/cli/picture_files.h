// SPDX-License-Identifier: Apache-2.0
// Writes rendered rows to any number of EXR and PNG files at once.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/cli/command.h"
#include "host/cli/screen_options.h"
#include "host/image/exposure_meter.h"
#include "host/image/image_io.h"
#include "host/scene/scene.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {

struct PictureOptions {
    std::vector<std::string> outputs;
    std::vector<std::string> layers;  ///< layers of EXR files; empty: all that need not be asked for
    ScreenOptions screen;             ///< look of PNG files
    bool is_full_precision = false;   ///< all numbers of EXR files are 32-bit floats
    ExrCompression compression = ExrCompression::zip;
    bool offers_mattes = false;  ///< --layers may ask for those of kMatteLayers
    bool denoise = false;        ///< the beauty is denoised, and rows end in the layer `raw`
    bool denoise_fast = false;   ///< less well, in a tenth of the time
};

/// The layer after all others in the rows of a denoised picture: the beauty as it was rendered.
inline constexpr FilmLayer kRawLayer{"raw", "RGB", NEARLIGHT_LAYER_CHANNELS, NEARLIGHT_CHANNELS_RGB,
                                     PassRule::mean};

/// Adds -o, --layers, --exposure, --tonemap, --exr-precision, --exr-compression and --denoise.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// Whether there are files for screens, which have an exposure.
bool has_screen_pictures(const PictureOptions& options);

/// The picture that a scene gets in the current folder if no output is named.
std::string default_output(const std::filesystem::path& scene);

/// Throws Error(ErrorKind::file) if the file cannot be written, as far as one can see beforehand.
void check_writable(const std::string& file);

/// Throws Error(ErrorKind::invalid_argument) if what `option` is to write would replace a picture, because
/// its file is one of `outputs`.
void check_is_no_output(const std::string& option, const std::filesystem::path& file,
                        const std::vector<std::string>& outputs);

/// Checks before any work starts that the outputs can be written. Throws Error(ErrorKind::invalid_argument)
/// for an unknown extension or layer, and Error(ErrorKind::file) for a folder that does not exist or cannot
/// be written to.
void check_outputs(const PictureOptions& options);

/// The attributes worldToCamera and worldToNDC, in OpenEXR's row-vector convention like those of other
/// renderers.
Metadata camera_metadata(const SceneCamera& camera);

/// The output files of one picture. They appear under their final names only with commit(), after which
/// open() begins anew.
class PictureFiles {
  public:
    explicit PictureFiles(PictureOptions options) : options_(std::move(options)) {}

    /// Names the files that the next open() begins, as many as before.
    void set_outputs(std::vector<std::string> outputs) { options_.outputs = std::move(outputs); }
    /// `place` says which part of a larger picture this is, if it is one.
    void open(int width, int height, const Metadata& metadata, const ScreenLook& look,
              const std::optional<ImagePlace>& place = std::nullopt);
    /// Sets an attribute that is a text, before the first rows.
    void set_text(const std::string& name, const std::string& text);
    /// Writes rows with the channels of layer_channels(), then those of kRawLayer if the picture is denoised,
    /// and then those of the mattes that the options ask for.
    void write_rows(std::span<const float> rows);
    /// Completes the files; missing rows become black. Logs what became of them, unless it is `quiet`.
    void commit(double render_seconds, bool quiet = false);

  private:
    struct File {
        std::string name;
        ImageWriter writer;
        std::vector<FilmLayer> layers;  ///< layers that the file gets
    };

    [[nodiscard]] bool waits_for_exposure(const std::string& file) const;
    [[nodiscard]] ImageWriterOptions exr_options(std::span<const FilmLayer> layers) const;
    void keep_for_exposure(std::span<const float> rows);
    void write_waiting(bool quiet);

    PictureOptions options_;
    std::vector<File> files_;
    int width_ = 0;
    int height_ = 0;
    Metadata metadata_;
    ScreenLook look_;
    std::optional<ImagePlace> place_;
    bool has_waiting_ = false;    ///< some files wait for the exposure, which only the whole picture tells
    std::vector<float> waiting_;  ///< RGB, for these files
    ExposureMeter meter_;         ///< decides about that exposure
    std::vector<float> selected_;
};

}  // namespace nearlight::core
