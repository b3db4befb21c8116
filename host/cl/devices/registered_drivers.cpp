// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/registered_drivers.h"

#include <dlfcn.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

/// With a lower limit of open files, the loader cannot read the registry, or PoCL 3.1 cannot compile a first
/// picture, which takes 16 here, and ends the process.
constexpr rlim_t kMinFiles = 20;

/// The folder of files that name drivers, or one such file. The variables are those of ocl-icd and of
/// Khronos's loader.
fs::path registry() {
    for (const char* name : {"OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"}) {
        if (const char* value = std::getenv(name); value != nullptr && *value != '\0') {
            return value;
        }
    }
    return "/etc/OpenCL/vendors";
}

/// Adds to `problems` why the registry cannot be read.
std::vector<fs::path> registered_files(std::vector<std::string>& problems) {
    const fs::path place = registry();
    std::error_code error;
    if (!fs::is_directory(place, error)) {
        return {place};
    }
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(place, error), end; !error && entry != end; entry.increment(error)) {
        files.push_back(entry->path());
    }
    if (error) {
        problems.push_back("cannot read '" + place.string() +
                           "', where drivers are registered: " + error.message());
    }
    std::ranges::sort(files);
    return files;
}

/// The name of the library, which is the file's first line.
std::string library_in(const fs::path& file) {
    std::error_code error;
    std::string name;
    if (fs::is_regular_file(file, error)) {
        std::ifstream stream(file);
        std::getline(stream, name);
    }
    name.erase(std::find_if(name.rbegin(), name.rend(), [](unsigned char c) { return c > ' '; }).base(),
               name.end());
    return name;
}

/// Why a library cannot be loaded; empty if it can.
std::string reason_not_to_load(const std::string& library) {
    dlerror();
    // A driver stays, because LLVM ends the process when it is loaded, unloaded and loaded again.
    if (dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL) != nullptr) {
        return "";
    }
    const char* const reason = dlerror();
    return reason == nullptr ? "unknown reason" : reason;
}

}  // namespace

std::string too_few_files() {
    rlimit files{};
    if (getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= kMinFiles) {
        return "";
    }
    return "no more than " + std::to_string(files.rlim_cur) +
           " files may be open at a time, which is too few for drivers; raise the limit (ulimit -n)";
}

std::vector<std::string> drivers_that_do_not_load() {
    std::vector<std::string> problems;
    for (const fs::path& file : registered_files(problems)) {
        const std::string library = file.extension() == ".icd" ? library_in(file) : "";
        if (library.empty()) {
            continue;
        }
        if (const std::string reason = reason_not_to_load(library); !reason.empty()) {
            problems.push_back("the driver '" + library + "', which '" + file.string() +
                               "' names, cannot be loaded: " + reason);
        }
    }
    return problems;
}

}  // namespace nearlight::core
