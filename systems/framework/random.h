#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace flinch {

/// A random number generator small enough to be a State: SplitMix64 (Steele, Lea, Flood 2014), a
/// UniformRandomBitGenerator with 64 bits of state.
class RandomGenerator {
 public:
  using result_type = std::uint64_t;

  explicit constexpr RandomGenerator(std::uint64_t seed = 0) : state_(seed) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }

  constexpr result_type operator()() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

  /// One draw from the normal distribution with mean 0 and standard deviation 1.
  double normal() { return std::normal_distribution<double>()(*this); }

  /// One draw from the uniform distribution on [low, high).
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(*this); }

  friend constexpr bool operator==(const RandomGenerator&, const RandomGenerator&) = default;

 private:
  std::uint64_t state_;
};

/// An independent seed for the consumer called `name`, derived from the seed of the run (FNV-1a
/// from the mixed seed, then mixed again).
constexpr std::uint64_t derive_seed(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325U ^ RandomGenerator(seed)();
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3U;
  return RandomGenerator(hash)();
}

}  // namespace flinch
