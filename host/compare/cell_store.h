// SPDX-License-Identifier: Apache-2.0
// A folder of measured cells, from which a stopped comparison resumes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/compare/cell.h"
#include "host/image/image.h"

namespace nearlight::core {

/// Stores one JSON file per cell, named after the cell and the conditions under which it was measured.
class CellStore {
  public:
    /// `conditions` names in any form everything besides the cell's ID that changes its result: scene hash,
    /// settings, reference, device, program version. Cells of other conditions are never loaded.
    CellStore(std::filesystem::path folder, std::string conditions)
        : folder_(std::move(folder)), conditions_(std::move(conditions)) {}

    /// The stored cell, or nothing. A file that cannot be read counts as missing, with a warning.
    [[nodiscard]] std::optional<Cell> load(const CellId& id) const;
    /// Throws Error(ErrorKind::file) if the file cannot be written.
    void save(const Cell& cell) const;
    /// Throws Error(ErrorKind::file) if the file cannot be written.
    void save_picture(const CellId& id, const Image& picture) const;
    [[nodiscard]] bool has_picture(const CellId& id) const;
    /// Throws Error(ErrorKind::file) if the picture is missing or broken.
    [[nodiscard]] Image load_picture(const CellId& id) const;

    /// Path of the cell's files without their extension.
    [[nodiscard]] std::filesystem::path file_stem_of(const CellId& id) const;

  private:
    std::filesystem::path folder_;
    std::string conditions_;
};

}  // namespace nearlight::core
