// Random numbers that are the same with every compiler (splitmix64; the distributions of the
// standard library are not). At most one draw in the arguments of a call: their order is open.
#pragma once

#include <cstdint>

namespace crease {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  // A stream of its own for each thing that is numbered, so that one does not move the others.
  Random(std::uint64_t seed, std::uint64_t stream) : state_(seed) {
    state_ = next() ^ (stream * 0xd1342543de82ef95u);
    next();
  }

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  // low <= result <= high
  int between(int low, int high) {
    return low + int((next() >> 32) * std::uint64_t(high - low + 1) >> 32);
  }
  bool chance(int percent) { return between(0, 99) < percent; }
  // Metres in steps of 10 cm.
  double metres(double low, double high) {
    return between(int(low * 10 + 0.5), int(high * 10 + 0.5)) / 10.0;
  }

 private:
  std::uint64_t state_;
};

}  // namespace crease
