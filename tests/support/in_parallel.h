#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <type_traits>
#include <vector>

namespace flinch::test {

/// make(0) ... make(count - 1), in their order, made by so many threads; 0: one a processor.
template <class Make>
auto in_parallel(std::size_t count, const Make& make, unsigned threads = 0) {
  std::vector<std::invoke_result_t<const Make&, std::size_t>> made(count);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t number = next++; number < count; number = next++) made[number] = make(number);
  };
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < threads; ++i) workers.emplace_back(work);
  }
  return made;
}

}  // namespace flinch::test
