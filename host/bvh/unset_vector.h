// SPDX-License-Identifier: Apache-2.0
// Vectors whose new elements are left unset. Threads that fill such a vector also share the system's work of
// providing the memory, which one thread would otherwise do alone.
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

/// A vector of plain data whose new elements are left unset.
template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace nearlight::core
