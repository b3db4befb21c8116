// SPDX-License-Identifier: Apache-2.0
// Files that appear under their names whole or not at all.
#pragma once

#include <filesystem>
#include <system_error>

namespace nearlight::core {

/// What is to survive if the machine stops right after a file was written.
enum class Durability {
    cache,  ///< nothing: a file that turns out damaged or missing is made again, so nobody waits for the disk
    result,  ///< the old file or the new one: what the user asked for may have taken hours
};

/// A temporary file beside its target. The owner writes it by any means and closes it; commit() then gives it
/// the target's name. Without a commit it is removed, and an old file at the target stays as it is. No two
/// objects share a temporary file, whatever their threads, processes and machines.
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;

    [[nodiscard]] const std::filesystem::path& target() const { return target_; }
    /// Not there until the owner makes it; empty after a successful commit.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

    /// Why it failed, if it did.
    [[nodiscard]] std::error_code commit(Durability durability);

  private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
};

}  // namespace nearlight::core
