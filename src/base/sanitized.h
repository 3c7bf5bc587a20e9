// Whether a sanitizer watches this program.
#pragma once

namespace pprt {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PPRT_SANITIZED true
#elif defined(__has_feature)
#define PPRT_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#else
#define PPRT_SANITIZED false
#endif

// Its shadow memory takes most of the address space.
inline constexpr bool kSanitized = PPRT_SANITIZED;
#undef PPRT_SANITIZED

}  // namespace pprt
