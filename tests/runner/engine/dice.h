#pragma once

#include <cstdint>

namespace terrazzo::test {

/// Numbers that look random and are the same on any machine.
class Dice {
 public:
  explicit Dice(uint64_t seed) : state_(seed) {}
  /// In [0, sides).
  int roll(int sides) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<int>((state_ >> 33) % static_cast<uint64_t>(sides));
  }

 private:
  uint64_t state_;
};

}  // namespace terrazzo::test
