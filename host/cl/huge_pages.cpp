// SPDX-License-Identifier: Apache-2.0
#include "host/cl/huge_pages.h"

#include <cstdint>
#include <memory>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace nearlight::core {

#if defined(__linux__) && defined(MADV_HUGEPAGE)
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

/// Address space of `bytes` bytes that begins at a multiple of the huge page size. data() is null if the
/// system gives none.
class Pages {
  public:
    explicit Pages(std::size_t bytes) : length_(bytes + kHugePage) {
        base_ = mmap(nullptr, length_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (base_ != MAP_FAILED) {
            const auto at = reinterpret_cast<std::uintptr_t>(base_);
            data_ = static_cast<char*>(base_) + (kHugePage - at % kHugePage) % kHugePage;
            madvise(data_, bytes, MADV_HUGEPAGE);  // failure is harmless: small pages work too
        }
    }
    ~Pages() {
        if (base_ != MAP_FAILED) {
            munmap(base_, length_);
        }
    }
    Pages(const Pages&) = delete;
    Pages& operator=(const Pages&) = delete;

    [[nodiscard]] void* data() const { return data_; }

  private:
    std::size_t length_;
    void* base_;
    void* data_ = nullptr;
};

void CL_CALLBACK release(cl_mem, void* pages) {
    const std::unique_ptr<Pages> owner(static_cast<Pages*>(pages));
}

}  // namespace

cl::Buffer make_huge_buffer(const cl::Context& context, std::size_t bytes) {
    auto pages = std::make_unique<Pages>(bytes);
    if (pages->data() == nullptr) {
        return {};
    }
    cl::Buffer buffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, pages->data());
    buffer.setDestructorCallback(release, pages.get());
    // OpenCL owns the memory from here on, because commands may use it after the last handle is gone.
    static_cast<void>(pages.release());
    return buffer;
}
#else
cl::Buffer make_huge_buffer(const cl::Context&, std::size_t) {
    return {};
}
#endif

}  // namespace nearlight::core
