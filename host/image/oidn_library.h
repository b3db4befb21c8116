// SPDX-License-Identifier: Apache-2.0
// The functions of Open Image Denoise 2 that nearlight calls. Its library is loaded when a picture is to be
// denoised, so that nearlight neither needs it to build nor to start. The declarations follow the reference
// of its C interface (https://www.openimagedenoise.org/documentation.html).
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace nearlight::core {

/// Handles of the library.
using OidnDevice = struct OidnDeviceState*;
using OidnFilter = struct OidnFilterState*;

/// Values of the library's enumerations.
inline constexpr int kOidnCpuDevice = 1;
inline constexpr int kOidnFloat3 = 3;
inline constexpr int kOidnFastQuality = 4;
inline constexpr int kOidnBalancedQuality = 5;
inline constexpr int kOidnHighQuality = 6;

/// Each function as OIDN_FUNCTION(result, name, parameters); its name in the library has the prefix "oidn".
#define NEARLIGHT_OIDN_FUNCTIONS(OIDN_FUNCTION)                                                     \
    OIDN_FUNCTION(OidnDevice, NewDevice, (int type))                                                \
    OIDN_FUNCTION(void, ReleaseDevice, (OidnDevice device))                                         \
    OIDN_FUNCTION(void, CommitDevice, (OidnDevice device))                                          \
    OIDN_FUNCTION(void, SetDeviceBool, (OidnDevice device, const char* name, bool value))           \
    OIDN_FUNCTION(void, SetDeviceInt, (OidnDevice device, const char* name, int value))             \
    OIDN_FUNCTION(int, GetDeviceInt, (OidnDevice device, const char* name))                         \
    OIDN_FUNCTION(int, GetDeviceError, (OidnDevice device, const char** message))                   \
    OIDN_FUNCTION(OidnFilter, NewFilter, (OidnDevice device, const char* type))                     \
    OIDN_FUNCTION(void, ReleaseFilter, (OidnFilter filter))                                         \
    OIDN_FUNCTION(void, SetFilterBool, (OidnFilter filter, const char* name, bool value))           \
    OIDN_FUNCTION(void, SetFilterInt, (OidnFilter filter, const char* name, int value))             \
    OIDN_FUNCTION(                                                                                  \
        void, SetSharedFilterImage,                                                                 \
        (OidnFilter filter, const char* name, void* pixels, int format, std::size_t width,          \
         std::size_t height, std::size_t offset, std::size_t pixel_stride, std::size_t row_stride)) \
    OIDN_FUNCTION(void, CommitFilter, (OidnFilter filter))                                          \
    OIDN_FUNCTION(void, ExecuteFilter, (OidnFilter filter))

#define NEARLIGHT_OIDN_POINTER(result, name, parameters) result(*name) parameters = nullptr;
struct OidnFunctions {
    NEARLIGHT_OIDN_FUNCTIONS(NEARLIGHT_OIDN_POINTER)
};
#undef NEARLIGHT_OIDN_POINTER

/// The folder into which `scripts/setup --denoise` puts the library: $XDG_DATA_HOME/nearlight/oidn/lib or
/// ~/.local/share/nearlight/oidn/lib. Empty if neither variable is set.
std::filesystem::path oidn_folder();

/// The loaded library.
class OidnLibrary {
  public:
    /// Loads the file that $NEARLIGHT_OIDN names. Without that variable, loads the first of these that is
    /// there: libOpenImageDenoise.so.2 where the system looks for libraries, the same in oidn_folder(), and
    /// libOpenImageDenoise.so of the system. Throws Error(ErrorKind::failure) if there is none, if a function
    /// is missing, or if it is of another major version than 2.
    OidnLibrary();

    [[nodiscard]] const OidnFunctions& functions() const { return functions_; }
    [[nodiscard]] const std::string& version() const { return version_; }  ///< "2.5.1"

  private:
    std::string file_;
    std::shared_ptr<void> handle_;
    OidnFunctions functions_;
    std::string version_;
};

}  // namespace nearlight::core
