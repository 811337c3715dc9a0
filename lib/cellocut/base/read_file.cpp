#include "cellocut/base/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

// Closes the descriptor on every way out; standard input stays open.
struct InputDescriptor {
  int number;
  ~InputDescriptor() {
    if (number > STDIN_FILENO) ::close(number);
  }
};

}  // namespace

std::string read_file(const std::string& path) {
  const bool standard_input = path == "-";
  const InputDescriptor input{standard_input ? STDIN_FILENO
                                             : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (input.number < 0) throw InputError(std::string("cannot open: ") + std::strerror(errno), path);
  struct stat status {};
  if (::fstat(input.number, &status) == 0 && S_ISDIR(status.st_mode)) {
    throw InputError("is a directory", path);
  }
  constexpr std::size_t kStep = std::size_t{1} << 20;
  std::string bytes;
  // One byte more than the size, so that the end is found without growing.
  bytes.resize(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : kStep);
  std::size_t filled = 0;
  while (true) {
    if (filled == bytes.size()) bytes.resize(bytes.size() + std::max(kStep, bytes.size() / 2));
    const ssize_t got = ::read(input.number, bytes.data() + filled, bytes.size() - filled);
    if (got == 0) break;
    if (got > 0) {
      filled += static_cast<std::size_t>(got);
    } else if (errno != EINTR) {
      throw InputError(std::string("cannot read: ") + std::strerror(errno), path);
    }
  }
  if (filled == 0) throw InputError("the file is empty", path);
  bytes.resize(filled);
  return bytes;
}

}  // namespace cellocut
