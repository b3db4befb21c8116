// SPDX-License-Identifier: Apache-2.0
// Random numbers on the host, with explicit seeds and no state but the caller's.
#pragma once

#include <cstdint>

namespace nearlight::core {

/// PCG32 [O'Neill, PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms, 2014].
class Pcg32 {
  public:
    explicit Pcg32(std::uint64_t seed, std::uint64_t sequence = 1) : increment_((sequence << 1u) | 1u) {
        next();
        state_ += seed;
        next();
    }
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
        const auto turn = static_cast<std::uint32_t>(old >> 59u);
        return (shifted >> turn) | (shifted << ((32u - turn) & 31u));
    }
    /// The next number, uniform in [0, 1).
    float uniform() { return static_cast<float>(next() >> 8u) * 0x1p-24f; }

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_;
};

}  // namespace nearlight::core
