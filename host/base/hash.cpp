// SPDX-License-Identifier: Apache-2.0
#include "host/base/hash.h"

// The functions are compiled into this file, so that no program needs the shared library.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace nearlight::core {
namespace {

/// The two halves in the order in which hex_digits() writes them.
Hash128 in_order(XXH128_hash_t hash) {
    return {hash.high64, hash.low64};
}

}  // namespace

/// The hashes of both widths come from the same sums; only the last step differs.
struct Hasher::State {
    State() { XXH3_128bits_reset(&sums); }
    XXH3_state_t sums;
};

void Hasher::add_bytes(std::span<const std::byte> bytes) {
    XXH3_128bits_update(&state_->sums, bytes.data(), bytes.size());
}

std::uint64_t Hasher::hash64() const {
    return XXH3_64bits_digest(&state_->sums);
}

Hash128 Hasher::hash128() const {
    return in_order(XXH3_128bits_digest(&state_->sums));
}

Hasher::Hasher() : state_(std::make_unique<State>()) {}
Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher& Hasher::operator=(Hasher&&) noexcept = default;

std::uint64_t hash64(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

Hash128 hash128(std::span<const std::byte> bytes) {
    return in_order(XXH3_128bits(bytes.data(), bytes.size()));
}

}  // namespace nearlight::core
