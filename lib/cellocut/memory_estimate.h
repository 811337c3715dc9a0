// What a run will take of the machine's memory, told before it begins.
#pragma once

#include <cstdint>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct RemeshOptions;

// The largest resident set of remesh() with these options, in bytes, about: it grows with the area
// of the input, or of phi = 0, in grid steps, each part of space counted once, with the share of
// the proxy's faces that stays, and with the number of the input's faces. docs/performance.md
// compares it with what runs took. Precondition: options and input that derive_parameters() takes.
// Parallel; O(faces + area / (4h)^2).
std::int64_t estimate_memory(const TriangleSoup& input, const RemeshOptions& options);

// Errors: LimitError where the estimate is above options.memory_limit; it names a resolution that
// would fit. Returns the estimate.
std::int64_t check_memory(const TriangleSoup& input, const RemeshOptions& options);

// What this process may have: the machine's memory, or what its control group allows if that is
// less. Bytes.
std::int64_t available_memory();

}  // namespace cellocut
