// SPDX-License-Identifier: Apache-2.0
// Vectors whose new elements are left unset: those who fill them in parallel also share the system's work of
// finding the memory, which otherwise one thread does alone.
#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace nearlight::core {

template <typename T>
struct UnsetAllocator : std::allocator<T> {
    template <typename Other>
    struct rebind {
        using other = UnsetAllocator<Other>;
    };
    template <typename U>
    void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }
};

/// Of plain data.
template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace nearlight::core
