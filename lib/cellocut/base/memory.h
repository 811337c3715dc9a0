// What the process has taken of the machine's memory.
#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace cellocut {

// The largest resident set of this process so far, in bytes.
inline std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

}  // namespace cellocut
