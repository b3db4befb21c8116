// SPDX-License-Identifier: Apache-2.0
// Tunables on disk: lines of "name value", which people can read and change.
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/cl/devices/tunables.h"
#include "host/cl/kernel_source.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr const char* kHead = "nearlight tunables 3";

/// A hash of the text of kernel files, followed by their names, so that a reader of the key can compute it
/// again.
std::string kernels_key(std::span<const std::string> files, const std::filesystem::path& kernel_dir) {
    Hasher hasher;
    std::string names;
    for (const std::string& file : files) {
        hasher.add_text(expand_kernel_source(file, kernel_dir));
        names += " " + file;
    }
    return hex_digits(hasher.hash64()) + names;
}

/// Whether the kernels that `key` names have not changed since kernels_key() made it.
bool is_current(const std::string& key, const std::filesystem::path& kernel_dir) {
    std::istringstream words(key);
    std::string hash;
    words >> hash;
    const std::vector<std::string> files{std::istream_iterator<std::string>(words), {}};
    try {
        return !files.empty() && kernels_key(files, kernel_dir) == key;
    } catch (const Error&) {
        return false;  // one of the files is gone
    }
}

std::string device_key(const DeviceEntry& entry) {
    return entry.platform + "; " + entry.name + "; " + entry.version + "; " + entry.driver;
}

std::string to_text(const Tunables& tunables, const DeviceEntry& entry, const std::string& kernels) {
    std::string text = std::string(kHead) + "\ndevice " + device_key(entry) + "\nkernels " + kernels + "\n";
    for (const TunableField& field : tunable_fields()) {
        text += std::string(field.name) + " " + std::to_string(tunables.*field.value) + "\n";
    }
    return text;
}

/// What is wrong with a file, as the end of a warning's sentence.
struct Complaint {
    std::string text;
};

std::map<std::string, std::string> read_lines(std::istream& file) {
    std::string line;
    if (!std::getline(file, line) || line != kHead) {
        throw Complaint{"does not begin with '" + std::string(kHead) + "'"};
    }
    std::map<std::string, std::string> lines;
    while (std::getline(file, line)) {
        const std::size_t blank = line.find(' ');
        if (blank == std::string::npos ||
            !lines.emplace(line.substr(0, blank), line.substr(blank + 1)).second) {
            throw Complaint{"has a line that is not understood, '" + line + "'"};
        }
    }
    return lines;
}

std::uint32_t parse(const TunableField& field, const std::map<std::string, std::string>& lines) {
    const auto found = lines.find(field.name);
    if (found == lines.end()) {
        throw Complaint{"has no " + std::string(field.name)};
    }
    std::istringstream stream(found->second);
    std::int64_t value = 0;
    if (!(stream >> value) || !stream.eof() || value < 0 || value > UINT32_MAX ||
        !field.allows(static_cast<std::uint32_t>(value))) {
        throw Complaint{std::string(field.name) + " cannot be '" + found->second + "'"};
    }
    return static_cast<std::uint32_t>(value);
}

/// Reads a file. Throws Complaint unless it is complete and made for the same device and kernels.
Tunables read_tunables(std::istream& file, const DeviceEntry& entry,
                       const std::filesystem::path& kernel_dir) {
    const std::map<std::string, std::string> lines = read_lines(file);
    const auto is = [&](const char* name, const std::string& text) {
        const auto found = lines.find(name);
        return found != lines.end() && found->second == text;
    };
    if (!is("device", device_key(entry))) {
        throw Complaint{"is for another device or driver"};
    }
    if (const auto found = lines.find("kernels");
        found == lines.end() || !is_current(found->second, kernel_dir)) {
        throw Complaint{"was made with other kernels"};
    }
    Tunables tunables{};
    for (const TunableField& field : tunable_fields()) {
        tunables.*field.value = parse(field, lines);
    }
    return tunables;
}

}  // namespace

std::filesystem::path tunables_file(const DeviceEntry& entry, const std::filesystem::path& cache_dir) {
    if (cache_dir.empty() || cache_dir == "none") {
        return {};
    }
    return cache_dir / ("tunables-" + hex_digits(hash64(device_key(entry))) + ".txt");
}

ChosenTunables choose_tunables(const DeviceEntry& entry, const std::filesystem::path& cache_dir,
                               const std::filesystem::path& kernel_dir) {
    std::string warning;
    const std::filesystem::path path = tunables_file(entry, cache_dir);
    if (std::ifstream file(path); !path.empty() && file) {
        try {
            return {read_tunables(file, entry, kernel_dir), path.string(), true, {}};
        } catch (const Complaint& complaint) {
            warning = path.string() + " " + complaint.text +
                      "; the usual tunables are used instead, and `nearlight tune` makes a new file";
        }
    }
    const TunablesRow& row = tunables_row(entry.kind);
    return {row.values, std::string("table for ") + row.name, false, std::move(warning)};
}

void store_tunables(const Tunables& tunables, std::span<const std::string> kernels, const DeviceEntry& entry,
                    const std::filesystem::path& cache_dir, const std::filesystem::path& kernel_dir) {
    const std::filesystem::path path = tunables_file(entry, cache_dir);
    if (path.empty()) {
        throw Error(ErrorKind::invalid_argument, "there is no folder to keep tunables in; name one",
                    "cache_dir");
    }
    make_folder(cache_dir);
    write_text(path, to_text(tunables, entry, kernels_key(kernels, kernel_dir)));
}

}  // namespace nearlight::core
