// SPDX-License-Identifier: Apache-2.0
#include "host/image/oidn_library.h"

#include <dlfcn.h>

#include <cstdlib>
#include <vector>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

constexpr int kMajorVersion = 2;
constexpr const char* kSoname = "libOpenImageDenoise.so.2";
constexpr const char* kFileVariable = "NEARLIGHT_OIDN";
constexpr const char* kWayOut = "run `scripts/setup --denoise`, or set NEARLIGHT_OIDN to the library's file";

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

std::vector<std::string> candidates() {
    if (const std::string file = variable(kFileVariable); !file.empty()) {
        return {file};
    }
    std::vector<std::string> files{kSoname};
    if (const fs::path folder = oidn_folder(); !folder.empty()) {
        files.push_back((folder / kSoname).string());
    }
    files.emplace_back("libOpenImageDenoise.so");
    return files;
}

[[noreturn]] void refuse(const std::string& file, const std::string& reason) {
    throw Error(ErrorKind::failure, "cannot denoise with '" + file + "': " + reason + "; " + kWayOut);
}

/// Loads the first candidate that is there, and sets `file` to its name.
std::shared_ptr<void> load(std::string& file) {
    std::string reason;
    for (const std::string& candidate : candidates()) {
        if (void* const handle = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL)) {
            file = candidate;
            return {handle, [](void* library) { dlclose(library); }};
        }
        const char* const message = dlerror();
        reason = message == nullptr ? "it does not load" : message;
    }
    if (const std::string wanted = variable(kFileVariable); !wanted.empty()) {
        refuse(wanted, reason);
    }
    throw Error(ErrorKind::failure,
                std::string("cannot denoise: there is no library of Open Image Denoise 2; ") + kWayOut);
}

template <typename Function>
void find(void* library, const std::string& file, const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(dlsym(library, name));
    if (function == nullptr) {
        refuse(file, std::string("it lacks the function ") + name + " of Open Image Denoise 2");
    }
}

/// The version of the library, from a number like 20501.
std::string version_text(int version) {
    return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
           std::to_string(version % 100);
}

}  // namespace

fs::path oidn_folder() {
    // The libraries find one another in a folder "../lib".
    const fs::path inner = fs::path("nearlight") / "oidn" / "lib";
    if (const std::string data = variable("XDG_DATA_HOME"); !data.empty()) {
        return data / inner;
    }
    const std::string home = variable("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".local" / "share" / inner;
}

OidnLibrary::OidnLibrary() : handle_(load(file_)) {
#define NEARLIGHT_OIDN_FIND(result, name, parameters) \
    find(handle_.get(), file_, "oidn" #name, functions_.name);
    NEARLIGHT_OIDN_FUNCTIONS(NEARLIGHT_OIDN_FIND)
#undef NEARLIGHT_OIDN_FIND
    const OidnDevice device = functions_.NewDevice(kOidnCpuDevice);
    if (device == nullptr) {
        const char* message = nullptr;
        functions_.GetDeviceError(nullptr, &message);
        refuse(file_, message == nullptr ? "it has no device for this CPU" : message);
    }
    const int version = functions_.GetDeviceInt(device, "version");
    functions_.ReleaseDevice(device);
    version_ = version_text(version);
    if (version / 10000 != kMajorVersion) {
        refuse(file_, "it is of version " + version_ + ", and nearlight takes version 2");
    }
}

}  // namespace nearlight::core
