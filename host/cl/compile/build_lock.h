// SPDX-License-Identifier: Apache-2.0
// One build of a program at a time among all processes that share a driver's folder.
//
// PoCL 3.1, which Debian 12 has, removes the file of a program before it writes it again. A process that
// builds the same program at that moment finds no file, and an assertion of PoCL ends it. PoCL 6.0 renames a
// new file over the old one.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace nearlight::core {

/// A lock on a program, held until the object goes or its process ends. Other programs are not concerned.
class BuildLock {
  public:
    /// Waits for the other holders of `key`, in this process and in others. Goes on without the lock if
    /// `folder` allows none, if `give_up` returns true, or after a time in which any program compiles: a
    /// holder may have been suspended.
    BuildLock(const std::filesystem::path& folder, const std::string& key,
              const std::function<bool()>& give_up);
    ~BuildLock();
    BuildLock(const BuildLock&) = delete;
    BuildLock& operator=(const BuildLock&) = delete;

    [[nodiscard]] bool held() const { return held_; }

  private:
    int file_ = -1;
    bool held_ = false;
};

}  // namespace nearlight::core
