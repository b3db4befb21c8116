// SPDX-License-Identifier: Apache-2.0
#include "host/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace nearlight::core {
namespace {

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/// The number that stands behind `name` in a file of names and numbers, e.g. "MemAvailable:   1234 kB".
std::optional<std::size_t> number_after(const std::filesystem::path& file, const std::string& name) {
    std::ifstream lines(file);
    for (std::string word; lines >> word;) {
        std::size_t number = 0;
        if (word == name && lines >> number) {
            return number;
        }
        lines.clear();
    }
    return std::nullopt;
}

/// The only number of a file. None if the file is missing or says "max", which means that there is no limit.
std::optional<std::size_t> number_in(const std::filesystem::path& file) {
    std::ifstream text(file);
    std::size_t number = 0;
    return text >> number ? std::optional(number) : std::nullopt;
}

/// The control group of this process, as a path below the root of all groups: "0::/…" in /proc/self/cgroup.
std::filesystem::path group_of_process(const std::filesystem::path& proc) {
    std::ifstream lines(proc / "self" / "cgroup");
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("0::/")) {
            return line.substr(4);
        }
    }
    return {};
}

/// Bytes that a process may still take.
struct Room {
    std::size_t memory = kUnlimited;
    std::size_t swap = kUnlimited;
};

/// What the limits of one group leave. Pages of files count as used there, but the system takes them back
/// when memory is short.
Room room_in_group(const std::filesystem::path& group) {
    const std::optional<std::size_t> limit = number_in(group / "memory.max");
    const std::optional<std::size_t> used = number_in(group / "memory.current");
    Room room;
    if (limit && used) {
        const std::size_t files = number_after(group / "memory.stat", "inactive_file").value_or(0) +
                                  number_after(group / "memory.stat", "active_file").value_or(0);
        room.memory = *limit - std::min(*limit, *used - std::min(*used, files));
    }
    if (const auto swap = number_in(group / "memory.swap.max")) {
        room.swap = *swap - std::min(*swap, number_in(group / "memory.swap.current").value_or(0));
    }
    return room;
}

/// What the limits of a group and of all groups around it leave.
Room room_in_groups(const std::filesystem::path& groups, std::filesystem::path group) {
    Room least = room_in_group(groups);
    for (; !group.empty(); group = group.parent_path()) {
        const Room room = room_in_group(groups / group);
        least = {std::min(least.memory, room.memory), std::min(least.swap, room.swap)};
    }
    return least;
}

}  // namespace

std::size_t peak_host_bytes() {
    rusage usage{};  // Linux counts KiB
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::size_t>(usage.ru_maxrss) * 1024 : 0;
}

std::size_t free_address_space() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return kUnlimited;
    }
    std::ifstream statistics("/proc/self/statm");
    std::size_t pages = 0;
    if (!(statistics >> pages)) {
        return kUnlimited;
    }
    const std::size_t used = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return limit.rlim_cur - std::min<std::size_t>(used, limit.rlim_cur);
}

std::size_t free_memory(const std::filesystem::path& proc, const std::filesystem::path& groups) {
    const std::optional<std::size_t> available = number_after(proc / "meminfo", "MemAvailable:");
    if (!available) {
        return kUnlimited;
    }
    const std::size_t swap = number_after(proc / "meminfo", "SwapFree:").value_or(0);
    const Room room = room_in_groups(groups, group_of_process(proc));
    return std::min(*available * 1024, room.memory) + std::min(swap * 1024, room.swap);
}

}  // namespace nearlight::core
