#include "tests/apps/flinch/bus/dds_calls.h"

#include <dlfcn.h>

#include <cstddef>

namespace {

thread_local std::int64_t count = 0;

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

namespace flinch::test {

std::int64_t dds_calls() { return count; }

}  // namespace flinch::test

// These stand before the library's own, and hand on to them.
extern "C" {

int dds_write(int writer, const void* data) {
  static auto* const next = real<int(int, const void*)>("dds_write");
  ++count;
  return next(writer, data);
}

int dds_take(int reader, void** buffer, void* info, std::size_t size, std::uint32_t most) {
  static auto* const next = real<int(int, void**, void*, std::size_t, std::uint32_t)>("dds_take");
  ++count;
  return next(reader, buffer, info, size, most);
}

int dds_get_subscription_matched_status(int reader, void* status) {
  static auto* const next = real<int(int, void*)>("dds_get_subscription_matched_status");
  ++count;
  return next(reader, status);
}

int dds_get_publication_matched_status(int writer, void* status) {
  static auto* const next = real<int(int, void*)>("dds_get_publication_matched_status");
  ++count;
  return next(writer, status);
}
}
