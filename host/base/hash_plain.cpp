// SPDX-License-Identifier: Apache-2.0
// FNV-1a hashes [Fowler, Noll, Vo] for builds without xxHash. The second half of 128 bits has another start
// value.
#include "host/base/hash.h"

namespace nearlight::core {

struct Hasher::State {
    Hash128 halves{14695981039346656037ull, 0x9e3779b97f4a7c15ull};
};

void Hasher::add_bytes(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
        for (std::uint64_t& half : state_->halves) {
            half = (half ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211ull;
        }
    }
}

std::uint64_t Hasher::hash64() const {
    return state_->halves[0];
}

Hash128 Hasher::hash128() const {
    return state_->halves;
}

Hasher::Hasher() : state_(std::make_unique<State>()) {}
Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher& Hasher::operator=(Hasher&&) noexcept = default;

std::uint64_t hash64(std::span<const std::byte> bytes) {
    Hasher hasher;
    hasher.add_bytes(bytes);
    return hasher.hash64();
}

Hash128 hash128(std::span<const std::byte> bytes) {
    Hasher hasher;
    hasher.add_bytes(bytes);
    return hasher.hash128();
}

}  // namespace nearlight::core
