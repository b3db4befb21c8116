// SPDX-License-Identifier: Apache-2.0
// Files that appear under their names whole or not at all.
#pragma once

#include <filesystem>
#include <system_error>

namespace nearlight::core {

/// What a power failure right after a commit may do to the file.
enum class Durability {
    cache,   ///< The file may be damaged or lost, because it can be made again; commit() is quick.
    result,  ///< Either the old or the new file remains whole; commit() waits for the disk.
};

/// A temporary file in its target's folder. The owner writes and closes it; commit() then gives it the
/// target's name. Without a commit it is removed, and an old file at the target stays as it is. No two
/// objects share a temporary file, not even across threads, processes and machines. What a killed process
/// left of a target is removed when a process on the same machine next writes this target.
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;

    [[nodiscard]] const std::filesystem::path& target() const { return target_; }
    /// The path at which the owner creates the file; empty after a successful commit.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

    /// Gives the closed temporary file the target's name. Returns the error, after which the old file is
    /// still there, or an empty code.
    [[nodiscard]] std::error_code commit(Durability durability);

  private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
};

}  // namespace nearlight::core
