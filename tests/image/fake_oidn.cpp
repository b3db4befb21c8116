// SPDX-License-Identifier: Apache-2.0
// A stand-in for the library of Open Image Denoise, whose filter halves the light and makes the first value a
// NaN. NEARLIGHT_FAKE_VERSION is the version that it reports, and NEARLIGHT_FAKE_LACKS_VERSION leaves out the
// function that reports it, as in Open Image Denoise 1.
#include <cmath>
#include <cstddef>
#include <cstring>

struct OidnFilterState {
    const float* color = nullptr;
    float* output = nullptr;
    std::size_t values = 0;
};

namespace {
int device;
}

extern "C" {
#define EXPORTED __attribute__((visibility("default")))
EXPORTED void* oidnNewDevice(int) {
    return &device;
}
EXPORTED void oidnReleaseDevice(void*) {}
EXPORTED void oidnCommitDevice(void*) {}
EXPORTED void oidnSetDeviceBool(void*, const char*, bool) {}
EXPORTED void oidnSetDeviceInt(void*, const char*, int) {}
#ifndef NEARLIGHT_FAKE_LACKS_VERSION
EXPORTED int oidnGetDeviceInt(void*, const char*) {
    return NEARLIGHT_FAKE_VERSION;
}
#endif
EXPORTED int oidnGetDeviceError(void*, const char**) {
    return 0;
}
EXPORTED OidnFilterState* oidnNewFilter(void*, const char*) {
    return new OidnFilterState;
}
EXPORTED void oidnReleaseFilter(OidnFilterState* filter) {
    delete filter;
}
EXPORTED void oidnSetFilterBool(void*, const char*, bool) {}
EXPORTED void oidnSetFilterInt(void*, const char*, int) {}
EXPORTED void oidnSetSharedFilterImage(OidnFilterState* filter, const char* name, void* pixels, int,
                                       std::size_t width, std::size_t height, std::size_t, std::size_t,
                                       std::size_t) {
    filter->values = width * height * 3;
    if (std::strcmp(name, "color") == 0) {
        filter->color = static_cast<const float*>(pixels);
    } else if (std::strcmp(name, "output") == 0) {
        filter->output = static_cast<float*>(pixels);
    }
}
EXPORTED void oidnCommitFilter(void*) {}
EXPORTED void oidnExecuteFilter(OidnFilterState* filter) {
    if (filter->color == nullptr) {
        return;  // It is an albedo or a normal that is to be cleaned.
    }
    for (std::size_t i = 0; i < filter->values; ++i) {
        filter->output[i] = i == 0 ? NAN : 0.5f * filter->color[i];
    }
}
}
