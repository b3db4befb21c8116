// SPDX-License-Identifier: Apache-2.0
#include "host/image/image_codec.h"

#include <dlfcn.h>

#include <string>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// The module is found by the run path of the program or the shared library, which names a folder of the
/// build tree, or lib/nearlight after installation.
constexpr const char* kModule = "nearlight-images.so";

const ImageCodec& load_codec() {
    void* const module = dlopen(kModule, RTLD_LAZY | RTLD_LOCAL);
    const void* const codec = module == nullptr ? nullptr : dlsym(module, "nearlight_image_codec");
    if (codec == nullptr) {
        const char* const told = dlerror();
        const std::string reason = told == nullptr ? "it is empty" : told;
        // The first is what glibc says where a limit (ulimit -v) leaves no room for a library.
        const bool memory = reason.find("failed to map segment") != std::string::npos ||
                            reason.find("annot allocate memory") != std::string::npos;
        throw Error(memory ? ErrorKind::out_of_memory : ErrorKind::failure,
                    std::string("cannot load ") + kModule + ", which reads and writes image files: " +
                        reason + (memory ? "; free memory" : "; reinstall nearlight"));
    }
    return *static_cast<const ImageCodec*>(codec);
}

}  // namespace

const ImageCodec& image_codec() {
    static const ImageCodec& codec = load_codec();
    return codec;
}

}  // namespace nearlight::core
