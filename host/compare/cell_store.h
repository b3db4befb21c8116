// SPDX-License-Identifier: Apache-2.0
// A folder of measured cells, so that a comparison goes on where it stopped.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/compare/cell.h"
#include "host/image/image.h"

namespace nearlight::core {

/// One JSON file a cell, named after the cell and the conditions it was measured under.
class CellStore {
  public:
    /// `conditions`: everything besides the cell's own numbers that changes its result, in any form: scene
    /// hash, settings, reference, device, program version. Under other conditions there are other cells.
    CellStore(std::filesystem::path folder, std::string conditions)
        : folder_(std::move(folder)), conditions_(std::move(conditions)) {}

    /// A file that cannot be understood is as good as missing, with a warning.
    [[nodiscard]] std::optional<Cell> load(const CellId& id) const;
    /// Throws Error(ErrorKind::file), as the next one.
    void save(const Cell& cell) const;
    void save_picture(const CellId& id, const Image& picture) const;
    [[nodiscard]] bool has_picture(const CellId& id) const;
    [[nodiscard]] Image load_picture(const CellId& id) const;

    /// Without extension.
    [[nodiscard]] std::filesystem::path file_stem_of(const CellId& id) const;

  private:
    std::filesystem::path folder_;
    std::string conditions_;
};

}  // namespace nearlight::core
