// A shared object for LD_PRELOAD that plays a disk running full, or one that takes little at a
// time.
//
//   CELLOCUT_TEST_WRITE_LIMIT=n   after n bytes to regular files, over all descriptors of the
//   process,
//                                 one write comes back short and every later one fails with ENOSPC
//   CELLOCUT_TEST_WRITE_SHORT=1   no write takes more than 1000 bytes; none fails
//
// Everything but regular files is left alone. It stands between a program and ::write and ::writev,
// so it sees std::ofstream too, but not C's stdio, which does not go through the dynamic symbols.
#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

namespace {

using Write = ssize_t (*)(int, const void*, std::size_t);

std::atomic<std::size_t> bytes_written{0};

bool is_regular(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

ssize_t limited_write(int descriptor, const void* data, std::size_t size) {
  static const auto real = reinterpret_cast<Write>(::dlsym(RTLD_NEXT, "write"));
  if (size == 0 || !is_regular(descriptor)) return real(descriptor, data, size);
  if (std::getenv("CELLOCUT_TEST_WRITE_SHORT") != nullptr) {
    size = std::min<std::size_t>(size, 1000);
  }
  if (const char* limit = std::getenv("CELLOCUT_TEST_WRITE_LIMIT"); limit != nullptr) {
    const std::size_t most = std::strtoull(limit, nullptr, 10);
    const std::size_t before = bytes_written.fetch_add(size);
    const std::size_t room = before < most ? most - before : 0;
    if (room == 0) {
      errno = ENOSPC;
      return -1;
    }
    size = std::min(size, room);
  }
  return real(descriptor, data, size);
}

}  // namespace

extern "C" ssize_t write(int descriptor, const void* data, std::size_t size) {
  return limited_write(descriptor, data, size);
}

// Writing the first part alone is a short write, which every caller has to expect.
extern "C" ssize_t writev(int descriptor, const iovec* parts, int count) {
  for (int i = 0; i < count; ++i) {
    if (parts[i].iov_len > 0) return limited_write(descriptor, parts[i].iov_base, parts[i].iov_len);
  }
  return 0;
}
