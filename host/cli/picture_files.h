// SPDX-License-Identifier: Apache-2.0
// The files that a renderer's rows go to: any number of EXRs and PNGs at once.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/cli/command.h"
#include "host/image/image_io.h"
#include "host/scene/scene.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {

struct PictureOptions {
    std::vector<std::string> outputs;
    std::vector<std::string> layers;  ///< of EXR files; empty: all
    float exposure = 0.0f;            ///< of PNG files, stops
};

/// -o, --layers and --exposure.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// Finds out before any work starts whether the outputs can be written. Throws
/// Error(ErrorKind::invalid_argument) for an unknown extension or layer, Error(ErrorKind::file) for a folder
/// that does not exist or cannot be written.
void check_outputs(const PictureOptions& options);

/// worldToCamera and worldToNDC in OpenEXR's row-vector convention, as other renderers write them.
Metadata camera_metadata(const SceneCamera& camera);

/// Nothing appears under the final names before commit().
class PictureFiles {
  public:
    explicit PictureFiles(PictureOptions options) : options_(std::move(options)) {}

    void open(int width, int height, const Metadata& metadata);
    /// Rows with the channels of layer_channels().
    void write_rows(std::span<const float> rows);
    /// Rows that are missing become black.
    void commit(double render_seconds);

  private:
    struct File {
        ImageWriter writer;
        std::vector<FilmLayer> layers;  ///< those that go there
    };

    PictureOptions options_;
    std::vector<File> files_;
    std::vector<float> selected_;
};

}  // namespace nearlight::core
