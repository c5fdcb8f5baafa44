#pragma once

// FLINCH_SANITIZED is defined under a sanitizer, which brings its own allocator and replaces much of the C
// library.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FLINCH_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FLINCH_SANITIZED 1
#endif
#endif

namespace flinch::test {

#ifdef FLINCH_SANITIZED
inline constexpr bool sanitized() { return true; }
#else
inline constexpr bool sanitized() { return false; }
#endif

}  // namespace flinch::test
