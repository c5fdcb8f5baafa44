#pragma once

#include <cstdint>

namespace flinch::test {

/// How often this thread has asked for heap memory since it started: malloc and everything that ends there,
/// operator new and Eigen included. Under a sanitizer, which brings its own allocator, this stays 0.
std::int64_t allocations();

/// Counts the allocations of this thread while it lives.
class AllocationCounter {
 public:
  AllocationCounter() : start_(allocations()) {}
  std::int64_t count() const { return allocations() - start_; }

 private:
  std::int64_t start_;
};

}  // namespace flinch::test
